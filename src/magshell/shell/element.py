r"""The element: points contracted with shape functions, quaternions reduced to spins, enhanced modes condensed.

Everything nonlinear happens at the points (section.py), where x = G v with a constant map G (shape functions).
Nodes carry quaternions, equations carry spins: q(ϑ) = exp(ϑ/2) q has the constant
first derivative T = ∂q/∂ϑ and the second derivative -¼ δ_ab q. With T̂ the identity but for a block T per node,

    r = Σ T̂ᵀGᵀ g,      K = Σ T̂ᵀGᵀ H G T̂ - ¼ (q · r_q) I on each node's spins.

One function, `contract`, multiplies rows by T̂ᵀGᵀ: once for r, twice with a transposition between for Kᵀ. (Kᵀ is what
the compressed columns of the matrix take.)

The enhanced parameters α are condensed: with r_α and K_αα of the element,

    K = K_vv - K_vα K_αα⁻¹ K_αv,   r = r_v - K_vα K_αα⁻¹ r_α,   Δα = -K_αα⁻¹ (r_α + K_αv Δv).

Order of the element's values, component by component and node by node within: u, w, φ, q (4 components) or ϑ (3), α.
Each field lives on the first so many nodes of the element (`Layout`).
"""

from __future__ import annotations

from typing import NamedTuple

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import inline
from magshell.shell.point import ENHANCED, MIXED, PHI, Q1, U1, W1, Q, Record, W
from magshell.shell.state import State


class Layout(NamedTuple):
    """Places of an element's values.

    Attributes
    ----------
    u, w, phi, q : int
        How many of the element's nodes carry each field.
    modes : int
        Enhanced modes.
    s : int
        How many nodes may carry a stretch of the director (`ties.py`); 0 where no sections differ.
    at_w, at_phi, at_q, nodal : int
        First place of w, of φ, of q or ϑ, and with ϑ of α, and of s after the elimination of α.
    """

    u: int
    w: int
    phi: int
    q: int
    modes: int
    s: int
    at_w: int
    at_phi: int
    at_q: int
    nodal: int


def layout_of(u: int, w: int, phi: int, q: int, modes: int, s: int = 0) -> Layout:
    """Places of so many nodes' values."""
    at_phi = 3 * u + 3 * w
    at_q = at_phi + phi
    return Layout(u, w, phi, q, modes, s, 3 * u, at_phi, at_q, at_q + 3 * q)


@inline
def gather(
    nodes: IntArray,
    state: State,
    alpha: FloatArray,
    layout: Layout,
    v: FloatArray,
) -> None:
    """Fill v with the element's values.

    Quaternions go in as they are: spins carry them on from one and the same identity, so that the sign of one against
    another counts the turns between them, and the interpolation stays continuous where these pass 180°.
    """
    u, w, phi, q = state.u, state.w, state.phi, state.q
    for i in range(3):
        at_u, at_w = i * layout.u, layout.at_w + i * layout.w
        for n in range(layout.u):
            v[at_u + n] = u[nodes[n], i]
        for n in range(layout.w):
            v[at_w + n] = w[nodes[n], i]
    at = layout.at_phi
    for n in range(layout.phi):
        v[at + n] = phi[nodes[n]]
    at = layout.at_q
    for n in range(layout.q):
        node = nodes[n]
        for c in range(4):
            v[at + c * layout.q + n] = q[node, c]
    at += 4 * layout.q
    for m in range(layout.modes):
        for i in range(3):
            v[at + i * layout.modes + m] = alpha[m, i]


