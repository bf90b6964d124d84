r"""Conservative coupling through the micro-rotation.

The remanence turns with the micro-rotation and does not stretch, n = R̃ B̃:

    W = -(1/mu0) n · B.

With exp(δω) n = n + δω × n + δω × (δω × n)/2 its part of the residual and its symmetric tangent are

    c = -(1/mu0) n × B,      K_ω = -(1/mu0) [ (n Bᵀ + B nᵀ)/2 - (n · B) I ],      f = 0,  K_m = 0,

and where B varies, B = B(x),

    (f_x)_j = -(1/mu0) n_i ∂B_i/∂x_j,   K_ωx = -(1/mu0) n × ∂B/∂x_j,   K_xx = -(1/mu0) n_i ∂²B_i/∂x_j∂x_k.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import OMEGA, X, coupling_law, pull


def _law(
    coupling: MicroRotationEnergy,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    gradients: FloatArray,
    forces: FloatArray,
    tangent: FloatArray,
) -> float:
    mu0 = coupling.vacuum_permeability
    n_dot_B = n[0] * B[0] + n[1] * B[1] + n[2] * B[2]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        forces[OMEGA + i] -= (n[j] * B[k] - n[k] * B[j]) / mu0
        for l in range(3):
            tangent[OMEGA + i, OMEGA + l] -= 0.5 * (n[i] * B[l] + B[i] * n[l]) / mu0
        tangent[OMEGA + i, OMEGA + i] += n_dot_B / mu0
        for l in range(3):
            slope = (n[j] * gradients[3 * k + l] - n[k] * gradients[3 * j + l]) / mu0
            tangent[OMEGA + i, X + l] -= slope
            tangent[X + l, OMEGA + i] -= slope
    pull(n, gradients, mu0, forces, tangent)
    return -n_dot_B / mu0


@coupling_law(_law, has_energy=True)
class MicroRotationEnergy(NamedTuple):
    """Energy -(1/mu0) (R̃ B̃) · B: the remanence turns with the micro-rotation and does not stretch."""

    vacuum_permeability: float = 4e-7 * np.pi
