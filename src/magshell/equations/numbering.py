"""Numbers of the equations, and the sparsity of the tangent: blocks of nodes that a term couples."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, IntArray
from magshell.model.images import Beyond
from magshell.model.rows import Rows, U
from magshell.shell.unknowns import COLUMNS

Ordering = Callable[[sp.csr_array], IntArray]


class Numbering:
    """Equations of the free unknowns, in the order of elimination.

    Parameters
    ----------
    rows : Rows
        Of the nodal arrays.
    free : ndarray of bool, shape (rows, 11)
        Unknowns that a row has for itself and no support holds.
    cliques : sequence of ndarray, shape (n, m)
        Rows that are coupled with each other, row by row.
    ordering : callable
        From the graph of the mesh nodes (nodes, nodes) to their order of elimination; rigid bodies and jumps come last.

    Attributes
    ----------
    dofs : int
        Number of equations.
    equations : ndarray, shape (dofs,)
        Equation of each free unknown.
    placed : int
        Number of the unknowns that the tangent is inserted for: those of the equations, and u beyond a jump.
    number : ndarray, shape (rows, 11)
        Of these, -1 where fixed or absent. Rows that share an unknown share its number.
    following : csr_array, shape (placed, dofs), or None
        The former as a combination of the free unknowns; None: they are the same.
    rank : ndarray, shape (rows, 11)
        Equation minus the first one of its place.
    place : ndarray, shape (rows, 11)
        Mesh node or rigid body at which each unknown is.
    partly_held : ndarray of bool, shape (rows,)
        Where one or two of the three rotations are held.
    indptr, indices : ndarray
        Of the tangent, compressed columns.
    """

    def __init__(self, rows: Rows, free: AnyArray, cliques: Sequence[IntArray], ordering: Ordering) -> None:
        graph, count = place_graph(rows, cliques), rows.places
        order = elimination_order(rows, cliques, ordering)
        free, own = free.copy(), free
        free[_first_beyond(rows).rows, U] = True
        counts = np.bincount(rows.of, free.sum(axis=1), minlength=count).astype(np.int64)
        first = np.empty(count, dtype=np.int64)
        first[order] = np.cumsum(counts[order]) - counts[order]
        by_place = np.argsort(rows.of, kind="stable")
        rank = np.empty(free.shape, dtype=np.int64)
        rank[by_place] = np.cumsum(free[by_place]).reshape(free.shape) - 1
        rank -= (np.cumsum(counts) - counts)[rows.of][:, None]
        self.place, self.rank = rows.place, rows.shared(rank)
        self.number = rows.shared(np.where(free, first[rows.of][:, None] + rank, -1))
        self.partly_held: AnyArray = np.isin(np.sum(self.number[:, COLUMNS["omega"]] < 0, axis=1), (1, 2))
        self.placed = int(counts.sum())
        self.equations, self.following = self.number[own], None
        if rows.images.beyond.rows.size:
            self.following = _following(rows, self.number, own)
            self.equations = np.searchsorted(np.sort(self.equations), self.equations)
        self.dofs = len(self.equations)
        self._set_pattern(graph, order, counts)

    def _set_pattern(self, graph: sp.csr_array, order: IntArray, counts: IntArray) -> None:
        ordered = sp.csr_array(graph[order][:, order])
        ordered.sort_indices()
        block = counts[order]
        lengths = block[ordered.indices]
        ends = np.cumsum(lengths)
        starts = ends - lengths
        column_start = np.append(starts, ends[-1] if len(ends) else 0)[ordered.indptr]
        within = starts - np.repeat(column_start[:-1], np.diff(ordered.indptr))
        columns = order[np.repeat(np.arange(len(order)), np.diff(ordered.indptr))]
        shape = graph.shape
        # One more than the offset of a row's node in a column of a node: zero means that they are not coupled.
        self._offsets = sp.csr_array(sp.coo_array((within + 1, (columns, order[ordered.indices])), shape=shape))
        first_equation = np.cumsum(block) - block
        rows = np.repeat(first_equation[ordered.indices] - starts, lengths) + np.arange(ends[-1])
        node_of_column = np.repeat(np.arange(len(order)), block)
        column_length = np.diff(column_start)[node_of_column]
        self.indptr = np.append(0, np.cumsum(column_length))
        index = np.arange(self.indptr[-1]) + np.repeat(column_start[node_of_column] - self.indptr[:-1], column_length)
        self.indices = rows[index].astype(np.int32)

    def offsets(self, columns: IntArray, rows: IntArray) -> IntArray:
        """Index of the first equation of places `rows` in the columns of places `columns`, from the columns' start."""
        found = self._offsets[columns.ravel(), rows.ravel()]
        return np.asarray(found, dtype=np.int64).reshape(columns.shape) - 1


def _following(rows: Rows, number: IntArray, free: AnyArray) -> sp.csr_array:
    """The placed unknowns as a combination of the free ones (placed, free)."""
    kept, (beyond, roots, steps) = np.sort(number[free]), _first_beyond(rows)
    one, other, factor = [kept], [kept], [np.ones(len(kept))]
    leading = [(number[roots, U], np.ones(len(roots)))]
    leading += [(number[jump, U][None], along) for jump, along in zip(rows.jumps, steps.T, strict=True)]
    for columns, times in leading:
        columns = np.broadcast_to(columns, (len(beyond), 3))
        there = (columns >= 0) & (times != 0.0)[:, None]
        one.append(number[beyond, U][there])
        other.append(columns[there])
        factor.append(np.broadcast_to(times[:, None], there.shape)[there])
    at = np.concatenate(one), np.searchsorted(kept, np.concatenate(other))
    return sp.csr_array((np.concatenate(factor), at), shape=(int(number.max()) + 1, len(kept)))


def _first_beyond(rows: Rows) -> Beyond:
    """Of the rows beyond a jump those that u is in."""
    beyond = rows.images.beyond
    first = rows.source[beyond.rows, U.start] == beyond.rows
    return Beyond(*(one[first] for one in beyond))


def elimination_order(rows: Rows, cliques: Sequence[IntArray], ordering: Ordering) -> IntArray:
    """Order of the places: the nodes by an ordering of their graph, then rigid bodies and jumps."""
    graph = place_graph(rows, cliques, joined=True)
    nodes = ordering(sp.csr_array(graph[: rows.nodes, : rows.nodes]))
    return np.append(nodes, np.arange(rows.nodes, rows.places))


def place_graph(rows: Rows, cliques: Sequence[IntArray], joined: bool = False) -> sp.csr_array:
    """Graph (places, places) of what is coupled; `joined`: with u beyond jumps at the roots."""
    if rows.plain:
        return graph_of(cliques, rows.places)
    place = rows.place
    if joined:
        place[rows.images.beyond.rows, U] = rows.images.beyond.roots[:, None]
    places = np.unique(place[:, [columns.start for columns in COLUMNS.values()]], axis=1).T
    return graph_of([np.concatenate([one[clique] for one in places], axis=1) for clique in cliques], rows.places)


def graph_of(cliques: Sequence[IntArray], nodes: int) -> sp.csr_array:
    """Graph (nodes, nodes) of what is coupled."""
    members = np.concatenate([clique.ravel() for clique in cliques])
    sizes = np.concatenate([np.full(len(clique), clique.shape[1]) for clique in cliques])
    starts = np.concatenate([[0], np.cumsum(sizes)])
    incidence = sp.csr_array((np.ones(members.size, dtype=np.int32), members, starts), shape=(len(sizes), nodes))
    return sp.csr_array(incidence.T @ incidence)
