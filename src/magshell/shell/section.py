r"""The shell at one point of its mid-surface: thickness-integrated energy gradient and Hessian.

The point sees x, 31 numbers that are linear in the nodal values (theory page, "The point"):

    x = (u,1  u,2 | w,1  w,2 | w | ā | φ | q̂ | q̂,1  q̂,2)      at 0 3 | 6 9 | 12 | 15 | 18 | 19 | 23 27.

Kinematics at the level z, with a_α = A_α + u,α, d = D + w, d_α = D,α + w,α (eqs bfg, F0F1_1 of the source; terms
z² φ,α d and z² φ d,α dropped as there; ā enhances F[0]):

    g_1 = a_1 + z d_1,   g_2 = a_2 + z d_2,   g_3 = (1 + 2 z φ) d + ā,      F = g_i ⊗ G^i,   U = R̃ᵀF.

In place of φ each level may have a stretch of its own, g_3 = (1 + ζ_k) d + ā, eliminated here (`level_stretch.py`).

With the stress vectors t^i = R̃ P G^i and the spin ω of R̃, the variation of U is that of g_i at rest relative to the
micro-rotation, δg_i - δω × g_i, so that per unit volume

    δW  = t^i · (δg_i - δω × g_i)                                   gradient: t^i,  -g_i × t^i
    δ²W = (δg_i - δω × g_i) · C^ij (δg_j - δω × g_j)                C^ij = R̃ (G^i · C · G^j) R̃ᵀ
          - 2 t^i · (δω × δg_i) + t^i · (δω × (δω × g_i))           geometric part
          + 4 z δφ t^3 · δd                                         g_3 is bilinear in φ and d.

In the mixed tangent (Magisano, Leonetti and Garcea 2017) the geometric part uses stresses S', κ' predicted linearly by
the last iteration in place of those of the state; the gradient stays exact. S = U⁻¹ P is the stress of which P = U S
leaves, in δP = δU S + U δS, the part δU S that is geometric: it lies inside C, which therefore gets S' - S.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.compiled import inline
from magshell.magnetics.law import OMEGA, M
from magshell.materials.tensors import fill_inverse_transpose
from magshell.shell.couple_stress import couple_stress
from magshell.shell.kinematics import base_vectors, moduli_on_legs, stress_vectors, stretch
from magshell.shell.level import Laws, carry, stress, work
from magshell.shell.level_stretch import (
    FORCE,
    OWN,
    STIFFNESS,
    ZETA,
    constrain_levels,
    eliminate_level,
    force_and_stiffness,
    force_rate,
    predict_level_stretch,
    solve_level_stretch,
)
from magshell.shell.point import ENHANCED, INTERNAL, MAGNETIC, MIXED, PHI, Q1, U1, W1, Q, Record, W
from magshell.shell.rotation import LAST, NEXT, rotation_matrix, spin_map, wryness_maps
from magshell.shell.varying_field import add_position, clear_position, finish_position, set_slopes


class LocalField(NamedTuple):
    """The external field at the levels.

    Attributes
    ----------
    flux_density : ndarray, shape (elements, p, k, 3)
        T; of a uniform field, that of one element stands for all.
    slopes : ndarray, shape (elements, p, k, 36), or None
        First and second derivatives, T/m and T/m²; None: the field is uniform.
    """

    flux_density: FloatArray
    slopes: FloatArray | None


class Request(NamedTuple):
    """What is asked of points and elements.

    Attributes
    ----------
    laws : Laws
    field : LocalField
    mixed : bool
        Whether the geometric part of the tangent is made with given stresses in place of the state's.
    tangent : bool
        Whether there is to be a tangent.
    """

    laws: Laws
    field: LocalField
    mixed: bool
    tangent: bool


class Mixed(NamedTuple):
    """Stresses S (levels, 3, 3) and wryness κ (2, 3) of the geometric part of a point."""

    S: FloatArray
    kappa: FloatArray


@inline
def _level_hessian(w: Record) -> None:
    """From K_g = C^ij, g and the stresses of the geometric part: K_gω, and add to H_ωω and the couple."""
    g, t, K, K_gω, H_ωω, couple = w.base, w.t_mixed, w.K_g, w.K_gω, w.H_ωω, w.couples[MIXED]
    for a in range(3):
        for i in range(3):
            row = 27 * i + 9 * a
            for l in range(3):
                s = 0.0
                for b in range(3):
                    s += K[row + 3 * NEXT[l] + b] * g[b, LAST[l]] - K[row + 3 * LAST[l] + b] * g[b, NEXT[l]]
                K_gω[a, i, l] = s
    for a in range(3):
        dot = 0.0
        for i in range(3):
            j, k = NEXT[i], LAST[i]
            dot += g[a, i] * t[a, i]
            for l in range(3):
                H_ωω[i, l] += K_gω[a, j, l] * g[a, k] - K_gω[a, k, l] * g[a, j]
                H_ωω[i, l] += 0.5 * (g[a, i] * t[a, l] + t[a, i] * g[a, l])
            couple[i] -= g[a, j] * t[a, k] - g[a, k] * t[a, j]
        for i in range(3):
            H_ωω[i, i] -= dot
            K_gω[a, LAST[i], NEXT[i]] -= t[a, i]
            K_gω[a, NEXT[i], LAST[i]] += t[a, i]


@inline
def _scatter_level(w: Record, z: float, s: float, scale: float, volume: float) -> None:
    """Chain (g_1, g_2, g_3, ω) to (u,α  w,α  w  ā  φ  ω): add to H, H_gω, H_ωg.

    g_3 = s d + ā, and dg3 = ∂g_3/∂φ = scale d; at the place of φ may be ζ. b^a = G^a · B̃ carries the coupling's tangent
    by m; t3 is the whole stress vector t^3 of the bilinear term.
    """
    b, dg3, H, K_g, K_gω, H_gω, H_ωg, T = w.b, w.dg3, w.H, w.K_g, w.K_gω, w.H_gω, w.H_ωg, w.work_tangent
    for a in range(3):
        a1, ca1, a2, ca2 = (12, s, 15, 1.0) if a == 2 else (3 * a, 1.0, 6 + 3 * a, z)
        b_a = volume * b[a]
        for i in range(3):
            column = 0.0
            for c in range(3):
                c1, cc1, c2, cc2 = (12, s, 15, 1.0) if c == 2 else (3 * c, 1.0, 6 + 3 * c, z)
                for j in range(3):
                    h = K_g[27 * i + 9 * a + 3 * j + c] + b_a * b[c] * T[M + i, M + j]
                    H[a1 + i, c1 + j] += ca1 * cc1 * h
                    H[a1 + i, c2 + j] += ca1 * cc2 * h
                    H[a2 + i, c1 + j] += ca2 * cc1 * h
                    H[a2 + i, c2 + j] += ca2 * cc2 * h
                    if c == 2:
                        column += h * dg3[j]
                    if a == 2:
                        H[PHI, c1 + j] += dg3[i] * cc1 * h
                        H[PHI, c2 + j] += dg3[i] * cc2 * h
            H[a1 + i, PHI] += ca1 * column
            H[a2 + i, PHI] += ca2 * column
            if a == 2:
                H[PHI, PHI] += dg3[i] * column
            for j in range(3):
                h_gω = K_gω[a, i, j] + b_a * T[M + i, OMEGA + j]
                h_ωg = K_gω[a, i, j] + b_a * T[OMEGA + j, M + i]
                H_gω[a1 + i, j] += ca1 * h_gω
                H_gω[a2 + i, j] += ca2 * h_gω
                H_ωg[j, a1 + i] += ca1 * h_ωg
                H_ωg[j, a2 + i] += ca2 * h_ωg
                if a == 2:
                    H_gω[PHI, j] += dg3[i] * h_gω
                    H_ωg[j, PHI] += dg3[i] * h_ωg
    for i in range(3):
        H[PHI, W + i] += scale * w.t3[i]
        H[W + i, PHI] += scale * w.t3[i]


@inline
def _spin_to_quaternion(w: Record, n2: float) -> None:
    """Chain the spin to q̂: ω = 2 V δq̂ - 2 (V δq̂)(q̂·δq̂)/n²."""
    V, H, H_ωω, c = w.V, w.H, w.H_ωω, w.couples[MIXED]
    for b in range(4):
        v0, v1, v2 = 2.0 * V[0, b], 2.0 * V[1, b], 2.0 * V[2, b]
        for i in range(Q):
            H[i, Q + b] = w.H_gω[i, 0] * v0 + w.H_gω[i, 1] * v1 + w.H_gω[i, 2] * v2
            H[Q + b, i] = w.H_ωg[0, i] * v0 + w.H_ωg[1, i] * v1 + w.H_ωg[2, i] * v2
        c_b = (c[0] * v0 + c[1] * v1 + c[2] * v2) / n2
        for a in range(4):
            h = 0.0
            for i in range(3):
                h += 2.0 * V[i, a] * (H_ωω[i, 0] * v0 + H_ωω[i, 1] * v1 + H_ωω[i, 2] * v2)
            H[Q + a, Q + b] += h - c_b * w.x[Q + a]
            H[Q + b, Q + a] -= c_b * w.x[Q + a]


@inline
def _second_stress(w: Record, S: FloatArray) -> None:
    """Fill S (3, 3) = U⁻¹ P."""
    V, P = w.U_inverse_transpose, w.P
    fill_inverse_transpose(w.U, V)
    for j in range(3):
        for l in range(3):
            S[j, l] = V[0, j] * P[0, l] + V[1, j] * P[1, l] + V[2, j] * P[2, l]


@inline
def _mix(w: Record, S_mixed: FloatArray) -> None:
    """Put S' in place of S in the geometric part of C, and P = U S'. (Symmetrised in C, as S is but for η.)"""
    S, U, P, C = w.S, w.U, w.P, w.C
    _second_stress(w, S)
    for j in range(3):
        for l in range(3):
            difference = 0.5 * (S_mixed[j, l] - S[j, l] + S_mixed[l, j] - S[l, j])
            for p in range(3):
                C[30 * p + 9 * j + l] += difference
    for p in range(3):
        for l in range(3):
            P[p, l] = U[p, 0] * S_mixed[0, l] + U[p, 1] * S_mixed[1, l] + U[p, 2] * S_mixed[2, l]


@inline
def section(
    w: Record,
    point: Record,
    levels: AnyArray,
    request: Request,
    B: FloatArray,
    slopes: FloatArray | None,
    mixed: Mixed,
    across: FloatArray | None,
) -> float:
    """Gradient and Hessian of a point that sees w.x; returns the least det F through the thickness.

    Fills the internal and the magnetic column of w.g; with a tangent also w.H, and the column of w.g that is the whole
    gradient which the geometric part is made with. Sets w.energy, elastic and magnetic. A point with det F <= 0, or
    whose levels have no equilibrium (0), leaves them unfinished. `across` (4, levels) is scratch; None where no section
    stretches level by level. B (levels, 3) is the field, `slopes` (levels, 36) its derivatives; None: it is uniform.
    """
    x, g, V, base, t, b, dg3, couples = w.x, w.g, w.V, w.base, w.t, w.b, w.dg3, w.couples
    laws, forces, tangent, by_level, c = request.laws, w.forces, request.tangent, False, 0.0
    _clear(w, tangent)
    if slopes is not None:
        clear_position(w, tangent)
    n2 = rotation_matrix(x[Q : Q + 4], w.R)
    spin_map(x[Q : Q + 4], n2, V)
    if across is not None:
        by_level = point.by_level != 0
        if by_level and not solve_level_stretch(w, point, levels, laws, B, across):
            return 0.0
    least = np.inf
    for k in range(len(levels)):
        z, volume, G = levels[k].z, levels[k].volume, levels[k].G
        zeta, scale = 0.0, 2.0 * z
        if across is not None:
            if by_level:
                zeta, scale = across[ZETA, k], 1.0
        s = 1.0 + 2.0 * z * x[PHI] + zeta
        base_vectors(point, z, zeta, x, base)
        J = stretch(w.R, base, G, w.U)
        least = min(least, J)
        if not J > 0.0:
            return J
        w.energy[INTERNAL] += volume * stress(w, point.D, levels[k], laws, across)
        stress_vectors(w.R, w.P, G, volume, t)
        carry(w, G, levels[k].remanence)
        if slopes is not None:
            set_slopes(w, slopes[k])
        for i in range(3):
            dg3[i] = scale * (point.D[i] + x[W + i])
        w.energy[MAGNETIC] += volume * work(w, laws, levels[k].coupling, B[k])
        for i in range(3):
            couples[MAGNETIC, i] += volume * forces[OMEGA + i]
            force = volume * forces[M + i]
            _add_stress_vector(w, INTERNAL, i, z, s, t[0, i], t[1, i], t[2, i])
            _add_stress_vector(w, MAGNETIC, i, z, s, b[0] * force, b[1] * force, b[2] * force)
            j, l = NEXT[i], LAST[i]
            for a in range(3):
                couples[INTERNAL, i] -= base[a, j] * t[a, l] - base[a, l] * t[a, j]
        if tangent:
            if request.mixed:
                _mix(w, mixed.S[k])
            stress_vectors(w.R, w.P, G, volume, w.t_mixed)
            moduli_on_legs(w, G, volume)
            _level_hessian(w)
            for i in range(3):
                force = volume * forces[M + i]
                w.t3[i] = w.t_mixed[2, i] + b[2] * force
                t1, t2 = w.t_mixed[0, i] + b[0] * force, w.t_mixed[1, i] + b[1] * force
                _add_stress_vector(w, MIXED, i, z, s, t1, t2, w.t3[i])
                for l in range(3):
                    w.H_ωω[i, l] += volume * w.work_tangent[OMEGA + i, OMEGA + l]
            _scatter_level(w, z, s, scale, volume)
        if slopes is not None:
            add_position(w, point, z, s, volume, by_level, tangent)
        if tangent:
            if across is not None:
                if by_level:
                    c += eliminate_level(w, levels[k].height)
    if across is not None:
        if by_level:
            g[PHI, INTERNAL], g[PHI, MAGNETIC] = 0.0, 0.0
            if tangent:
                constrain_levels(w, c)
    for i in range(3):
        couples[MIXED, i] += couples[MAGNETIC, i]
    for r in range(4):
        for column in range(3):
            for i in range(3):
                g[Q + r, column] += 2.0 * V[i, r] * couples[column, i]
    if tangent:
        _spin_to_quaternion(w, n2)
        if slopes is not None:
            finish_position(w, by_level)
    w.energy[INTERNAL] += couple_stress(w, point.couple_metric, n2, mixed.kappa, request.mixed, tangent)
    return least


@inline
def _clear(w: Record, tangent: bool) -> None:
    """Put all that is summed to zero."""
    w.couples[:, :], w.energy[:], w.g[:, :] = 0.0, 0.0, 0.0
    if tangent:
        w.H[:, :], w.H_gω[:, :], w.H_ωg[:, :], w.H_ωω[:, :] = 0.0, 0.0, 0.0, 0.0
        w.row[:], w.column[:] = 0.0, 0.0


@inline
def _add_stress_vector(w: Record, column: int, i: int, z: float, s: float, t1: float, t2: float, t3: float) -> None:
    """Chain component i of the stress vectors to the gradient with respect to (u,α  w,α  w  ā  φ)."""
    g = w.g
    g[U1 + i, column] += t1
    g[U1 + 3 + i, column] += t2
    g[W1 + i, column] += z * t1
    g[W1 + 3 + i, column] += z * t2
    g[W + i, column] += s * t3
    g[ENHANCED + i, column] += t3
    g[PHI, column] += w.dg3[i] * t3


@inline
def predicted_stress(
    w: Record,
    point: Record,
    levels: AnyArray,
    laws: Laws,
    B: FloatArray,
    S_mixed: FloatArray,
    kappa_mixed: FloatArray,
    across: FloatArray | None,
) -> None:
    """Fill S' = U⁻¹ (P + C : ΔU - ΔU S) (levels, 3, 3), κ' = κ + Δκ (2, 3), linear in the increment w.dx (31,).

    B (levels, 3) is the field.

    `across` (4, levels) is scratch; None where no section stretches level by level.
    """
    x, dx, S, C, P, dU, dP = w.x, w.dx, w.S, w.C, w.P, w.dU, w.dP
    q, dq, ω, by_level = x[Q : Q + 4], dx[Q : Q + 4], w.spin, False
    n2 = rotation_matrix(q, w.R)
    spin_map(q, n2, w.V)
    for i in range(3):
        ω[i] = 2.0 * (w.V[i, 0] * dq[0] + w.V[i, 1] * dq[1] + w.V[i, 2] * dq[2] + w.V[i, 3] * dq[3])
    if across is not None:
        by_level = point.by_level != 0
        if by_level:
            solve_level_stretch(w, point, levels, laws, B, across)
            for k in range(len(levels)):
                zeta = across[ZETA, k]
                _, across[STIFFNESS, k] = force_and_stiffness(w, point, levels[k], laws, B[k], zeta, across)
                _increments(w, point, levels[k], zeta, 0.0)
                across[FORCE, k] = force_rate(w, point, levels[k], ω)
                across[OWN, k], across[ZETA, k] = zeta, 0.0
            predict_level_stretch(levels, across)
    for k in range(len(levels)):
        own, change = 0.0, 0.0
        if across is not None:
            if by_level:
                own, change = across[OWN, k], across[ZETA, k]
        base_vectors(point, levels[k].z, own, x, w.base)
        stretch(w.R, w.base, levels[k].G, w.U)
        stress(w, point.D, levels[k], laws, across)
        _increments(w, point, levels[k], own, change)
        _second_stress(w, S)
        for i in range(3):
            for j in range(3):
                value = -dU[i, 0] * S[0, j] - dU[i, 1] * S[1, j] - dU[i, 2] * S[2, j]
                for l in range(3):
                    for r in range(3):
                        value += C[27 * i + 9 * j + 3 * l + r] * dU[l, r]
                dP[i, j] = value
        for i in range(3):
            for j in range(3):
                P[i, j] += dP[i, j]
        _second_stress(w, S_mixed[k])
    for a in range(2):
        at = Q1 + 4 * a
        wryness_maps(q, x[at : at + 4], n2, w.L, w.M, w.kappa[a])
        for i in range(3):
            value = w.kappa[a, i]
            for r in range(4):
                value += w.L[i, r] * dx[at + r] + w.M[i, r] * dq[r]
            kappa_mixed[a, i] = value


@inline
def _increments(w: Record, point: Record, level: Record, zeta: float, d_zeta: float) -> None:
    """Fill dg and dU = R̃ᵀ (dg_i - ω × g_i) ⊗ G^i along w.dx, the spin w.spin and an increment of ζ."""
    x, dx, g, t, dg, ω, z = w.x, w.dx, w.base, w.t, w.dg, w.spin, level.z
    for i in range(3):
        d = point.D[i] + x[W + i]
        dg[0, i] = dx[U1 + i] + z * dx[W1 + i]
        dg[1, i] = dx[U1 + 3 + i] + z * dx[W1 + 3 + i]
        s = 1.0 + 2.0 * z * x[PHI] + zeta
        dg[2, i] = s * dx[W + i] + (2.0 * z * dx[PHI] + d_zeta) * d + dx[ENHANCED + i]
    for i in range(3):
        for a in range(3):
            t[a, i] = dg[a, i] - (ω[NEXT[i]] * g[a, LAST[i]] - ω[LAST[i]] * g[a, NEXT[i]])
    stretch(w.R, t, level.G, w.dU)
