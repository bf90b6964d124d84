r"""Ties: directors and displacements of an element's nodes that depend on other unknowns.

Elements are made with the displacement u' and the director displacement w' at their nodes. Where sections differ, at
joints and on rigid bodies (`model/rows.py`) these depend on the node's unknowns, with the micro-rotation R:

    stretched   w' = (1 + s)(D + w) - D,     δw' = (1 + s) δw + d δs,             d = D + w,
    turned      w' = (1 + s) R D - D,        δw' = (1 + s) δω × d + d δs,         d = R D,
    rigid       w' = R D - D,  u' = u_r + (R - I) ρ_0,      δu' = δu_r + δω × ρ,  ρ = R ρ_0.

The state holds d = D + w and u' as they are, and s apart. Forces f on w' and g on u' become

    r_w = (1 + s) f,    r_s = d · f,    r_ω = (1 + s) d × f + ρ × g,

the matrix likewise in rows and columns, and it gains the second derivatives. In the chart R -> exp(ϑ) R these are

    ∂²(f · d)/∂ϑ∂ϑ = ½ (f ⊗ d + d ⊗ f) - (f · d) I,        ∂²(f · w')/∂s∂ϑ = d × f,        ∂²(f · w')/∂s∂w = f.

Where only corners carry the micro-rotation, that of a mid-side node of a rigid body is in the place of a corner, its
host, which belongs to the same body.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import inline
from magshell.shell.element import Layout
from magshell.shell.point import MIXED
from magshell.shell.rotation import LAST, NEXT
from magshell.shell.state import State

FREE, STRETCHED, TURNED, RIGID = range(4)
"""What the director of a row is."""


class Ties(NamedTuple):
    """What ties the rows of the nodal arrays.

    Attributes
    ----------
    kind : ndarray, shape (elements, 8)
        At the nodes of each element, `FREE` and so on.
    host : ndarray, shape (elements, 8)
        Node of the element in whose place the micro-rotation of a node of a rigid body is.
    body : ndarray, shape (rows,)
        Row of the rigid body that moves a row, or -1.
    arm : ndarray, shape (rows, 3)
        Undeformed position from the reference point of the body, m; zero for other rows.
    """

    kind: IntArray
    host: IntArray
    body: IntArray
    arm: FloatArray


class TiedBody(Protocol):
    """What is asked of the undeformed shell (`Body` of `loops.py`)."""

    @property
    def elements(self) -> IntArray: ...
    @property
    def normals(self) -> FloatArray: ...
    @property
    def ties(self) -> Ties: ...


@inline
def any_tied(kind: IntArray) -> bool:
    """Whether an element has ties; `kind` (8,)."""
    count = 0
    for n in range(8):
        count += kind[n]
    return count > 0


@inline
def stretch_directors(nodes: IntArray, normals: FloatArray, state: State, layout: Layout, v: FloatArray) -> None:
    """Put w' in place of w in an element's values v; normals (8, 3)."""
    for n in range(layout.s):
        s = state.s[nodes[n]]
        for i in range(3):
            v[layout.at_w + i * layout.w + n] += s * (normals[n, i] + state.w[nodes[n], i])


@inline
def stretch_increments(
    nodes: IntArray, normals: FloatArray, state: State, increment: FloatArray, layout: Layout, dv: FloatArray
) -> None:
    """Put Δw' in place of Δw in an element's increments dv."""
    for n in range(layout.s):
        node = nodes[n]
        for i in range(3):
            at = layout.at_w + i * layout.w + n
            dv[at] += state.s[node] * dv[at] + increment[node, 10] * (normals[n, i] + state.w[node, i])


@inline
def _lever(ties: Ties, state: State, node: int, i: int) -> float:
    """Component i of ρ."""
    body = ties.body[node]
    return ties.arm[node, i] + state.u[node, i] - state.u[body, i]


@inline
def chain_row(body: TiedBody, e: int, state: State, layout: Layout, row: FloatArray) -> None:
    """From factors or forces of u' and w' in a row to those of u, w, ω and s, which stands after ϑ."""
    for n in range(layout.u):
        kind, node = body.ties.kind[e, n], body.elements[e, n]
        if kind == FREE:
            continue
        if n < layout.w:
            scale = 1.0 + state.s[node]
            if n < layout.s:
                along = 0.0
                for i in range(3):
                    along += (body.normals[e, n, i] + state.w[node, i]) * row[layout.at_w + i * layout.w + n]
                row[layout.nodal + n] = along
            if kind >= TURNED:
                for i in range(3):
                    j, k = NEXT[i], LAST[i]
                    d_j, d_k = body.normals[e, n, j] + state.w[node, j], body.normals[e, n, k] + state.w[node, k]
                    f_j, f_k = row[layout.at_w + j * layout.w + n], row[layout.at_w + k * layout.w + n]
                    row[layout.at_q + i * layout.q + n] += scale * (d_j * f_k - d_k * f_j)
                scale = 0.0
            for i in range(3):
                row[layout.at_w + i * layout.w + n] *= scale
        if kind == RIGID:
            for i in range(3):
                j, k = NEXT[i], LAST[i]
                g_j, g_k = row[j * layout.u + n], row[k * layout.u + n]
                torque = _lever(body.ties, state, node, j) * g_k - _lever(body.ties, state, node, k) * g_j
                row[layout.at_q + i * layout.q + body.ties.host[e, n]] += torque


@inline
def _chain_rows(body: TiedBody, e: int, state: State, layout: Layout, K: FloatArray) -> None:
    """The same for all rows of a matrix at once, row by row in place of component by component."""
    nodal = layout.nodal
    for n in range(layout.u):
        kind, node = body.ties.kind[e, n], body.elements[e, n]
        if kind == FREE:
            continue
        if n < layout.w:
            scale = 1.0 + state.s[node]
            if n < layout.s:
                along = K[nodal + n]
                for l in range(nodal):
                    along[l] = 0.0
                for i in range(3):
                    row, d = K[layout.at_w + i * layout.w + n], body.normals[e, n, i] + state.w[node, i]
                    for l in range(nodal):
                        along[l] += d * row[l]
            if kind >= TURNED:
                for i in range(3):
                    j, k = NEXT[i], LAST[i]
                    d_j = scale * (body.normals[e, n, j] + state.w[node, j])
                    d_k = scale * (body.normals[e, n, k] + state.w[node, k])
                    row_j, row_k = K[layout.at_w + j * layout.w + n], K[layout.at_w + k * layout.w + n]
                    turning = K[layout.at_q + i * layout.q + n]
                    for l in range(nodal):
                        turning[l] += d_j * row_k[l] - d_k * row_j[l]
                scale = 0.0
            for i in range(3):
                row = K[layout.at_w + i * layout.w + n]
                for l in range(nodal):
                    row[l] *= scale
        if kind == RIGID:
            for i in range(3):
                j, k = NEXT[i], LAST[i]
                ρ_j, ρ_k = _lever(body.ties, state, node, j), _lever(body.ties, state, node, k)
                row_j, row_k = K[j * layout.u + n], K[k * layout.u + n]
                turning = K[layout.at_q + i * layout.q + body.ties.host[e, n]]
                for l in range(nodal):
                    turning[l] += ρ_j * row_k[l] - ρ_k * row_j[l]


@inline
def _add_turning(K: FloatArray, layout: Layout, n: int, i: int, j: int, value: float) -> None:
    """Add to the block of the spins of node n."""
    K[layout.at_q + i * layout.q + n, layout.at_q + j * layout.q + n] += value


@inline
def _add_curvature(body: TiedBody, e: int, state: State, layout: Layout, forces: FloatArray, K: FloatArray) -> None:
    """The second derivatives, with the forces on u' and w' that the geometric part is made with."""
    r = forces[:, MIXED]
    for n in range(layout.u):
        kind, node = body.ties.kind[e, n], body.elements[e, n]
        if n < layout.w and kind == STRETCHED:
            for i in range(3):
                at = layout.at_w + i * layout.w + n
                K[layout.nodal + n, at] += r[at]
                K[at, layout.nodal + n] += r[at]
        if n < layout.w and kind >= TURNED:
            scale, along = 1.0 + state.s[node], 0.0
            for i in range(3):
                along += r[layout.at_w + i * layout.w + n] * (body.normals[e, n, i] + state.w[node, i])
            for i in range(3):
                f_i, d_i = r[layout.at_w + i * layout.w + n], body.normals[e, n, i] + state.w[node, i]
                _add_turning(K, layout, n, i, i, -scale * along)
                for j in range(3):
                    f_j, d_j = r[layout.at_w + j * layout.w + n], body.normals[e, n, j] + state.w[node, j]
                    _add_turning(K, layout, n, i, j, 0.5 * scale * (f_i * d_j + d_i * f_j))
                if n < layout.s:
                    j, k = NEXT[i], LAST[i]
                    d_j, d_k = body.normals[e, n, j] + state.w[node, j], body.normals[e, n, k] + state.w[node, k]
                    f_j, f_k = r[layout.at_w + j * layout.w + n], r[layout.at_w + k * layout.w + n]
                    at = layout.at_q + i * layout.q + n
                    K[layout.nodal + n, at] += d_j * f_k - d_k * f_j
                    K[at, layout.nodal + n] += d_j * f_k - d_k * f_j
        if kind == RIGID:
            along, host = 0.0, body.ties.host[e, n]
            for i in range(3):
                along += r[i * layout.u + n] * _lever(body.ties, state, node, i)
            for i in range(3):
                g_i, ρ_i = r[i * layout.u + n], _lever(body.ties, state, node, i)
                _add_turning(K, layout, host, i, i, -along)
                for j in range(3):
                    g_j, ρ_j = r[j * layout.u + n], _lever(body.ties, state, node, j)
                    _add_turning(K, layout, host, i, j, 0.5 * (g_i * ρ_j + ρ_i * g_j))


@inline
def chain_matrix(body: TiedBody, e: int, state: State, layout: Layout, forces: FloatArray, K: FloatArray) -> None:
    """From a matrix of u' and w' to one of u, w, ω and s. (Its transpose likewise.)

    Its geometric part is made with the mixed column of the `forces` (values, 3) on u' and w'.
    """
    _chain_rows(body, e, state, layout, K)
    for l in range(layout.nodal):
        chain_row(body, e, state, layout, K[l])
    for n in range(layout.s):
        if body.ties.kind[e, n] == STRETCHED or body.ties.kind[e, n] == TURNED:
            chain_row(body, e, state, layout, K[layout.nodal + n])
    _add_curvature(body, e, state, layout, forces, K)
