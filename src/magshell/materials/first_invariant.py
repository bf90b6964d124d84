r"""What laws share whose energy depends on the first invariant.

With x = I1 - 3 = tr(UᵀU) - 3, J = det U and V = U⁻ᵀ, their energy per unit reference volume is

    W = w(x) - mu ln J + k/2 (ln J)² + eta/2 (tr(U Uᵀ) - tr(U²)),

the micropolar neo-Hookean law with w(x) in place of mu x/2; w'(0) = mu/2 leaves the undeformed state without stress.
With dx = 2 U : dU the stress is

    P = 2 w' U - (mu - k ln J) V + eta (U - Uᵀ),

and the tangent

    C_pjql = 2 w' δ_pq δ_jl + 4 w'' U_pj U_ql + k V_pj V_ql + (mu - k ln J) V_pl V_qj + eta (δ_pq δ_jl - δ_pl δ_jq).

In the undeformed state 4 w'' U_pj U_ql adds 4 w''(0) to the first Lamé constant. So k = lambda - 4 w''(0) makes mu and
lambda the constants of the linear limit.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import also_compiled
from magshell.materials.tensors import inverse_transpose


@also_compiled
def first_invariant(U: FloatArray) -> float:
    """I1 - 3, exactly 0 in the undeformed state."""
    x = -3.0
    for p in range(3):
        for j in range(3):
            x += U[p, j] * U[p, j]
    return x


@also_compiled
def fill(
    U: FloatArray, derivatives: tuple[float, float], moduli: tuple[float, float, float], P: FloatArray, C: FloatArray
) -> float:
    """Fill stress and tangent, of w' and w'', and of mu, k and eta; return W - w."""
    slope, curvature = derivatives
    mu, k, eta = moduli
    V, J = inverse_transpose(U)
    log_J = np.log(J)
    pressure = mu - k * log_J
    skew = 0.0
    for p in range(3):
        for j in range(3):
            skew += U[p, j] * (U[p, j] - U[j, p])
            P[p, j] = 2.0 * slope * U[p, j] - pressure * V[p, j] + eta * (U[p, j] - U[j, p])
            for q in range(3):
                for l in range(3):
                    C[p, j, q, l] = (
                        4.0 * curvature * U[p, j] * U[q, l] + k * V[p, j] * V[q, l] + pressure * V[p, l] * V[q, j]
                    )
    for p in range(3):
        for j in range(3):
            C[p, j, p, j] += 2.0 * slope + eta
            C[p, j, j, p] -= eta
    return 0.5 * k * log_J**2 - mu * log_J + 0.5 * eta * skew
