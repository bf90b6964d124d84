"""The problem as immutable data: shell, supports, field, coupling law, probes, loads; validated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError, suggest
from magshell.loads import Load, nodal_forces
from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.magnetics.field import UniformField
from magshell.magnetics.micropolar_couple import MicropolarCouple
from magshell.magnetics.remanence import Remanence, constant
from magshell.mesh import Mesh
from magshell.rigid import check_supported
from magshell.shell.elements import ELEMENTS, QUADRATIC
from magshell.shell.normals import nodal_normals
from magshell.supports import Constraints, Support, SymmetryPlane, resolve

STRETCHES = ("linear", "none", "plane-stress")
# Sine of the angle between mid-surface and mirror plane below which the shell does not cross the plane.
TOUCHING = 1e-6
NO_FIELD = UniformField((0.0, 0.0, 0.0))
NO_REMANENCE = constant((0.0, 0.0, 0.0))


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

    def __post_init__(self) -> None:
        thickness = _positive("shell: thickness", self.thickness, "m")
        if thickness > self.mesh.size:
            raise InputError(
                f"shell: thickness is {thickness:g} m, larger than the body ({self.mesh.size:g} m); check the units"
            )
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
        if self.thickness_stretch not in STRETCHES:
            raise InputError(
                f"shell: thickness_stretch is '{self.thickness_stretch}'. {suggest(self.thickness_stretch, STRETCHES)}"
            )

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


@dataclasses.dataclass(frozen=True, eq=False)
class Model:
    """A shell, held by supports, in a field and under loads.

    Parameters
    ----------
    shell : Shell
    supports : sequence of Support
        `Clamp`, `SimpleSupport`, `SymmetryPlane`, `Prescribe`.
    field : UniformField, optional
        By default none.
    coupling : Coupling, optional
        Magnetic coupling law; by default the couple of the micropolar theory, or without micro-rotation the energy of
        the deformation gradient.
    probes : mapping of str to (3,) array_like, optional
        Reference positions of nodes to follow, m.
    loads : sequence of Load
        `Force`, `Moment`.

    Attributes
    ----------
    constraints : Constraints
        The supports, node by node.
    nodal_loads : ndarray, shape (nodes, 10)
        External forces at load factor 1 in global axes: N on u, N m on the spin.

    Raises
    ------
    InputError
        Unknown groups, contradicting supports, a free rigid motion (named), probes that are not nodes, loads that make
        no sense, or nothing that loads the shell.
    """

    shell: Shell
    supports: Sequence[Support]
    field: UniformField = NO_FIELD
    coupling: Any = None
    probes: Mapping[str, ArrayLike] = dataclasses.field(default_factory=dict)
    loads: Sequence[Load] = ()
    constraints: Constraints = dataclasses.field(init=False, repr=False)
    nodal_loads: FloatArray = dataclasses.field(init=False, repr=False)
    probe_nodes: Mapping[str, int] = dataclasses.field(init=False, repr=False)

    def __post_init__(self) -> None:
        mesh = self.shell.mesh
        put = object.__setattr__
        if self.coupling is None:
            put(self, "coupling", MicropolarCouple() if self.shell.micro_rotation else DeformationGradientEnergy())
        put(self, "supports", tuple(self.supports))
        put(self, "constraints", resolve(mesh, self.supports, self.shell.carriers))
        put(self, "loads", tuple(self.loads))
        put(self, "nodal_loads", nodal_forces(mesh, self.shell.element, self.loads))
        nodes = {}
        for name, position in self.probes.items():
            try:
                nodes[name] = mesh.node_at(np.asarray(position, dtype=float))
            except InputError as error:
                raise InputError(f"probe '{name}': {error}") from None
        put(self, "probe_nodes", MappingProxyType(nodes))
        check_supported(mesh, self.normals, self.constraints)
        self._check_the_micro_rotation_matters()
        self._check_something_loads()

    def _check_the_micro_rotation_matters(self) -> None:
        if self.shell.material.coupling_modulus > 0.0:
            return
        if np.any(self.nodal_loads[:, 7:]):
            worker = "a moment"
        elif self.field.magnitude > 0.0 and not isinstance(self.coupling, DeformationGradientEnergy):
            worker = type(self.coupling).__name__
        else:
            return
        if not self.shell.micro_rotation:
            raise InputError(f"shell: {worker} works on the micro-rotation, which this shell does not have")
        raise InputError(
            f"material: coupling_modulus is 0, so the micro-rotation that {worker} works on "
            "never reaches the deformation; the source takes a tenth of shear_modulus"
        )

    def _check_something_loads(self) -> None:
        mesh = self.shell.mesh
        if np.any(self.constraints.value) or np.any(self.nodal_loads):
            return
        otherwise = "and no support moves, nor is there a load: nothing loads the shell"
        if self.field.magnitude == 0.0:
            raise InputError(f"field: flux_density is zero {otherwise}")
        if not np.any(self.shell.remanence(mesh, mesh.points[mesh.elements])):
            raise InputError(f"remanence: it is zero everywhere {otherwise}")

    @cached_property
    def normals(self) -> FloatArray:
        """Unit normals (nodes, 3) of the undeformed mid-surface, averaged over the elements of a node.

        On a mirror plane they lie in it, as the average with the mirror image does, unless the shell touches the plane.
        """
        mesh = self.shell.mesh
        normals = nodal_normals(mesh.points, mesh.elements)
        for support in self.supports:
            if isinstance(support, SymmetryPlane):
                nodes, plane = mesh.nodes_of(support.group), np.array(support.normal, dtype=float)
                plane /= np.linalg.norm(plane)
                inside = normals[nodes] - np.outer(normals[nodes] @ plane, plane)
                length = np.linalg.norm(inside, axis=1)
                meets = length > TOUCHING
                normals[nodes[meets]] = inside[meets] / length[meets, None]
        return normals


def _positive(where: str, value: Any, unit: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where} is {value!r}; it must be a number ({unit})") from None
    if not np.isfinite(number) or number <= 0.0:
        raise InputError(f"{where} is {number:g} {unit}; it must be positive and finite")
    return number
