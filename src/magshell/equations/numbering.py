"""Numbering of the equations: which columns of the nodal arrays nodes have, and the sparsity of the tangent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, IntArray
from magshell.shell.unknowns import COLUMNS, width


@dataclass(frozen=True)
class Pattern:
    """Sparsity of the tangent, compressed columns, equations in elimination order."""

    indptr: IntArray
    indices: IntArray
    dofs: int


def whole(free: AnyArray, elements: IntArray, carrying: list[int]) -> AnyArray:
    """Nodes (nodes,) of which every component that the elements give values to is free."""
    valued = np.zeros_like(free)
    for column, count in enumerate(carrying):
        valued[elements[:, :count], column] = True
    return (free == valued).all(axis=1)


def columns_of(carriers: dict[str, AnyArray]) -> AnyArray:
    """Which nodes have which columns of the nodal arrays: boolean (nodes, 10)."""
    return np.column_stack([carriers[field] for field in COLUMNS for _ in range(width(field))])


def pattern_of(graph: sp.csr_array, order: IntArray, counts: IntArray) -> tuple[Pattern, sp.csr_array]:
    """Pattern of the matrix, and for node pairs (column, row) one plus the row's offset in the column."""
    nodes = len(order)
    ordered = sp.csr_array(graph[order][:, order])
    ordered.sort_indices()
    block = counts[order]
    lengths = block[ordered.indices]
    ends = np.cumsum(lengths)
    starts = ends - lengths
    column_start = np.append(starts, ends[-1] if len(ends) else 0)[ordered.indptr]
    within = starts - np.repeat(column_start[:-1], np.diff(ordered.indptr))
    coordinates = (order[np.repeat(np.arange(nodes), np.diff(ordered.indptr))], order[ordered.indices])
    row_offset = sp.csr_array(sp.coo_array((within + 1, coordinates), shape=graph.shape))
    first_equation = np.cumsum(block) - block
    rows = np.repeat(first_equation[ordered.indices] - starts, lengths) + np.arange(ends[-1])
    node_of_column = np.repeat(np.arange(nodes), block)
    column_length = np.diff(column_start)[node_of_column]
    indptr = np.append(0, np.cumsum(column_length))
    index = np.arange(indptr[-1]) + np.repeat(column_start[node_of_column] - indptr[:-1], column_length)
    return Pattern(indptr, rows[index].astype(np.int32), len(node_of_column)), row_offset
