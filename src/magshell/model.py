"""The problem as immutable data: shell, supports, field, coupling law, probes; validated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.magnetics.field import UniformField
from magshell.magnetics.micropolar_couple import MicropolarCouple
from magshell.magnetics.remanence import Remanence
from magshell.mesh import Mesh
from magshell.rigid import check_supported
from magshell.shell.normals import nodal_normals
from magshell.supports import Constraints, Support, resolve


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
    remanence : Remanence
        Remanent flux density of the undeformed material, see `magshell.remanence`.

    Raises
    ------
    InputError
        Values out of their range; a curved mesh that is too thick for its radius of curvature.
    """

    mesh: Mesh
    thickness: float
    material: Any
    remanence: Remanence

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
            if not np.isfinite(value) or value < 0.0 or (value == 0.0 and name in ("shear_modulus", "length_scale")):
                allowed = "positive" if name in ("shear_modulus", "length_scale") else "zero or positive"
                raise InputError(f"{where} is {value:g}; it must be finite and {allowed}")
            values.append(value)
        material = type(self.material)(*values)
        for problem in material.problems():
            raise InputError(f"material: {problem}")
        object.__setattr__(self, "thickness", thickness)
        object.__setattr__(self, "material", material)


@dataclasses.dataclass(frozen=True, eq=False)
class Model:
    """A shell, held by supports, in a field.

    Parameters
    ----------
    shell : Shell
    supports : sequence of Support
        `Clamp`, `SimpleSupport`, `SymmetryPlane`, `Prescribe`.
    field : UniformField
    coupling : Coupling, optional
        Magnetic coupling law; by default the couple of the micropolar theory.
    probes : mapping of str to (3,) array_like, optional
        Reference positions of nodes to follow, m.

    Raises
    ------
    InputError
        Unknown groups, contradicting supports, a free rigid motion (named), probes that are not nodes, no load.
    """

    shell: Shell
    supports: Sequence[Support]
    field: UniformField
    coupling: Any = None
    probes: Mapping[str, ArrayLike] = dataclasses.field(default_factory=dict)
    constraints: Constraints = dataclasses.field(init=False, repr=False)
    probe_nodes: Mapping[str, int] = dataclasses.field(init=False, repr=False)

    def __post_init__(self) -> None:
        mesh = self.shell.mesh
        put = object.__setattr__
        put(self, "coupling", MicropolarCouple() if self.coupling is None else self.coupling)
        put(self, "supports", tuple(self.supports))
        put(self, "constraints", resolve(mesh, self.supports))
        nodes = {}
        for name, position in self.probes.items():
            try:
                nodes[name] = mesh.node_at(np.asarray(position, dtype=float))
            except InputError as error:
                raise InputError(f"probe '{name}': {error}") from None
        put(self, "probe_nodes", MappingProxyType(nodes))
        check_supported(mesh, self.normals, self.constraints)
        eta = self.shell.material.coupling_modulus
        if eta == 0.0 and not isinstance(self.coupling, DeformationGradientEnergy):
            raise InputError(
                f"material: coupling_modulus is 0, so the micro-rotation that {type(self.coupling).__name__} works on "
                "never reaches the deformation; the source takes a tenth of shear_modulus"
            )
        if not np.any(self.constraints.value):
            if self.field.magnitude == 0.0:
                raise InputError("field: flux_density is zero and no support moves: nothing loads the shell")
            if not np.any(self.shell.remanence(mesh, mesh.points[mesh.elements])):
                raise InputError("remanence: it is zero everywhere and no support moves: nothing loads the shell")

    @cached_property
    def normals(self) -> FloatArray:
        """Unit normals (nodes, 3) of the undeformed mid-surface, averaged over the elements of a node."""
        return nodal_normals(self.shell.mesh.points, self.shell.mesh.elements)


def _positive(where: str, value: Any, unit: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where} is {value!r}; it must be a number ({unit})") from None
    if not np.isfinite(number) or number <= 0.0:
        raise InputError(f"{where} is {number:g} {unit}; it must be positive and finite")
    return number
