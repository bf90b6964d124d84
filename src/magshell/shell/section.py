r"""The shell at one point of its mid-surface: thickness-integrated energy gradient and Hessian.

The point sees x, 31 numbers that are linear in the nodal values (theory page, "The point"):

    x = (u,1  u,2 | w,1  w,2 | w | ā | φ | q̂ | q̂,1  q̂,2)      at 0 3 | 6 9 | 12 | 15 | 18 | 19 | 23 27.

Kinematics at the level z, with a_α = A_α + u,α, d = D + w, d_α = D,α + w,α (eqs bfg, F0F1_1 of the source; terms
z² φ,α d and z² φ d,α dropped as there; ā enhances F[0]):

    g_1 = a_1 + z d_1,   g_2 = a_2 + z d_2,   g_3 = (1 + 2 z φ) d + ā,      F = g_i ⊗ G^i,   U = R̃ᵀF.

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

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.compiled import also_compiled, choose_by_type, inline
from magshell.magnetics import law as coupling_laws
from magshell.magnetics.law import Coupling
from magshell.materials import law as material_laws
from magshell.materials.law import Material
from magshell.materials.tensors import fill_inverse_transpose, inverse_transpose
from magshell.shell.couple_stress import couple_stress
from magshell.shell.geometry import SectionGeometry
from magshell.shell.kinematics import base_vectors, moduli_on_legs, stress_vectors, stretch
from magshell.shell.point import ENHANCED, PHI, Q1, U1, W1, Q, W, Workspace
from magshell.shell.rotation import LAST, NEXT, rotation_matrix, spin_map, wryness_maps


def _stress_and_tangent(material: Material, U: FloatArray, P: FloatArray, C: FloatArray) -> None:
    """Stand-in that the compiler replaces by the function of the law in use."""


def _forces_and_tangent(
    coupling: Coupling,
    m: FloatArray,
    n: FloatArray,
    B: FloatArray,
    f: FloatArray,
    c: FloatArray,
    K_m: FloatArray,
    K_ω: FloatArray,
) -> None:
    """Stand-in that the compiler replaces by the function of the law in use."""


also_compiled(fill_inverse_transpose)
also_compiled(inverse_transpose)
choose_by_type(_stress_and_tangent, material_laws.stresses_of)
choose_by_type(_forces_and_tangent, coupling_laws.forces_of)


@inline
def _level_hessian(w: Workspace, c_ω: FloatArray) -> None:
    """From K_g = C^ij, g and the stresses of the geometric part: K_gω, and add to H_ωω."""
    g, t, K = w.g, w.t_mixed, w.K_g
    for a in range(3):
        for i in range(3):
            s0, s1, s2 = 0.0, 0.0, 0.0
            for b in range(3):
                c0, c1, c2 = K[a, i, b, 0], K[a, i, b, 1], K[a, i, b, 2]
                s0 += c1 * g[b, 2] - c2 * g[b, 1]
                s1 += c2 * g[b, 0] - c0 * g[b, 2]
                s2 += c0 * g[b, 1] - c1 * g[b, 0]
            w.K_gω[a, i, 0], w.K_gω[a, i, 1], w.K_gω[a, i, 2] = s0, s1, s2
    for a in range(3):
        dot = g[a, 0] * t[a, 0] + g[a, 1] * t[a, 1] + g[a, 2] * t[a, 2]
        for i in range(3):
            j, k = NEXT[i], LAST[i]
            for l in range(3):
                w.H_ωω[i, l] += w.K_gω[a, j, l] * g[a, k] - w.K_gω[a, k, l] * g[a, j]
                w.H_ωω[i, l] += 0.5 * (g[a, i] * t[a, l] + t[a, i] * g[a, l])
            w.H_ωω[i, i] -= dot
            c_ω[i] -= g[a, j] * t[a, k] - g[a, k] * t[a, j]
    for a in range(3):
        for i in range(3):
            j, k = NEXT[i], LAST[i]
            w.K_gω[a, k, j] -= t[a, i]
            w.K_gω[a, j, k] += t[a, i]


@inline
def _scatter_level(
    w: Workspace,
    z: float,
    phi: float,
    d2z: FloatArray,
    b: FloatArray,
    t3: FloatArray,
    volume: float,
    H: FloatArray,
) -> None:
    """Chain (g_1, g_2, g_3, ω) to (u,α  w,α  w  ā  φ  ω): add to H, H_gω, H_ωg.

    b^a = G^a · B̃ carries the magnetic K_m; d2z = 2 z d; t3 the whole stress vector t^3 of the bilinear term.
    """
    s = 1.0 + 2.0 * z * phi
    for a in range(3):
        a1, ca1, a2, ca2 = (12, s, 15, 1.0) if a == 2 else (3 * a, 1.0, 6 + 3 * a, z)
        for c in range(3):
            c1, cc1, c2, cc2 = (12, s, 15, 1.0) if c == 2 else (3 * c, 1.0, 6 + 3 * c, z)
            k11, k12, k21, k22 = ca1 * cc1, ca1 * cc2, ca2 * cc1, ca2 * cc2
            for i in range(3):
                for j in range(3):
                    h = w.K_g[a, i, c, j]
                    H[a1 + i, c1 + j] += k11 * h
                    H[a1 + i, c2 + j] += k12 * h
                    H[a2 + i, c1 + j] += k21 * h
                    H[a2 + i, c2 + j] += k22 * h
        for j in range(3):
            h = d2z[0] * w.K_g[a, j, 2, 0] + d2z[1] * w.K_g[a, j, 2, 1] + d2z[2] * w.K_g[a, j, 2, 2]
            if a == 2:
                H[PHI, PHI] += d2z[j] * h
            H[a1 + j, PHI] += ca1 * h
            H[a2 + j, PHI] += ca2 * h
            H[PHI, a1 + j] += ca1 * h
            H[PHI, a2 + j] += ca2 * h
        for i in range(3):
            for j in range(3):
                h = w.K_gω[a, i, j]
                w.H_gω[a1 + i, j] += ca1 * h
                w.H_gω[a2 + i, j] += ca2 * h
                h += volume * b[a] * w.K_m[j, i]
                w.H_ωg[j, a1 + i] += ca1 * h
                w.H_ωg[j, a2 + i] += ca2 * h
                if a == 2:
                    w.H_gω[PHI, j] += d2z[i] * w.K_gω[a, i, j]
                    w.H_ωg[j, PHI] += d2z[i] * h
    for i in range(3):
        H[PHI, W + i] += 2.0 * z * t3[i]
        H[W + i, PHI] += 2.0 * z * t3[i]


@inline
def _spin_to_quaternion(w: Workspace, q: FloatArray, n2: float, c: FloatArray, H: FloatArray) -> None:
    """Chain the spin to q̂: ω = 2 V δq̂ - 2 (V δq̂)(q̂·δq̂)/n²; c is the gradient with respect to ω."""
    for i in range(Q):
        for b in range(4):
            H[i, Q + b] = 2.0 * (w.H_gω[i, 0] * w.V[0, b] + w.H_gω[i, 1] * w.V[1, b] + w.H_gω[i, 2] * w.V[2, b])
            H[Q + b, i] = 2.0 * (w.H_ωg[0, i] * w.V[0, b] + w.H_ωg[1, i] * w.V[1, b] + w.H_ωg[2, i] * w.V[2, b])
    for a in range(4):
        h0 = 4.0 * (w.V[0, a] * w.H_ωω[0, 0] + w.V[1, a] * w.H_ωω[1, 0] + w.V[2, a] * w.H_ωω[2, 0])
        h1 = 4.0 * (w.V[0, a] * w.H_ωω[0, 1] + w.V[1, a] * w.H_ωω[1, 1] + w.V[2, a] * w.H_ωω[2, 1])
        h2 = 4.0 * (w.V[0, a] * w.H_ωω[0, 2] + w.V[1, a] * w.H_ωω[1, 2] + w.V[2, a] * w.H_ωω[2, 2])
        c_a = w.V[0, a] * c[0] + w.V[1, a] * c[1] + w.V[2, a] * c[2]
        for b in range(4):
            c_b = w.V[0, b] * c[0] + w.V[1, b] * c[1] + w.V[2, b] * c[2]
            H[Q + a, Q + b] = h0 * w.V[0, b] + h1 * w.V[1, b] + h2 * w.V[2, b]
            H[Q + a, Q + b] -= 2.0 * (c_a * q[b] + c_b * q[a]) / n2


@inline
def _second_stress(w: Workspace, S: FloatArray) -> None:
    """Fill S (3, 3) = U⁻¹ P."""
    V = w.U_inverse_transpose
    fill_inverse_transpose(w.U, V)
    for j in range(3):
        for l in range(3):
            S[j, l] = V[0, j] * w.P[0, l] + V[1, j] * w.P[1, l] + V[2, j] * w.P[2, l]


@inline
def _mix(w: Workspace, S_mixed: FloatArray) -> None:
    """Put S' in place of S in the geometric part of C, and P = U S'. (Symmetrised in C, as S is but for η.)"""
    S = w.S
    _second_stress(w, S)
    for j in range(3):
        for l in range(3):
            difference = 0.5 * (S_mixed[j, l] - S[j, l] + S_mixed[l, j] - S[l, j])
            for p in range(3):
                w.C[p, j, p, l] += difference
    for p in range(3):
        for l in range(3):
            w.P[p, l] = w.U[p, 0] * S_mixed[0, l] + w.U[p, 1] * S_mixed[1, l] + w.U[p, 2] * S_mixed[2, l]


@inline
def section(
    material: Material,
    couple_modulus: float,
    coupling: Coupling,
    B: FloatArray,
    geometry: SectionGeometry,
    remanence: FloatArray,
    e: int,
    p: int,
    x: FloatArray,
    S_mixed: FloatArray,
    kappa_mixed: FloatArray,
    mixed: bool,
    tangent: bool,
    scratch: AnyArray,
    g: FloatArray,
    g_mixed: FloatArray,
    H: FloatArray,
) -> float:
    """Gradient and Hessian of point p of element e; returns the least det F through the thickness.

    Fills the columns of g (31, 2), internal and magnetic gradient; with `tangent` also H (31, 31), and g_mixed (31,),
    the whole gradient that the geometric part is made with. A point with det F <= 0 leaves them unfinished.
    """
    w = scratch[0]
    g[:, :] = 0.0
    if tangent:
        g_mixed[:], H[:, :], w.H_gω[:, :], w.H_ωg[:, :], w.H_ωω[:, :] = 0.0, 0.0, 0.0, 0.0, 0.0
    q = x[Q : Q + 4]
    n2 = rotation_matrix(q, w.R)
    spin_map(q, n2, w.V)
    m, n, f, c, b, d2z = w.vectors[0], w.vectors[1], w.vectors[2], w.vectors[3], w.vectors[4], w.vectors[5]
    rem = remanence[e, p]
    for i in range(3):
        n[i] = w.R[i, 0] * rem[0] + w.R[i, 1] * rem[1] + w.R[i, 2] * rem[2]
    couple, couple_magnetic, couple_mixed = w.couples[0], w.couples[1], w.couples[2]
    w.couples[:, :] = 0.0
    least = np.inf
    for k in range(geometry.z.size):
        z, volume, G = geometry.z[k], geometry.volume[e, p, k], geometry.G[e, p, k]
        base_vectors(geometry, e, p, z, x, w.g)
        J = stretch(w.R, w.g, G, w.U)
        least = min(least, J)
        if not J > 0.0:
            return J
        _stress_and_tangent(material, w.U, w.P, w.C)
        stress_vectors(w.R, w.P, G, volume, w.t)
        for a in range(3):
            b[a] = G[a, 0] * rem[0] + G[a, 1] * rem[1] + G[a, 2] * rem[2]
        for i in range(3):
            m[i] = b[0] * w.g[0, i] + b[1] * w.g[1, i] + b[2] * w.g[2, i]
            d2z[i] = 2.0 * z * (geometry.D[e, p, i] + x[W + i])
        _forces_and_tangent(coupling, m, n, B, f, c, w.K_m, w.K_ω)
        for i in range(3):
            couple_magnetic[i] += volume * c[i]
            _add_stress_vector(g[:, 0], i, z, x[PHI], w.t[0, i], w.t[1, i], w.t[2, i], d2z[i])
            f_i = volume * f[i]
            _add_stress_vector(g[:, 1], i, z, x[PHI], b[0] * f_i, b[1] * f_i, b[2] * f_i, d2z[i])
            j, l = NEXT[i], LAST[i]
            for a in range(3):
                couple[i] -= w.g[a, j] * w.t[a, l] - w.g[a, l] * w.t[a, j]
        if tangent:
            if mixed:
                _mix(w, S_mixed[k])
                stress_vectors(w.R, w.P, G, volume, w.t_mixed)
            else:
                for a in range(3):
                    for i in range(3):
                        w.t_mixed[a, i] = w.t[a, i]
            moduli_on_legs(w.R, G, volume, w.C, w.C_half, w.K_g)
            _level_hessian(w, couple_mixed)
            for i in range(3):
                f[i] = w.t_mixed[2, i] + volume * b[2] * f[i]
                for l in range(3):
                    w.H_ωω[i, l] += volume * w.K_ω[i, l]
            _scatter_level(w, z, x[PHI], d2z, b, f, volume, H)
    for r in range(4):
        for i in range(3):
            g[Q + r, 0] += 2.0 * w.V[i, r] * couple[i]
            g[Q + r, 1] += 2.0 * w.V[i, r] * couple_magnetic[i]
    if tangent:
        for i in range(3):
            couple_mixed[i] += couple_magnetic[i]
        for r in range(4):
            for i in range(3):
                g_mixed[Q + r] += 2.0 * w.V[i, r] * couple_mixed[i]
        _spin_to_quaternion(w, q, n2, couple_mixed, H)
    couple_stress(w, couple_modulus, geometry.metric[e, p], x, n2, kappa_mixed, mixed, tangent, g[:, 0], g_mixed, H)
    return least


@inline
def _add_stress_vector(
    g: FloatArray, i: int, z: float, phi: float, t1: float, t2: float, t3: float, d2z: float
) -> None:
    """Chain component i of the stress vectors to the gradient with respect to (u,α  w,α  w  ā  φ)."""
    g[U1 + i] += t1
    g[U1 + 3 + i] += t2
    g[W1 + i] += z * t1
    g[W1 + 3 + i] += z * t2
    g[W + i] += (1.0 + 2.0 * z * phi) * t3
    g[ENHANCED + i] += t3
    g[PHI] += d2z * t3


@inline
def predicted_stress(
    material: Material,
    geometry: SectionGeometry,
    e: int,
    p: int,
    x: FloatArray,
    dx: FloatArray,
    scratch: AnyArray,
    S_mixed: FloatArray,
    kappa_mixed: FloatArray,
) -> None:
    """Fill S' = U⁻¹ (P + C : ΔU - ΔU S) (levels, 3, 3), κ' = κ + Δκ (2, 3), linear in the increment dx (31,) from x."""
    w = scratch[0]
    q, dq = x[Q : Q + 4], dx[Q : Q + 4]
    n2 = rotation_matrix(q, w.R)
    spin_map(q, n2, w.V)
    ω = w.vectors[0]
    for i in range(3):
        ω[i] = 2.0 * (w.V[i, 0] * dq[0] + w.V[i, 1] * dq[1] + w.V[i, 2] * dq[2] + w.V[i, 3] * dq[3])
    dU, dP = w.K_m, w.K_ω
    for k in range(geometry.z.size):
        z, G = geometry.z[k], geometry.G[e, p, k]
        base_vectors(geometry, e, p, z, x, w.g)
        stretch(w.R, w.g, G, w.U)
        _stress_and_tangent(material, w.U, w.P, w.C)
        for i in range(3):
            d = geometry.D[e, p, i] + x[W + i]
            w.t[0, i] = dx[U1 + i] + z * dx[W1 + i]
            w.t[1, i] = dx[U1 + 3 + i] + z * dx[W1 + 3 + i]
            w.t[2, i] = (1.0 + 2.0 * z * x[PHI]) * dx[W + i] + 2.0 * z * dx[PHI] * d + dx[ENHANCED + i]
        for a in range(3):
            w.t[a, 0] -= ω[1] * w.g[a, 2] - ω[2] * w.g[a, 1]
            w.t[a, 1] -= ω[2] * w.g[a, 0] - ω[0] * w.g[a, 2]
            w.t[a, 2] -= ω[0] * w.g[a, 1] - ω[1] * w.g[a, 0]
        stretch(w.R, w.t, G, dU)
        _second_stress(w, w.S)
        for i in range(3):
            for j in range(3):
                value = -dU[i, 0] * w.S[0, j] - dU[i, 1] * w.S[1, j] - dU[i, 2] * w.S[2, j]
                for l in range(3):
                    for r in range(3):
                        value += w.C[i, j, l, r] * dU[l, r]
                dP[i, j] = value
        for i in range(3):
            for j in range(3):
                w.P[i, j] += dP[i, j]
        _second_stress(w, S_mixed[k])
    for a in range(2):
        at = Q1 + 4 * a
        wryness_maps(q, x[at : at + 4], n2, w.L, w.M[a], w.kappa[a])
        for i in range(3):
            value = w.kappa[a, i]
            for r in range(4):
                value += w.L[i, r] * dx[at + r] + w.M[a, i, r] * dq[r]
            kappa_mixed[a, i] = value
