"""What a material law is, and how the kernels find the one in use.

A law is a free energy Psi = W(U) + (gamma/2) tr(G Gᵀ) per unit reference volume, of the micropolar stretch
U = R̃ᵀF and the wryness G. It is one file: a NamedTuple of its parameters and two functions of U that are
compiled into the kernels. The couple-stress part is the same for all laws: gamma is the law's `couple_modulus`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from magshell.arrays import FloatArray


class Material(Protocol):
    """Parameters of a law; every one is a float in SI units."""

    @property
    def shear_modulus(self) -> float:
        """Shear modulus mu of the linear limit, Pa."""

    @property
    def lame_lambda(self) -> float:
        """First Lamé constant of the linear limit, Pa."""

    @property
    def coupling_modulus(self) -> float:
        """Modulus eta that ties the micro-rotation to the macro-rotation, Pa."""

    @property
    def length_scale(self) -> float:
        """Length scale l, m."""

    @property
    def couple_modulus(self) -> float:
        """Modulus gamma = mu l² of the couple stress M̃ = gamma G, N."""

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs, a sentence each."""


StrainEnergy = Callable[..., float]
StressAndTangent = Callable[..., None]
AnyMaterial = TypeVar("AnyMaterial", bound=type)

strain_energies_of: dict[type, StrainEnergy] = {}
stresses_of: dict[type, StressAndTangent] = {}


def strain_energy(material: Material, U: FloatArray) -> float:
    """W(U) in J/m³, U of shape (3, 3) with positive determinant."""
    return strain_energies_of[type(material)](material, U)


def stress_and_tangent(material: Material, U: FloatArray, P: FloatArray, C: FloatArray) -> None:
    """Fill P = dW/dU, shape (3, 3), and C = d²W/dUdU, shape (3, 3, 3, 3), both in Pa."""
    stresses_of[type(material)](material, U, P, C)


def laws() -> list[type]:
    """All registered laws: every test of the battery runs over this list."""
    return list(stresses_of)


def material_law(energy: StrainEnergy, stress: StressAndTangent) -> Callable[[AnyMaterial], AnyMaterial]:
    """Register a NamedTuple class of parameters with its functions of U."""

    def register(cls: AnyMaterial) -> AnyMaterial:
        strain_energies_of[cls] = energy
        stresses_of[cls] = stress
        return cls

    return register
