"""What a magnetic coupling law is, and how the kernels find the one in use.

A law says what the external flux density B does at a material point whose remanence B̃ (reference configuration) is
carried along by the deformation gradient, m = F B̃, and by the micro-rotation, n = R̃ B̃. Per unit reference volume
its virtual work on the residual is

    r = f · δm + c · δω,      δω the spin of the micro-rotation,

and its tangent, for increments (Δm, Δω) and the spin δω of the fixed chart exp(δω) R̃, is

    Δr = δω · K_m Δm + δω · K_ω Δω       (f does not depend on the state).

A law is one file: a NamedTuple of its parameters and two functions compiled into the kernels.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from magshell.arrays import FloatArray


class Coupling(Protocol):
    """Parameters of a law."""

    @property
    def vacuum_permeability(self) -> float:
        """mu0, N/A²."""


MagneticEnergy = Callable[..., float]
ForcesAndTangent = Callable[..., None]
AnyCoupling = TypeVar("AnyCoupling", bound=type)

energies_of: dict[type, MagneticEnergy | None] = {}
forces_of: dict[type, ForcesAndTangent] = {}


def forces_and_tangent(
    coupling: Coupling,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    f: FloatArray,
    c: FloatArray,
    K_m: FloatArray,
    K_ω: FloatArray,
) -> None:
    """Fill f, c (3,) and K_m, K_ω (3, 3) at the state m, n (T, shape (3,)) in the field B (T, shape (3,))."""
    forces_of[type(coupling)](coupling, m, n, B, f, c, K_m, K_ω)


def magnetic_energy(coupling: Coupling, m: FloatArray, n: FloatArray, B: FloatArray) -> float:
    """Energy per unit reference volume, J/m³; a law without one is not conservative."""
    energy = energies_of[type(coupling)]
    if energy is None:
        raise ValueError(f"{type(coupling).__name__} is not conservative: it has no energy")
    return energy(coupling, m, n, B)


def is_conservative(coupling: Coupling) -> bool:
    """Whether the law derives from an energy, so that the tangent is symmetric."""
    return energies_of[type(coupling)] is not None


def laws() -> list[type]:
    """All registered laws: every test of the battery runs over this list."""
    return list(forces_of)


def coupling_law(
    forces: ForcesAndTangent, energy: MagneticEnergy | None = None
) -> Callable[[AnyCoupling], AnyCoupling]:
    """Register a NamedTuple class of parameters with its functions; a law without energy is not conservative."""

    def register(cls: AnyCoupling) -> AnyCoupling:
        forces_of[cls] = forces
        energies_of[cls] = energy
        return cls

    return register