@inline
def point_values(point: Record, enhancement: FloatArray, layout: Layout, v: FloatArray, x: FloatArray) -> None:
    """x = G v at a point; without micro-rotation q̂ is the identity."""
    for i in range(3):
        at_u, at_w = i * layout.u, layout.at_w + i * layout.w
        at_α = layout.at_q + 4 * layout.q + i * layout.modes
        s1, s2 = 0.0, 0.0
        for n in range(layout.u):
            s1 += point.u[0, n] * v[at_u + n]
            s2 += point.u[1, n] * v[at_u + n]
        e1, e2, e3 = 0.0, 0.0, 0.0
        for m in range(layout.modes):
            e1 += enhancement[0, m] * v[at_α + m]
            e2 += enhancement[1, m] * v[at_α + m]
            e3 += enhancement[2, m] * v[at_α + m]
        x[U1 + i], x[U1 + 3 + i], x[ENHANCED + i] = s1 + e1, s2 + e2, e3
        s0, s1, s2 = 0.0, 0.0, 0.0
        for n in range(layout.w):
            s0 += point.director[0, n] * v[at_w + n]
            s1 += point.director[1, n] * v[at_w + n]
            s2 += point.director[2, n] * v[at_w + n]
        x[W + i], x[W1 + i], x[W1 + 3 + i] = s0, s1, s2
    at = layout.at_phi
    s0 = 0.0
    for n in range(layout.phi):
        s0 += point.phi[n] * v[at + n]
    x[PHI] = s0
    for c in range(4):
        at = layout.at_q + c * layout.q
        s0, s1, s2 = 0.0, 0.0, 0.0
        for n in range(layout.q):
            s0 += point.rotation[0, n] * v[at + n]
            s1 += point.rotation[1, n] * v[at + n]
            s2 += point.rotation[2, n] * v[at + n]
        x[Q + c], x[Q1 + c], x[Q1 + 4 + c] = s0, s1, s2
    if layout.q == 0:
        x[Q] = 1.0


@inline
def spin_derivatives(v: FloatArray, layout: Layout, T: FloatArray) -> None:
    """Fill T (nodes, 4, 3): ∂(exp(ϑ/2) q)/∂ϑ at ϑ = 0 of each node's quaternion in v."""
    at, rest = layout.at_q, layout.q
    for n in range(rest):
        q0, q1, q2, q3 = v[at + n], v[at + rest + n], v[at + 2 * rest + n], v[at + 3 * rest + n]
        T[n, 0, 0], T[n, 0, 1], T[n, 0, 2] = -0.5 * q1, -0.5 * q2, -0.5 * q3
        T[n, 1, 0], T[n, 1, 1], T[n, 1, 2] = 0.5 * q0, 0.5 * q3, -0.5 * q2
        T[n, 2, 0], T[n, 2, 1], T[n, 2, 2] = -0.5 * q3, 0.5 * q0, 0.5 * q1
        T[n, 3, 0], T[n, 3, 1], T[n, 3, 2] = 0.5 * q2, -0.5 * q1, 0.5 * q0


@inline
def contract(
    point: Record,
    enhancement: FloatArray,
    layout: Layout,
    T: FloatArray,
    H: FloatArray,
    scratch: FloatArray,
    out: FloatArray,
) -> None:
    """out += T̂ᵀGᵀ H: the point's rows (31) become the element's, for as many columns as `out` has."""
    width = out.shape[1]
    for i in range(3):
        h1, h2, h3 = H[U1 + i], H[U1 + 3 + i], H[ENHANCED + i]
        at = i * layout.u
        for n in range(layout.u):
            row, a1, a2 = out[at + n], point.u[0, n], point.u[1, n]
            for j in range(width):
                row[j] += a1 * h1[j] + a2 * h2[j]
        at = layout.nodal + i * layout.modes
        for m in range(layout.modes):
            row = out[at + m]
            a1, a2, a = enhancement[0, m], enhancement[1, m], enhancement[2, m]
            for j in range(width):
                row[j] += a1 * h1[j] + a2 * h2[j] + a * h3[j]
        h, h1, h2 = H[W + i], H[W1 + i], H[W1 + 3 + i]
        at = layout.at_w + i * layout.w
        for n in range(layout.w):
            row = out[at + n]
            a, a1, a2 = point.director[0, n], point.director[1, n], point.director[2, n]
            for j in range(width):
                row[j] += a * h[j] + a1 * h1[j] + a2 * h2[j]
    h, at = H[PHI], layout.at_phi
    for n in range(layout.phi):
        row, a = out[at + n], point.phi[n]
        for j in range(width):
            row[j] += a * h[j]
    at = layout.at_q
    for n in range(layout.q):
        a, a1, a2 = point.rotation[0, n], point.rotation[1, n], point.rotation[2, n]
        for c in range(4):
            row, h, h1, h2 = scratch[c], H[Q + c], H[Q1 + c], H[Q1 + 4 + c]
            for j in range(width):
                row[j] = a * h[j] + a1 * h1[j] + a2 * h2[j]
        s0, s1, s2, s3 = scratch[0], scratch[1], scratch[2], scratch[3]
        for i in range(3):
            row, t0, t1, t2, t3 = out[at + i * layout.q + n], T[n, 0, i], T[n, 1, i], T[n, 2, i], T[n, 3, i]
            for j in range(width):
                row[j] += t0 * s0[j] + t1 * s1[j] + t2 * s2[j] + t3 * s3[j]


