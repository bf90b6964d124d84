"""Magnetics: the external field and the laws that couple it with the remanence, one per file; `remanence/`."""

from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.magnetics.field import UniformField
from magshell.magnetics.law import Coupling, is_conservative, laws
from magshell.magnetics.micro_rotation_energy import MicroRotationEnergy
from magshell.magnetics.micropolar_couple import MicropolarCouple

__all__ = [
    "Coupling",
    "DeformationGradientEnergy",
    "MicroRotationEnergy",
    "MicropolarCouple",
    "UniformField",
    "is_conservative",
    "laws",
]
