"""Numbers of the equations, and the sparsity of the tangent: blocks of nodes that a term couples."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, IntArray
from magshell.shell.unknowns import COLUMNS, width

Ordering = Callable[[sp.csr_array], IntArray]


class Numbering:
    """Equations of the free unknowns, in the order of elimination.

    Parameters
    ----------
    free : ndarray of bool, shape (nodes, 10)
    cliques : sequence of ndarray, shape (n, m)
        Nodes that are coupled with each other, row by row.
    ordering : callable
        From the graph of the nodes (nodes, nodes) to their order of elimination.

    Attributes
    ----------
    dofs : int
        Number of equations.
    number : ndarray, shape (nodes, 10)
        Equation, -1 where fixed or absent.
    rank : ndarray, shape (nodes, 10)
        Equation minus the node's first one.
    indptr, indices : ndarray
        Of the tangent, compressed columns.
    """

    def __init__(self, free: AnyArray, cliques: Sequence[IntArray], ordering: Ordering) -> None:
        self.free = free
        graph = graph_of(cliques, len(free))
        order = ordering(graph)
        counts = free.sum(axis=1)
        first = np.empty(len(free), dtype=np.int64)
        first[order] = np.cumsum(counts[order]) - counts[order]
        self.rank = np.cumsum(free, axis=1) - 1
        self.number = np.where(free, first[:, None] + self.rank, -1)
        self.equations = self.number[free]
        self.dofs = int(counts.sum())
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
        """Place of the first row of nodes `rows` in the columns of nodes `columns`, from the columns' start."""
        return np.asarray(self._offsets[columns.ravel(), rows.ravel()], dtype=np.int64).reshape(columns.shape) - 1


def graph_of(cliques: Sequence[IntArray], nodes: int) -> sp.csr_array:
    """Graph (nodes, nodes) of what is coupled."""
    members = np.concatenate([clique.ravel() for clique in cliques])
    sizes = np.concatenate([np.full(len(clique), clique.shape[1]) for clique in cliques])
    starts = np.concatenate([[0], np.cumsum(sizes)])
    incidence = sp.csr_array((np.ones(members.size, dtype=np.int32), members, starts), shape=(len(sizes), nodes))
    return sp.csr_array(incidence.T @ incidence)


def columns_of(carriers: dict[str, AnyArray]) -> AnyArray:
    """Which nodes have which columns of the nodal arrays: boolean (nodes, 10)."""
    return np.column_stack([carriers[field] for field in COLUMNS for _ in range(width(field))])