@inline
def add_radial_force(point: Record, layout: Layout, g: FloatArray, v: FloatArray, radial: FloatArray) -> None:
    """radial (nodes,) += q · r_q of each node, from the gradient that the geometric part is made with."""
    for c in range(4):
        at = layout.at_q + c * layout.q
        for n in range(layout.q):
            r = point.rotation[0, n] * g[Q + c, MIXED]
            r += point.rotation[1, n] * g[Q1 + c, MIXED] + point.rotation[2, n] * g[Q1 + 4 + c, MIXED]
            radial[n] += v[at + n] * r


@inline
def padded(width: int) -> int:
    """Row length, in whole vector registers of four numbers, for `width` columns."""
    return (width + 3) // 4 * 4


@inline
def copy(A: FloatArray, out: FloatArray) -> None:
    """Fill out with A."""
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            out[i, j] = A[i, j]


@inline
def transpose(A: FloatArray, out: FloatArray) -> None:
    """Fill out with the first rows of Aᵀ."""
    for i in range(A.shape[0]):
        for j in range(out.shape[0]):
            out[j, i] = A[i, j]


@inline
def condense(
    Kt: FloatArray, r: FloatArray, size: int, gain: FloatArray, offset: FloatArray, factor: FloatArray
) -> bool:
    """Eliminate the α, which stand from `size` on: Kᵀ and r condensed in place, Δα = -offset - gain Δv.

    Gauss–Jordan with pivoting on [K_αα | K_αv | r_α], in `factor`; False where K_αα is singular. The unknowns come in
    vectors of three. What is not a number stays so.
    """
    modes = len(factor)
    width = modes + size + 1
    for a in range(modes):
        for b in range(modes):
            factor[a, b] = Kt[size + b, size + a]
        for j in range(size):
            factor[a, modes + j] = Kt[j, size + a]
        factor[a, modes + size] = r[size + a]
    for a in range(modes):
        pivot = a
        for b in range(a + 1, modes):
            if abs(factor[b, a]) > abs(factor[pivot, a]):
                pivot = b
        if abs(factor[pivot, a]) == 0.0:
            return False
        if pivot != a:
            for j in range(width):
                factor[a, j], factor[pivot, j] = factor[pivot, j], factor[a, j]
        top, scale = factor[a], 1.0 / factor[a, a]
        for j in range(width):
            top[j] *= scale
        for b in range(modes):
            if b != a:
                row, f = factor[b], factor[b, a]
                for j in range(width):
                    row[j] -= f * top[j]
    for a in range(modes):
        row = Kt[size + a]
        offset[a] = factor[a, modes + size]
        for j in range(size):
            gain[a, j] = factor[a, modes + j]
            r[j] -= row[j] * offset[a]
    for j in range(size):
        row = Kt[j]
        for a in range(0, modes, 3):
            e0, e1, e2 = Kt[size + a], Kt[size + a + 1], Kt[size + a + 2]
            f0, f1, f2 = gain[a, j], gain[a + 1, j], gain[a + 2, j]
            for i in range(size):
                row[i] -= f0 * e0[i] + f1 * e1[i] + f2 * e2[i]
    return True
