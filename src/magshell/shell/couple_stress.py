r"""The couple stress at a point: ½ c^αβ κ_α · κ_β with c^αβ = Σ_k gamma volume G^α · G^β.

With δκ_α = D_α (δq̂, δq̂,1, δq̂,2), D_α = (M_α | L at q̂,α) (rotation.py), m^α = c^αβ κ_β and n² = |q̂|²:

    gradient   D_αᵀ m^α
    Hessian    D_αᵀ c^αβ D_β + m^α · δ²κ_α

where δ²κ_α comes from κ_α = 2 vec(q̂* q̂,α) / n²: its bilinear numerator, m · vec(δq̂* δq̂,α), and the factor 1/n².
"""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.point import INTERNAL, MIXED, Q1, Q, Record
from magshell.shell.rotation import LAST, NEXT, wryness_maps

# Numbers of q̂, q̂,1 and q̂,2, which lie side by side.
SIZE = 12


@inline
def couple_stress(
    w: Record, metric: FloatArray, n2: float, kappa_mixed: FloatArray, mixed: bool, tangent: bool
) -> float:
    """Add ½ c^αβ κ_α · κ_β: gradient and Hessian with respect to (q̂, q̂,1, q̂,2); returns the energy."""
    q, D, energy = w.x[Q : Q + 4], w.D, 0.0
    for a in range(2):
        at = Q1 + 4 * a
        wryness_maps(q, w.x[at : at + 4], n2, w.L, w.M, w.kappa[a])
        for i in range(3):
            for r in range(4):
                D[a, i, r], D[a, i, 8 - 4 * a + r], D[a, i, 4 + 4 * a + r] = w.M[i, r], 0.0, w.L[i, r]
    for column in range(INTERNAL, MIXED + 1, MIXED - INTERNAL if tangent else MIXED + 1):
        for a in range(2):
            for i in range(3):
                s = metric[a, 0] * w.kappa[0, i] + metric[a, 1] * w.kappa[1, i]
                if column == INTERNAL:
                    energy += 0.5 * s * w.kappa[a, i]
                elif mixed:
                    s = metric[a, 0] * kappa_mixed[0, i] + metric[a, 1] * kappa_mixed[1, i]
                w.stress[a, i] = s
        for c in range(SIZE):
            s = 0.0
            for a in range(2):
                for i in range(3):
                    s += D[a, i, c] * w.stress[a, i]
            w.D_m[c] = s
            w.g[Q + c, column] += s
    if tangent:
        _add_hessian(w, metric, 2.0 / n2)
    return energy


@inline
def _add_hessian(w: Record, metric: FloatArray, two: float) -> None:
    """Add the Hessian, with the couple stresses in w.stress."""
    H, D, D_m, q = w.H, w.D, w.D_m, w.x[Q : Q + 4]
    for r in range(SIZE):
        for b in range(2):
            for i in range(3):
                d = metric[0, b] * D[0, i, r] + metric[1, b] * D[1, i, r]
                for c in range(SIZE):
                    H[Q + r, Q + c] += d * D[b, i, c]
    for r in range(4):
        for c in range(SIZE):
            _add_pair(H, Q + r, Q + c, -two * q[r] * D_m[c])
    for a in range(2):
        m, at, work = w.stress[a], Q1 + 4 * a, 0.0
        for i in range(3):
            j, k = NEXT[i], LAST[i]
            work += w.kappa[a, i] * m[i]
            _add_pair(H, Q, at + 1 + i, two * m[i])
            _add_pair(H, Q + 1 + i, at, -two * m[i])
            _add_pair(H, Q + 1 + k, at + 1 + j, two * m[i])
            _add_pair(H, Q + 1 + j, at + 1 + k, -two * m[i])
        for r in range(4):
            H[Q + r, Q + r] -= two * work


@inline
def _add_pair(H: FloatArray, i: int, j: int, value: float) -> None:
    H[i, j] += value
    H[j, i] += value
