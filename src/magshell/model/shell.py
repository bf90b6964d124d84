"""The shell: mid-surface, thickness, material, remanence, element type; validated once."""

from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.magnetics.remanence import Remanence, constant
from magshell.mesh import Mesh
from magshell.shell.elements import ELEMENTS, QUADRATIC

STRETCHES = ("linear", "none", "plane-stress")
NO_REMANENCE = constant((0.0, 0.0, 0.0))


class Region(NamedTuple):
    """Elements of one make.

    Attributes
    ----------
    elements : ndarray, shape (n,)
    thickness : float
        m.
    material : Material
    """

    elements: IntArray
    thickness: float
    material: Any


@dataclasses.dataclass(frozen=True, eq=False)
class Shell:
    """A shell of one material and thickness.

    Parameters
    ----------
    mesh : Mesh
        Mid-surface.
    thickness : float
        m.
    material : Material
        A law with its parameters, for instance `MicropolarNeoHookean`.
    remanence : Remanence, optional
        Remanent flux density of the undeformed material, see `magshell.remanence`; by default none.
    element : ElementType or str, optional
        Element type or its name, see `magshell.shell.elements`.
    thickness_stretch : {"linear", "none", "plane-stress"}, optional
        Stretch of the thickness that varies linearly across it: an unknown φ, absent (this locks in bending), or
        eliminated at each point so that P33 has no moment.
    density : float, optional
        Mass per undeformed volume, kg/m³; gravity needs it.
    micro_rotation : bool, optional
        False: the classical shell of seven parameters (u, w, φ). The material's coupling_modulus and length_scale must
        then be 0, and only `DeformationGradientEnergy` can couple a field to it.

    Raises
    ------
    InputError
        Values out of their range; a curved mesh that is too thick for its radius of curvature.
    """

    mesh: Mesh
    thickness: float
    material: Any
    remanence: Remanence = NO_REMANENCE
    element: Any = QUADRATIC
    thickness_stretch: str = "linear"
    micro_rotation: bool = True
    density: float | None = None

    def __post_init__(self) -> None:
        thickness = _positive("shell: thickness", self.thickness, "m")
        if thickness > self.mesh.size:
            raise InputError(
                f"shell: thickness is {thickness:g} m, larger than the body ({self.mesh.size:g} m); check the units"
            )
        if self.density is not None:
            object.__setattr__(self, "density", _positive("shell: density", self.density, "kg/m^3"))
        values = []
        for name, value in zip(self.material._fields, self.material, strict=True):
            value = float(value)
            where = f"material: {name}"
            positive = name == "shear_modulus" or (name == "length_scale" and self.micro_rotation)
            if not np.isfinite(value) or value < 0.0 or (value == 0.0 and positive):
                allowed = "positive" if positive else "zero or positive"
                raise InputError(f"{where} is {value:g}; it must be finite and {allowed}")
            values.append(value)
            if not self.micro_rotation and name in ("coupling_modulus", "length_scale") and value > 0.0:
                raise InputError(f"{where} is {value:g}; without micro-rotation it must be 0")
        material = type(self.material)(*values)
        for problem in material.problems():
            raise InputError(f"material: {problem}")
        object.__setattr__(self, "thickness", thickness)
        object.__setattr__(self, "material", material)
        if isinstance(self.element, str):
            if self.element not in ELEMENTS:
                raise InputError(f"shell: element is '{self.element}'. {suggest(self.element, ELEMENTS)}")
            object.__setattr__(self, "element", ELEMENTS[self.element])
        if self.mesh.triangles.any():
            if self.element.with_triangles is None:
                able = " or ".join(f"'{name}'" for name, element in ELEMENTS.items() if element.with_triangles)
                raise InputError(
                    f"shell: element is '{self.element.name}', which has no triangles, and element "
                    f"{int(np.argmax(self.mesh.triangles))} of the mesh is one; use {able}"
                )
            object.__setattr__(self, "element", self.element.with_triangles)
        if self.thickness_stretch not in STRETCHES:
            raise InputError(
                f"shell: thickness_stretch is '{self.thickness_stretch}'. {suggest(self.thickness_stretch, STRETCHES)}"
            )

    def __repr__(self) -> str:
        return f"Shell({self.mesh!r}, thickness {self.thickness:g} m, {self.material!r}, element '{self.element.name}')"

    @property
    def regions(self) -> tuple[Region, ...]:
        """The shell by regions: together they hold every element once."""
        return (Region(np.arange(len(self.mesh.elements)), self.thickness, self.material),)

    @cached_property
    def remanence_at_points(self) -> FloatArray:
        """Remanence at the integration points, (elements, points, 3), T.

        Raises
        ------
        InputError
            It is not finite in an element.
        """
        coordinates = self.mesh.points[self.mesh.elements]
        points, _ = self.element.integration(coordinates)
        positions = np.einsum("epn,enx->epx", self.element.functions(8, points, coordinates).values, coordinates)
        remanence = np.ascontiguousarray(self.remanence(self.mesh, positions), dtype=float)
        bad = np.flatnonzero(~np.isfinite(remanence).all(axis=(1, 2)))
        if bad.size:
            raise InputError(f"remanence: it is not finite in element {bad[0]}")
        return remanence

    @property
    def carriers(self) -> dict[str, AnyArray]:
        """Which nodes carry the fields u, w, phi and omega: boolean arrays (nodes,)."""
        count = len(self.mesh.points)
        carriers: dict[str, AnyArray] = self.element.carriers(self.mesh.elements, count)
        if self.thickness_stretch != "linear":
            carriers["phi"] = np.zeros(count, dtype=bool)
        if not self.micro_rotation:
            carriers["omega"] = np.zeros(count, dtype=bool)
        return carriers


def _positive(where: str, value: Any, unit: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where} is {value!r}; it must be a number ({unit})") from None
    if not np.isfinite(number) or number <= 0.0:
        raise InputError(f"{where} is {number:g} {unit}; it must be positive and finite")
    return number
