r"""The couple stress at a point: ½ c^αβ κ_α · κ_β with c^αβ = Σ_k gamma volume G^α · G^β.

With δκ = L δq̂,α + M δq̂ (rotation.py), m^α = c^αβ κ_β and n² = |q̂|²:

    gradient   q̂: M_αᵀ m^α,   q̂,α: Lᵀ m^α
    Hessian    δκ_α · c^αβ δκ_β + m^α · δ²κ_α

where δ²κ_α comes from κ_α = 2 vec(q̂* q̂,α) / n²: its bilinear numerator, m · vec(δq̂* δq̂,α), and the factor 1/n².
"""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.point import INTERNAL, MIXED, Q1, Q, Record
from magshell.shell.rotation import LAST, NEXT, wryness_maps


@inline
def _add_pair(H: FloatArray, i: int, j: int, value: float) -> None:
    H[i, j] += value
    H[j, i] += value


@inline
def couple_stress(
    w: Record, metric: FloatArray, n2: float, kappa_mixed: FloatArray, mixed: bool, tangent: bool
) -> float:
    """Add ½ c^αβ κ_α · κ_β: gradient and Hessian with respect to (q̂, q̂,1, q̂,2); returns the energy."""
    q, H, energy = w.x[Q : Q + 4], w.H, 0.0
    for a in range(2):
        wryness_maps(q, w.x[Q1 + 4 * a : Q1 + 4 * a + 4], n2, w.L, w.M[a], w.kappa[a])
    for a in range(2):
        for i in range(3):
            w.stress[a, i] = metric[a, 0] * w.kappa[0, i] + metric[a, 1] * w.kappa[1, i]
            energy += 0.5 * w.stress[a, i] * w.kappa[a, i]
    _add_gradient(w, INTERNAL)
    if not tangent:
        return energy
    if mixed:
        for a in range(2):
            for i in range(3):
                w.stress[a, i] = metric[a, 0] * kappa_mixed[0, i] + metric[a, 1] * kappa_mixed[1, i]
    _add_gradient(w, MIXED)
    L, M, M_c, two = w.L, w.M, w.M_c, 2.0 / n2
    for b in range(2):
        for i in range(3):
            for r in range(4):
                M_c[b, i, r] = metric[0, b] * M[0, i, r] + metric[1, b] * M[1, i, r]
    c_11, c_12, c_22 = metric[0, 0], metric[0, 1], metric[1, 1]
    for r in range(4):
        for c in range(4):
            H[Q + r, Q + c] -= two * (q[r] * w.m_M[c] + w.m_M[r] * q[c])
            for i in range(3):
                H[Q + r, Q + c] += M_c[0, i, r] * M[0, i, c] + M_c[1, i, r] * M[1, i, c]
            for b in range(2):
                h = M_c[b, 0, r] * L[0, c] + M_c[b, 1, r] * L[1, c] + M_c[b, 2, r] * L[2, c]
                _add_pair(H, Q + r, Q1 + 4 * b + c, h - two * q[r] * w.m_L[b, c])
            h = L[0, r] * L[0, c] + L[1, r] * L[1, c] + L[2, r] * L[2, c]
            H[Q1 + r, Q1 + c] += c_11 * h
            H[Q1 + r, Q1 + 4 + c] += c_12 * h
            H[Q1 + 4 + r, Q1 + c] += c_12 * h
            H[Q1 + 4 + r, Q1 + 4 + c] += c_22 * h
    for a in range(2):
        m, kappa, at = w.stress[a], w.kappa[a], Q1 + 4 * a
        kappa_m = two * (kappa[0] * m[0] + kappa[1] * m[1] + kappa[2] * m[2])
        for r in range(4):
            H[Q + r, Q + r] -= kappa_m
        for i in range(3):
            j, k = NEXT[i], LAST[i]
            _add_pair(H, Q, at + 1 + i, two * m[i])
            _add_pair(H, Q + 1 + i, at, -two * m[i])
            _add_pair(H, Q + 1 + k, at + 1 + j, two * m[i])
            _add_pair(H, Q + 1 + j, at + 1 + k, -two * m[i])
    return energy


@inline
def _add_gradient(w: Record, column: int) -> None:
    """Fill m_M = Σ M_αᵀ m^α and m_L = Lᵀ m^α of the couple stresses in w.stress, and add them to a column of g."""
    m = w.stress
    for c in range(4):
        w.m_M[c] = 0.0
        for a in range(2):
            w.m_M[c] += w.M[a, 0, c] * m[a, 0] + w.M[a, 1, c] * m[a, 1] + w.M[a, 2, c] * m[a, 2]
            w.m_L[a, c] = w.L[0, c] * m[a, 0] + w.L[1, c] * m[a, 1] + w.L[2, c] * m[a, 2]
            w.g[Q1 + 4 * a + c, column] += w.m_L[a, c]
        w.g[Q + c, column] += w.m_M[c]
