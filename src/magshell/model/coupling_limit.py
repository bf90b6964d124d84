"""Whether the field's couple reaches what the micro-rotation transfers to the material.

With the couple B̃ B/mu0 at the coupling modulus eta the micro-rotation is ahead of the material by 15° where this cannot
follow; at 2 eta by 45°, and there is no equilibrium beyond (`magshell.solver.diagnosis`).
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from typing import Any

import numpy as np

from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.model.shell import Shell
from magshell.units import STRESS, show

logger = logging.getLogger(__name__)


def reached(shell: Shell, coupling: Any, field: float) -> Iterator[str]:
    """A sentence for each layer whose coupling modulus the couple of a field of this magnitude (T) reaches."""
    if not field or isinstance(coupling, DeformationGradientEnergy):
        return
    for part in shell.parts:
        for number, layer in enumerate(part.layers):
            remanence = np.linalg.norm(part.remanence[:, :, number], axis=-1).max(axis=1)
            worst, eta = int(remanence.argmax()), layer.material.coupling_modulus
            couple = float(remanence[worst]) * field / coupling.vacuum_permeability
            if couple >= eta > 0.0:
                of_layer = f" (layer {number})" if part.layered else ""
                yield (
                    f"the field's couple B_rem B/mu0 is up to {show(couple, STRESS)} in element "
                    f"{part.elements[worst]}{of_layer} and reaches the coupling modulus {show(eta, STRESS)}: the "
                    "micro-rotation runs ahead of the material, and at twice the modulus nothing holds it. Take a "
                    "larger material.coupling_modulus (by default it is the shear modulus) or a weaker field"
                )
