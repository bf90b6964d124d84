"""Magnetics: the external field and the laws that couple it with the remanence, one per file; `remanence/`."""

from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.magnetics.fields.uniform import UniformField
from magshell.magnetics.law import Coupling, is_conservative, laws
from magshell.magnetics.micro_rotation_energy import MicroRotationEnergy
from magshell.magnetics.micropolar_couple import MicropolarCouple

COUPLINGS: dict[str, type[Coupling]] = {
    "couple": MicropolarCouple,
    "micro-rotation": MicroRotationEnergy,
    "deformation-gradient": DeformationGradientEnergy,
}
"""The coupling laws that problem files know, by their names there."""

__all__ = [
    "COUPLINGS",
    "Coupling",
    "DeformationGradientEnergy",
    "MicroRotationEnergy",
    "MicropolarCouple",
    "UniformField",
    "is_conservative",
    "laws",
]
