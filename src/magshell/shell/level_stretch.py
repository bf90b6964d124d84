r"""A stretch of its own at every level, in place of φ, eliminated at the point.

    g_3 = (1 + ζ_k) d + ā,      Σ_k c_k ζ_k = 0,      c_k the heights of the levels.

The energy is stationary in ζ: with f_k the force on ζ_k,

    f_k = d · t³_k = λ c_k                                                  k = 1 … n,

that is, P33 is the same at every level. That it has no mean is the equation of w along the director. (P33 = 0 at each
level by itself would leave the length of d without stiffness.) With two levels ζ is 2 z φ, and this is plane stress.

Newton's method for ζ needs only the diagonal s_k = ∂f_k/∂ζ_k:

    Δζ_k = (λ c_k - f_k) / s_k,      λ = Σ (c_k f_k / s_k) / Σ (c_k² / s_k).

In the Hessian H of the point's x, with the columns h_k = ∂²W/∂x∂ζ_k and the rows h'_k (not the same where a coupling
law has no energy),

    H ← H - Σ_k h_k h'_k / s_k + a a' / c,    a = Σ_k c_k h_k / s_k,    a' = Σ_k c_k h'_k / s_k,    c = Σ_k c_k² / s_k.

The place of φ in H serves each level in turn for its ζ_k.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.compiled import allocate, inline
from magshell.magnetics.law import OMEGA, M
from magshell.shell.kinematics import base_vectors, stretch
from magshell.shell.level import Laws, carry, stress, work
from magshell.shell.point import PHI, Q, Record, W
from magshell.shell.rotation import LAST, NEXT

STEPS = 30
# Stretches: round-off, and the most that one step may change.
ROUND_OFF, LARGEST = 1e-13, 0.3
# Rows of the scratch array (4, levels); the last is of a state from which ζ is predicted.
ZETA, FORCE, STIFFNESS, OWN = 0, 1, 2, 3


@allocate
def level_scratch(by_level: AnyArray | None, levels: int) -> FloatArray | None:
    """The scratch array; None where no section stretches level by level: then nothing of this file is compiled."""
    if by_level is None:
        return None
    return np.zeros((4, levels))


@inline
def solve_level_stretch(
    w: Record, point: Record, levels: AnyArray, laws: Laws, B: FloatArray, across: FloatArray
) -> bool:
    """Fill across[ZETA] (levels,) for w.x, w.R and the field B (levels, 3); False where no equilibrium is found.

    A point of weight zero has nothing to eliminate.
    """
    zeta = across[ZETA]
    for k in range(len(levels)):
        zeta[k] = 0.0
    if levels[0].volume == 0.0:
        return True
    for _ in range(STEPS):
        force, compliance = 0.0, 0.0
        for k in range(len(levels)):
            f, s = force_and_stiffness(w, point, levels[k], laws, B[k], zeta[k], across)
            if not s > 0.0:
                return False
            force += levels[k].height * f / s
            compliance += levels[k].height ** 2 / s
            across[FORCE, k], across[STIFFNESS, k] = f, s
        largest = 0.0
        for k in range(len(levels)):
            across[FORCE, k] = (levels[k].height * force / compliance - across[FORCE, k]) / across[STIFFNESS, k]
            largest = max(largest, abs(across[FORCE, k]))
        share = LARGEST / max(largest, LARGEST)
        for k in range(len(levels)):
            zeta[k] += share * across[FORCE, k]
        if largest < ROUND_OFF:
            return True
    return False


@inline
def force_and_stiffness(
    w: Record, point: Record, level: Record, laws: Laws, B: FloatArray, zeta: float, across: FloatArray
) -> tuple[float, float]:
    """Force on ζ of a level and its derivative, with the base vectors, P and C there; 0 where it is inside out."""
    base_vectors(point, level.z, zeta, w.x, w.base)
    if not stretch(w.R, w.base, level.G, w.U) > 0.0:
        return 0.0, 0.0
    stress(w, point.D, level, laws, across)
    _leg(w, point, level.G)
    f, s, P, leg, C = 0.0, 0.0, w.P.reshape(9), w.leg, w.C
    for a in range(9):
        f += P[a] * leg[a]
        for b in range(9):
            s += leg[a] * C[9 * a + b] * leg[b]
    carry(w, level.G, level.remanence)
    if w.b[2] != 0.0:
        work(w, laws, level.coupling, B)
        for i in range(3):
            d_i = w.b[2] * (point.D[i] + w.x[W + i])
            f += w.forces[M + i] * d_i
            for j in range(3):
                s += d_i * w.work_tangent[M + i, M + j] * w.b[2] * (point.D[j] + w.x[W + j])
    return level.volume * f, level.volume * s


@inline
def _leg(w: Record, point: Record, G: FloatArray) -> None:
    """Fill ∂U/∂ζ = R̃ᵀd ⊗ G³."""
    for p in range(3):
        e = 0.0
        for i in range(3):
            e += w.R[i, p] * (point.D[i] + w.x[W + i])
        for j in range(3):
            w.leg[3 * p + j] = e * G[2, j]


@inline
def predict_level_stretch(levels: AnyArray, across: FloatArray) -> None:
    """Fill across[ZETA] with the increments that forces grown by across[FORCE] make, with across[STIFFNESS]."""
    force, compliance = 0.0, 0.0
    for k in range(len(levels)):
        if across[STIFFNESS, k] == 0.0:
            return
        force += levels[k].height * across[FORCE, k] / across[STIFFNESS, k]
        compliance += levels[k].height ** 2 / across[STIFFNESS, k]
    for k in range(len(levels)):
        across[ZETA, k] = (levels[k].height * force / compliance - across[FORCE, k]) / across[STIFFNESS, k]


@inline
def force_rate(w: Record, point: Record, level: Record, ω: FloatArray) -> float:
    """How the force on ζ grows along w.dU, w.dx and the spin ω at fixed ζ; P, C and the coupling's parts are there."""
    f, x, dx, dU, leg, C = 0.0, w.x, w.dx, w.dU.reshape(9), w.leg, w.C
    for a in range(9):
        for b in range(9):
            f += leg[a] * C[9 * a + b] * dU[b]
    for p in range(3):
        e = 0.0
        for i in range(3):
            j, l = NEXT[i], LAST[i]
            turned = ω[j] * (point.D[l] + x[W + l]) - ω[l] * (point.D[j] + x[W + j])
            e += w.R[i, p] * (dx[W + i] - turned)
        for j in range(3):
            f += w.P[p, j] * e * level.G[2, j]
    if w.b[2] != 0.0:
        for i in range(3):
            f += w.b[2] * w.forces[M + i] * dx[W + i]
            d_i = w.b[2] * (point.D[i] + x[W + i])
            for j in range(3):
                dm_j = w.b[0] * w.dg[0, j] + w.b[1] * w.dg[1, j] + w.b[2] * w.dg[2, j]
                f += d_i * (w.work_tangent[M + i, M + j] * dm_j + w.work_tangent[M + i, OMEGA + j] * ω[j])
    return level.volume * f


