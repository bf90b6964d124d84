r"""Conservative coupling through the deformation gradient (Zhao, Kim, Cheng, Zhao: JMPS 124, 2019).

The remanence is carried along and stretched by the material, m = F B̃:

    W = -(1/mu0) m · B,      f = -(1/mu0) B,      c = 0.

W is linear in m: all its second variation comes from the kinematics of m, and K_m = K_ω = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import M, coupling_law


def _law(
    coupling: DeformationGradientEnergy,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    gradients: FloatArray,
    forces: FloatArray,
    tangent: FloatArray,
) -> float:
    mu0 = coupling.vacuum_permeability
    for i in range(3):
        forces[M + i] -= B[i] / mu0
    return -(m[0] * B[0] + m[1] * B[1] + m[2] * B[2]) / mu0


@coupling_law(_law, has_energy=True)
class DeformationGradientEnergy(NamedTuple):
    """Energy -(1/mu0) (F B̃) · B of Zhao et al.: the remanence is carried along and stretched by the material."""

    vacuum_permeability: float = 4e-7 * np.pi
