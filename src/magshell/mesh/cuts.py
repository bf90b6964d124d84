"""Cuts along edges: the nodes there doubled, so that the two lips come apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.checks import check_cuts
from magshell.mesh.edges import SIDES, Edges, edge_keys, find_edges, is_triangle
from magshell.mesh.mesh import Mesh
from magshell.mesh.wording import place

AnyMesh = TypeVar("AnyMesh", bound=Mesh)
Groups = Mapping[str, IntArray]


class Opened(NamedTuple):
    """The arrays of a mesh after its cuts were opened."""

    points: FloatArray
    """(nodes, 3): those that were there, then the new ones."""
    elements: IntArray
    edge_groups: dict[str, IntArray]
    node_groups: dict[str, IntArray]


def cut(mesh: AnyMesh, groups: Sequence[str] | str) -> AnyMesh:
    """The same mesh cut open along edge groups.

    Parameters
    ----------
    mesh : Mesh
    groups : str or sequence of str
        Edge groups. Their nodes are doubled, except where a cut ends inside the surface.

    Returns
    -------
    Mesh
        Its `cuts` name the groups. Groups that have edges or nodes on a cut have those of both lips.

    Raises
    ------
    InputError
        No such edge group; one on a free edge, where there is nothing to cut; a cut inside the surface that is one edge
        long.
    """
    names = check_cuts(groups, mesh.edge_groups)
    made = opened(mesh.points, mesh.elements, mesh.edge_groups, mesh.node_groups, names)
    return replace(mesh, **made._asdict(), cuts=tuple(dict.fromkeys((*mesh.cuts, *names))))


def opened(
    points: FloatArray, elements: IntArray, edge_groups: Groups, node_groups: Groups, cuts: Sequence[str]
) -> Opened:
    """Nodes doubled along edges that elements share.

    About each node of a cut, elements that share an edge which is not cut keep a common node; those of every further
    such fan get a node of their own. Edges of a cut that are free already stay as they are.
    """
    edges, count = find_edges(elements), len(points)
    is_cut = np.zeros(len(edges.first_side), dtype=bool)
    for name in cuts:
        is_cut[_numbers(edges, edge_groups[name], count)] = True
    is_cut &= edges.sharing > 1
    nodes = np.zeros(count, dtype=bool)
    nodes[edges.sides[edges.first_side[is_cut]]] = True
    rows, of = _doubled(elements, edges, is_cut, nodes)
    _check_length(points, rows, edges, is_cut, edge_groups, cuts)
    return Opened(
        points[of],
        rows,
        {name: _both_lips(edges, rows, group, count) for name, group in edge_groups.items()},
        {name: np.flatnonzero(np.isin(of, group)) for name, group in node_groups.items()},
    )


def _doubled(elements: IntArray, edges: Edges, is_cut: AnyArray, nodes: AnyArray) -> tuple[IntArray, IntArray]:
    """Rows with the new nodes, and the old node (nodes,) of every node."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    slots = (8 * np.arange(len(elements))[:, None, None] + SIDES).reshape(-1, 3)
    one, other = edges.pairs
    whole = ~is_cut[edges.edge_of_side[one]]
    one, other = one[whole], other[whole]
    alike = (edges.sides[one, 0] == edges.sides[other, 0])[:, None]
    matching = np.where(alike, slots[other], slots[other][:, [1, 0, 2]])
    triangles = 8 * np.flatnonzero(is_triangle(elements))
    begin = np.concatenate([slots[one].ravel(), triangles + 2, triangles + 2])
    end = np.concatenate([matching.ravel(), triangles + 3, triangles + 6])
    graph = coo_matrix((np.ones(len(begin)), (begin, end)), shape=(elements.size,) * 2)
    _, fan = connected_components(graph, directed=False)
    at = np.flatnonzero(nodes[elements.ravel()])
    node = elements.ravel()[at]
    _, first, which = np.unique(fan[at], return_index=True, return_inverse=True)
    order = np.lexsort((first, node[first]))
    stays = np.concatenate([[True], np.diff(node[first][order]) != 0]) if len(order) else np.zeros(0, dtype=bool)
    number = np.empty(len(order), dtype=np.int64)
    number[order[stays]] = node[first][order[stays]]
    number[order[~stays]] = len(nodes) + np.arange((~stays).sum())
    rows = elements.copy().ravel()
    rows[at] = number[which.ravel()]
    return rows.reshape(elements.shape), np.concatenate([np.arange(len(nodes)), node[first][order[~stays]]])


def _check_length(
    points: FloatArray, rows: IntArray, edges: Edges, is_cut: AnyArray, groups: Groups, cuts: Sequence[str]
) -> None:
    """Refuse a cut of a single edge: its lips would have the same two ends."""
    sides = rows[:, SIDES].reshape(-1, 3)
    one, other = edges.pairs
    ends, beyond = np.sort(sides[one, :2], axis=1), np.sort(sides[other, :2], axis=1)
    closed = np.flatnonzero(is_cut[edges.edge_of_side[one]] & (ends == beyond).all(axis=1))
    if closed.size:
        edge = edges.edge_of_side[one[closed[0]]]
        name = next(name for name in cuts if edge in _numbers(edges, groups[name], int(edges.sides.max()) + 1))
        start, end = points[edges.sides[edges.first_side[edge], :2]]
        raise InputError(
            f"cuts: '{name}' has a cut inside the surface that is one edge long, from {place(start)} to {place(end)}; "
            "its two sides cannot come apart: divide it into two edges or more"
        )


def _numbers(edges: Edges, rows: IntArray, node_count: int) -> IntArray:
    """Numbers of the edges that a group has."""
    keys = edge_keys(edges.sides[edges.first_side], node_count)
    result: IntArray = np.searchsorted(keys, edge_keys(rows, node_count))
    return result


def _both_lips(edges: Edges, rows: IntArray, group: IntArray, node_count: int) -> IntArray:
    """The edges (k, 3) of a group after the cut, in its order and sense, those of a cut twice."""
    order = np.argsort(edges.edge_of_side, kind="stable")
    sorted_edges = edges.edge_of_side[order]
    number = _numbers(edges, group, node_count)
    begin, end = np.searchsorted(sorted_edges, number), np.searchsorted(sorted_edges, number, side="right")
    member = np.repeat(np.arange(len(group)), end - begin)
    within = np.arange(len(member)) - np.repeat(np.cumsum(end - begin) - (end - begin), end - begin)
    side = order[begin[member] + within]
    found = rows[:, SIDES].reshape(-1, 3)[side]
    against = edges.sides[side, 0] != group[member, 0]
    found[against] = found[against][:, [1, 0, 2]]
    _, first = np.unique(edge_keys(found, int(rows.max()) + 1), return_index=True)
    result: IntArray = found[np.sort(first)]
    return result
