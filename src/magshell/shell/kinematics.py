"""The level z of a section: base vectors, stretch, and stresses and moduli on the base vectors' legs."""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.point import ENHANCED, PHI, U1, W1, Record, W


@inline
def base_vectors(point: Record, z: float, x: FloatArray, g: FloatArray) -> None:
    """Fill g (3, 3): rows g_1, g_2, g_3 at the level z."""
    for i in range(3):
        g[0, i] = point.A[0, i] + x[U1 + i] + z * (point.dD[0, i] + x[W1 + i])
        g[1, i] = point.A[1, i] + x[U1 + 3 + i] + z * (point.dD[1, i] + x[W1 + 3 + i])
        g[2, i] = (1.0 + 2.0 * z * x[PHI]) * (point.D[i] + x[W + i]) + x[ENHANCED + i]


@inline
def stretch(R: FloatArray, g: FloatArray, G: FloatArray, U: FloatArray) -> float:
    """Fill U = R̃ᵀ (g_i ⊗ G^i) and return its determinant."""
    for i in range(3):
        r0 = R[0, i] * g[0, 0] + R[1, i] * g[0, 1] + R[2, i] * g[0, 2]
        r1 = R[0, i] * g[1, 0] + R[1, i] * g[1, 1] + R[2, i] * g[1, 2]
        r2 = R[0, i] * g[2, 0] + R[1, i] * g[2, 1] + R[2, i] * g[2, 2]
        for j in range(3):
            U[i, j] = r0 * G[0, j] + r1 * G[1, j] + r2 * G[2, j]
    return (
        U[0, 0] * (U[1, 1] * U[2, 2] - U[1, 2] * U[2, 1])
        + U[0, 1] * (U[1, 2] * U[2, 0] - U[1, 0] * U[2, 2])
        + U[0, 2] * (U[1, 0] * U[2, 1] - U[1, 1] * U[2, 0])
    )


@inline
def stress_vectors(R: FloatArray, P: FloatArray, G: FloatArray, volume: float, t: FloatArray) -> None:
    """Fill t (3, 3): rows t^a = volume R̃ P G^a."""
    for a in range(3):
        p0 = volume * (P[0, 0] * G[a, 0] + P[0, 1] * G[a, 1] + P[0, 2] * G[a, 2])
        p1 = volume * (P[1, 0] * G[a, 0] + P[1, 1] * G[a, 1] + P[1, 2] * G[a, 2])
        p2 = volume * (P[2, 0] * G[a, 0] + P[2, 1] * G[a, 1] + P[2, 2] * G[a, 2])
        for i in range(3):
            t[a, i] = R[i, 0] * p0 + R[i, 1] * p1 + R[i, 2] * p2


@inline
def moduli_on_legs(R: FloatArray, G: FloatArray, volume: float, C: FloatArray, half: FloatArray, K: FloatArray) -> None:
    """Fill K[a, i, b, k] = volume R_ip R_kq G^a_j G^b_l C_pjql, one leg after the other."""
    for p in range(3):
        for j in range(3):
            for q in range(3):
                c0, c1, c2 = C[p, j, q, 0], C[p, j, q, 1], C[p, j, q, 2]
                for b in range(3):
                    half[p, j, q, b] = volume * (c0 * G[b, 0] + c1 * G[b, 1] + c2 * G[b, 2])
    for p in range(3):
        for j in range(3):
            for b in range(3):
                c0, c1, c2 = half[p, j, 0, b], half[p, j, 1, b], half[p, j, 2, b]
                for k in range(3):
                    C[p, j, b, k] = R[k, 0] * c0 + R[k, 1] * c1 + R[k, 2] * c2
    for p in range(3):
        for a in range(3):
            for b in range(3):
                for k in range(3):
                    half[p, a, b, k] = G[a, 0] * C[p, 0, b, k] + G[a, 1] * C[p, 1, b, k] + G[a, 2] * C[p, 2, b, k]
    for a in range(3):
        for i in range(3):
            for b in range(3):
                for k in range(3):
                    K[a, i, b, k] = R[i, 0] * half[0, a, b, k] + R[i, 1] * half[1, a, b, k] + R[i, 2] * half[2, a, b, k]
