r"""The director's stretch s, where sections of different make meet.

Thickness, layers or material differ on the two sides of a border, and so do φ and the length of the director. The
regions there share u, the director d = D + w and the micro-rotation; every region but the first has its own φ and its
own stretch s, and sees

    d' = (1 + s) d,    w' = (1 + s)(D + w) - D,    δw' = (1 + s) δw + d δs,    δ²w' = 2 δs δw.

Elements are made with w'. Then r_w = (1 + s) r', r_s = d · r', and the tangent likewise in rows and columns, with r' in
its places (s, w) and (w, s).
"""

from __future__ import annotations

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.compiled import inline
from magshell.shell.element import Layout
from magshell.shell.state import State


@inline
def any_stretched(stretched: AnyArray, layout: Layout) -> bool:
    """Whether an element has stretched directors; `stretched` (8,)."""
    count = 0
    for n in range(layout.s):
        count += stretched[n]
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
def chain_row(
    nodes: IntArray, stretched: AnyArray, normals: FloatArray, state: State, layout: Layout, row: FloatArray
) -> None:
    """From factors or forces of w' in a row to those of w and of s, which stand after ϑ."""
    for n in range(layout.s):
        if stretched[n]:
            along, w = 0.0, state.w[nodes[n]]
            for i in range(3):
                at = layout.at_w + i * layout.w + n
                along += (normals[n, i] + w[i]) * row[at]
                row[at] *= 1.0 + state.s[nodes[n]]
            row[layout.nodal + n] = along


@inline
def chain_matrix(
    nodes: IntArray,
    stretched: AnyArray,
    normals: FloatArray,
    state: State,
    layout: Layout,
    r: FloatArray,
    K: FloatArray,
) -> None:
    """From a matrix of w' to one of w and s, which stand after ϑ; r are the forces on w'. (Its transpose likewise.)"""
    nodal = layout.nodal
    for n in range(layout.s):
        if stretched[n]:
            along, s, w = K[nodal + n], state.s[nodes[n]], state.w[nodes[n]]
            for j in range(nodal):
                along[j] = 0.0
            for i in range(3):
                row, d = K[layout.at_w + i * layout.w + n], normals[n, i] + w[i]
                for j in range(nodal):
                    along[j] += d * row[j]
                    row[j] *= 1.0 + s
    for j in range(nodal):
        chain_row(nodes, stretched, normals, state, layout, K[j])
    for n in range(layout.s):
        if stretched[n]:
            chain_row(nodes, stretched, normals, state, layout, K[nodal + n])
            for i in range(3):
                at = layout.at_w + i * layout.w + n
                K[nodal + n, at] += r[at]
                K[at, nodal + n] += r[at]