@inline
def eliminate_level(w: Record, height: float) -> float:
    """Take the ζ of a level, at the place of φ, out of w.H and the couples' parts; add to a and a'.

    Returns the level's share of c.
    """
    H, H_gω, H_ωg, H_ωω, row, column = w.H, w.H_gω, w.H_ωg, w.H_ωω, w.row, w.column
    s = H[PHI, PHI]
    if s == 0.0:
        return 0.0
    for i in range(PHI):
        share = H[i, PHI] / s
        column[i] += height * share
        row[i] += height * H[PHI, i] / s
        for j in range(PHI):
            H[i, j] -= share * H[PHI, j]
        for l in range(3):
            H_gω[i, l] -= share * H_gω[PHI, l]
    for l in range(3):
        share = H_ωg[l, PHI] / s
        column[Q + l] += height * share
        row[Q + l] += height * H_gω[PHI, l] / s
        for j in range(PHI):
            H_ωg[l, j] -= share * H[PHI, j]
        for m in range(3):
            H_ωω[l, m] -= share * H_gω[PHI, m]
    for i in range(Q):
        H[i, PHI], H[PHI, i] = 0.0, 0.0
    for l in range(3):
        H_gω[PHI, l], H_ωg[l, PHI] = 0.0, 0.0
    return height**2 / s


@inline
def constrain_levels(w: Record, c: float) -> None:
    """Add a a' / c to w.H and the couples' parts."""
    if c == 0.0:
        return
    row, column = w.row, w.column
    for i in range(PHI):
        share = column[i] / c
        for j in range(PHI):
            w.H[i, j] += share * row[j]
        for l in range(3):
            w.H_gω[i, l] += share * row[Q + l]
    for l in range(3):
        share = column[Q + l] / c
        for j in range(PHI):
            w.H_ωg[l, j] += share * row[j]
        for m in range(3):
            w.H_ωω[l, m] += share * row[Q + m]
