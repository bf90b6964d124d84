r"""The body couple of the micropolar theory (not conservative).

Per unit reference volume the field exerts the couple p = (1/mu0) m × B, m = F B̃, that works on the spin of the
micro-rotation (Dadgar-Rad and Hossain, eqs couple, dWext). Its part of the residual is

    c = -(1/mu0) m × B,      f = 0.

Tangent: dc = -(1/mu0) Δm × B = (1/mu0) B × Δm, so K_m = (1/mu0) [B]×. In the chart exp(δω) R̃ the spin of a second
increment is δω + Δω × δω / 2, which adds c · (Δω × δω)/2 = δω · (c × Δω)/2, so K_ω = [c]×/2. Both are unsymmetric.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import coupling_law


def _forces(
    coupling: MicropolarCouple,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    f: FloatArray,
    c: FloatArray,
    K_m: FloatArray,
    K_ω: FloatArray,
) -> None:
    mu0 = coupling.vacuum_permeability
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        f[i] = 0.0
        c[i] = -(m[j] * B[k] - m[k] * B[j]) / mu0
        K_m[i, i] = 0.0
        K_m[k, j] = B[i] / mu0
        K_m[j, k] = -B[i] / mu0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        K_ω[i, i] = 0.0
        K_ω[k, j] = 0.5 * c[i]
        K_ω[j, k] = -0.5 * c[i]


@coupling_law(forces=_forces)
class MicropolarCouple(NamedTuple):
    """Body couple (1/mu0) (F B̃) × B on the micro-rotation: the law of the micropolar theory."""

    vacuum_permeability: float = 4e-7 * np.pi
