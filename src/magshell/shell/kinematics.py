"""The level z of a section: base vectors, stretch, and stresses and moduli on the base vectors' legs."""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.point import ENHANCED, PHI, U1, W1, Record, W
from magshell.shell.rotation import LAST, NEXT


@inline
def base_vectors(point: Record, z: float, zeta: float, x: FloatArray, g: FloatArray) -> None:
    """Fill g (3, 3): rows g_1, g_2, g_3 at the level z, which has the stretch zeta of its own."""
    for i in range(3):
        g[0, i] = point.A[0, i] + x[U1 + i] + z * (point.dD[0, i] + x[W1 + i])
        g[1, i] = point.A[1, i] + x[U1 + 3 + i] + z * (point.dD[1, i] + x[W1 + 3 + i])
        g[2, i] = (1.0 + 2.0 * z * x[PHI] + zeta) * (point.D[i] + x[W + i]) + x[ENHANCED + i]


@inline
def stretch(R: FloatArray, g: FloatArray, G: FloatArray, U: FloatArray) -> float:
    """Fill U = R̃ᵀ (g_i ⊗ G^i) and return its determinant."""
    for i in range(3):
        for j in range(3):
            U[i, j] = 0.0
        for a in range(3):
            turned = 0.0
            for l in range(3):
                turned += R[l, i] * g[a, l]
            for j in range(3):
                U[i, j] += turned * G[a, j]
    J = 0.0
    for j in range(3):
        J += U[0, j] * (U[1, NEXT[j]] * U[2, LAST[j]] - U[1, LAST[j]] * U[2, NEXT[j]])
    return J


@inline
def stress_vectors(R: FloatArray, P: FloatArray, G: FloatArray, volume: float, t: FloatArray) -> None:
    """Fill t (3, 3): rows t^a = volume R̃ P G^a."""
    for a in range(3):
        for i in range(3):
            t[a, i] = 0.0
        for p in range(3):
            leg = 0.0
            for j in range(3):
                leg += volume * P[p, j] * G[a, j]
            for i in range(3):
                t[a, i] += R[i, p] * leg


@inline
def moduli_on_legs(w: Record, G: FloatArray, volume: float) -> None:
    """Fill K_g[i, a, k, b] = volume R_ip G^a_j R_kq G^b_l C_pjql from w.C, one index after the other."""
    for index in range(4):
        source = w.C if index == 0 else w.K_g if index == 2 else w.C_half
        target = w.K_g if index == 1 or index == 3 else w.C_half
        _turn_last(source, G if index == 0 or index == 2 else w.R, volume if index == 0 else 1.0, target)


@inline
def _turn_last(A: FloatArray, M: FloatArray, factor: float, out: FloatArray) -> None:
    """Fill out[m, i, j, k] = factor M_ml A[i, j, k, l], both (81,)."""
    for x in range(27):
        for m in range(3):
            out[27 * m + x] = factor * (M[m, 0] * A[3 * x] + M[m, 1] * A[3 * x + 1] + M[m, 2] * A[3 * x + 2])
