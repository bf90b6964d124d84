r"""The couple stress at a point: ½ c^αβ κ_α · κ_β with c^αβ = gamma Σ_k volume G^α · G^β.

With δκ = L δq̂,α + M δq̂ (rotation.py), m^α = c^αβ κ_β and n² = |q̂|²:

    gradient   (q̂: Mᵀm, q̂,α: Lᵀm),      Hessian   (M L)ᵀ c (M L) + m^α · δ²κ_α.

The last term comes from κ = 2 vec(q̂* q̂,α) / n²: its bilinear numerator, δq̂ · Z(m) δq̂,α, and the factor 1/n².
"""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.point import Q1, Q, Workspace
from magshell.shell.rotation import wryness_maps


@inline
def _add_pair(H: FloatArray, i: int, j: int, value: float) -> None:
    H[i, j] += value
    H[j, i] += value


@inline
def couple_stress(
    w: Workspace,
    modulus: float,
    metric: FloatArray,
    x: FloatArray,
    n2: float,
    kappa_mixed: FloatArray,
    mixed: bool,
    tangent: bool,
    g: FloatArray,
    g_mixed: FloatArray,
    H: FloatArray,
) -> None:
    """Add ½ c^αβ κ_α · κ_β: gradient and Hessian with respect to (q̂, q̂,1, q̂,2)."""
    q = x[Q : Q + 4]
    for a in range(2):
        wryness_maps(q, x[Q1 + 4 * a : Q1 + 4 * a + 4], n2, w.L[a], w.M[a], w.kappa[a])
    for a in range(2):
        for i in range(3):
            w.stress[a, i] = modulus * (metric[a, 0] * w.kappa[0, i] + metric[a, 1] * w.kappa[1, i])
    for a in range(2):
        for i in range(3):
            for c in range(4):
                g[Q + c] += w.M[a, i, c] * w.stress[a, i]
                g[Q1 + 4 * a + c] += w.L[a, i, c] * w.stress[a, i]
    if not tangent:
        return
    if mixed:
        for a in range(2):
            for i in range(3):
                w.stress[a, i] = modulus * (metric[a, 0] * kappa_mixed[0, i] + metric[a, 1] * kappa_mixed[1, i])
    for a in range(2):
        for i in range(3):
            for c in range(4):
                g_mixed[Q + c] += w.M[a, i, c] * w.stress[a, i]
                g_mixed[Q1 + 4 * a + c] += w.L[a, i, c] * w.stress[a, i]
    for a in range(2):
        for b in range(2):
            c_ab = modulus * metric[a, b]
            for r in range(4):
                for c in range(4):
                    qq, qr, rr = 0.0, 0.0, 0.0
                    for i in range(3):
                        qq += w.M[a, i, r] * w.M[b, i, c]
                        qr += w.M[a, i, r] * w.L[b, i, c]
                        rr += w.L[a, i, r] * w.L[b, i, c]
                    H[Q + r, Q + c] += c_ab * qq
                    H[Q + r, Q1 + 4 * b + c] += c_ab * qr
                    H[Q1 + 4 * b + c, Q + r] += c_ab * qr
                    H[Q1 + 4 * a + r, Q1 + 4 * b + c] += c_ab * rr
    two = 2.0 / n2
    for a in range(2):
        m = w.stress[a]
        at = Q1 + 4 * a
        # δq̂ · Z δr with m · vec(δq̂* δr) = δq̂ · Z δr
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            _add_pair(H, Q, at + 1 + i, two * m[i])
            _add_pair(H, Q + 1 + i, at, -two * m[i])
            _add_pair(H, Q + 1 + k, at + 1 + j, two * m[i])
            _add_pair(H, Q + 1 + j, at + 1 + k, -two * m[i])
        # derivatives of the factor 1/n²
        kappa_m = w.kappa[a, 0] * m[0] + w.kappa[a, 1] * m[1] + w.kappa[a, 2] * m[2]
        for r in range(4):
            m_L = w.L[a, 0, r] * m[0] + w.L[a, 1, r] * m[1] + w.L[a, 2, r] * m[2]
            m_M = w.M[a, 0, r] * m[0] + w.M[a, 1, r] * m[1] + w.M[a, 2, r] * m[2]
            for c in range(4):
                _add_pair(H, Q + c, at + r, -two * q[c] * m_L)
                H[Q + r, Q + c] -= two * q[c] * m_M
                H[Q + c, Q + r] -= two * q[c] * m_M
            H[Q + r, Q + r] -= two * kappa_m
