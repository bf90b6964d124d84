r"""Conservative coupling through the deformation gradient (Zhao, Kim, Cheng, Zhao: JMPS 124, 2019).

The remanence is carried along and stretched by the material, m = F B̃:

    W = -(1/mu0) m · B,      f = -(1/mu0) B,      c = 0.

W is linear in m: all its second variation in a uniform field comes from the kinematics of m, and K_m = K_ω = 0. Where
B varies, B = B(x),

    (f_x)_j = -(1/mu0) m_i ∂B_i/∂x_j,      K_mx = -(1/mu0) ∂B_i/∂x_j,      K_xx = -(1/mu0) m_i ∂²B_i/∂x_j∂x_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import M, X, coupling_law, pull


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
        for j in range(3):
            tangent[M + i, X + j] -= gradients[3 * i + j] / mu0
            tangent[X + j, M + i] -= gradients[3 * i + j] / mu0
    pull(m, gradients, mu0, forces, tangent)
    return -(m[0] * B[0] + m[1] * B[1] + m[2] * B[2]) / mu0


@coupling_law(_law, has_energy=True)
class DeformationGradientEnergy(NamedTuple):
    """Energy -(1/mu0) (F B̃) · B of Zhao et al.: the remanence is carried along and stretched by the material."""

    vacuum_permeability: float = 4e-7 * np.pi
