r"""The body couple of the micropolar theory (not conservative).

Per unit reference volume the field exerts the couple p = (1/mu0) m × B, m = F B̃, that works on the spin of the
micro-rotation (Dadgar-Rad and Hossain, eqs couple, dWext). Its part of the residual is

    c = -(1/mu0) m × B,      f = 0.

Tangent: dc = -(1/mu0) Δm × B = (1/mu0) B × Δm, so K_m = (1/mu0) [B]×. In the chart exp(δω) R̃ the spin of a second
increment is δω + Δω × δω / 2, which adds c · (Δω × δω)/2 = δω · (c × Δω)/2, so K_ω = [c]×/2. Both are unsymmetric.

In a field that varies it also pulls, with the force (1/mu0) m_i ∂B_i/∂x_j per unit reference volume:

    (f_x)_j = -(1/mu0) m_i ∂B_i/∂x_j,      K_xx = -(1/mu0) m_i ∂²B_i/∂x_j∂x_k,      K_ωx = -(1/mu0) m × ∂B/∂x_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import OMEGA, M, X, coupling_law, pull


def _law(
    coupling: MicropolarCouple,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    gradients: FloatArray,
    forces: FloatArray,
    tangent: FloatArray,
) -> float:
    mu0 = coupling.vacuum_permeability
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        c = -(m[j] * B[k] - m[k] * B[j]) / mu0
        forces[OMEGA + i] += c
        tangent[OMEGA + k, M + j] += B[i] / mu0
        tangent[OMEGA + j, M + k] -= B[i] / mu0
        tangent[OMEGA + k, OMEGA + j] += 0.5 * c
        tangent[OMEGA + j, OMEGA + k] -= 0.5 * c
        for l in range(3):
            tangent[OMEGA + i, X + l] -= (m[j] * gradients[3 * k + l] - m[k] * gradients[3 * j + l]) / mu0
            tangent[X + l, M + i] -= gradients[3 * i + l] / mu0
    pull(m, gradients, mu0, forces, tangent)
    return 0.0


@coupling_law(_law, has_energy=False)
class MicropolarCouple(NamedTuple):
    """Body couple (1/mu0) (F B̃) × B on the micro-rotation: the law of the micropolar theory."""

    vacuum_permeability: float = 4e-7 * np.pi
