"""Element matrices and forces, put into the equations: every entry in its place, in the nodes' own frames.

Values of elements are gathered in rows of nodal arrays. Where a node has a frame of its own, its vectors v = T y are
given by components y in that frame, so that forces become Tᵀ r, and matrices Tᵀ K T.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Kernel
from magshell.equations.frames import bases
from magshell.equations.numbering import Numbering
from magshell.model.loads import Pairs
from magshell.model.supports import Constraints
from magshell.shell.unknowns import COLUMNS, COMPONENTS


class Elements(NamedTuple):
    """Elements of one kind: their nodes, and what their values are.

    Attributes
    ----------
    nodes : ndarray, shape (elements, m)
    node, component : ndarray, shape (values,)
        Node of the element and column of the nodal arrays of each value; components of a vector are all there.
    """

    nodes: IntArray
    node: IntArray
    component: IntArray


class Destination(NamedTuple):
    """Where the values of elements go.

    Attributes
    ----------
    elements : Elements
    entry : ndarray, shape (elements, values)
        Node and column of each value, as places of flat nodal arrays.
    number, rank : ndarray, shape (nodes, 10)
    indptr : ndarray, shape (equations + 1,)
    offset : ndarray, shape (elements, m, m)
        Of the first row of node I in the columns of node J, at [e, J, I].
    """

    elements: Elements
    entry: IntArray
    number: IntArray
    rank: IntArray
    indptr: IntArray
    offset: IntArray


def destination(elements: Elements, numbering: Numbering) -> Destination:
    """Where the values of these elements go."""
    count, m = elements.nodes.shape
    pairs = np.repeat(elements.nodes, m, axis=1), np.tile(elements.nodes, (1, m))
    return Destination(
        elements=elements,
        entry=COMPONENTS * elements.nodes[:, elements.node] + elements.component,
        number=numbering.number,
        rank=numbering.rank,
        indptr=numbering.indptr,
        offset=numbering.offsets(*pairs).reshape(count, m, m),
    )


def summed(to: Destination, forces: FloatArray, nodes: int) -> FloatArray:
    """Forces (elements, values) of all elements, summed at the nodes (nodes, 10)."""
    flat = np.bincount(to.entry.ravel(), forces.ravel(), COMPONENTS * nodes)
    return np.asarray(flat, dtype=float).reshape(nodes, COMPONENTS)


@Kernel
def turn_matrices(to: Destination, first: int, K: FloatArray, frame_of: IntArray, frames: FloatArray) -> None:
    """Turn transposed matrices K (range, values, values) of elements from `first` on into the nodes' frames.

    Rows and columns of a vector lie apart from each other by the number of nodes that carry it.
    """
    node, component = to.elements.node, to.elements.component
    values = len(node)
    for e in range(first, min(first + len(K), len(to.elements.nodes))):
        for l in range(values):
            c = component[l]
            if c != 0 and c != 3 and c != 7:
                continue
            stride = 0
            for k in range(values):
                stride += component[k] == c
            frame = frame_of[to.elements.nodes[e, node[l]], 0 if c == 0 else 1 if c == 3 else 2]
            if frame < 0:
                continue
            matrix = K[e - first]
            for side in range(2):
                for j in range(values):
                    a0, a1, a2 = matrix[l, j], matrix[l + stride, j], matrix[l + 2 * stride, j]
                    if side == 1:
                        a0, a1, a2 = matrix[j, l], matrix[j, l + stride], matrix[j, l + 2 * stride]
                    for i in range(3):
                        turned = frames[frame, i, 0] * a0 + frames[frame, i, 1] * a1 + frames[frame, i, 2] * a2
                        if side == 0:
                            matrix[l + i * stride, j] = turned
                        else:
                            matrix[j, l + i * stride] = turned


@Kernel
def add_matrices(to: Destination, first: int, K: FloatArray, weight: float, data: FloatArray) -> None:
    """Add transposed matrices K (range, values, values) of elements from `first` on to the tangent's values.

    The rows of one node lie side by side in a column.
    """
    node, component = to.elements.node, to.elements.component
    values, m = len(node), to.elements.nodes.shape[1]
    free, rank = np.zeros(values, dtype=np.int64), np.zeros(values, dtype=np.int64)
    place = np.zeros((m, values), dtype=np.int64)
    for e in range(first, min(first + len(K), len(to.elements.nodes))):
        nodes, count = to.elements.nodes[e], 0
        for l in range(values):
            if to.number[nodes[node[l]], component[l]] >= 0:
                free[count], rank[count] = l, to.rank[nodes[node[l]], component[l]]
                count += 1
        for J in range(m):
            for k in range(count):
                place[J, k] = to.offset[e, J, node[free[k]]] + rank[k]
        for f in range(count):
            l = free[f]
            row, places = K[e - first, l], place[node[l]]
            start = to.indptr[to.number[nodes[node[l]], component[l]]]
            column = data[start:]
            if count == values:
                for k in range(values):
                    column[places[k]] += weight * row[k]
            else:
                for k in range(count):
                    column[places[k]] += weight * row[free[k]]


class Insertion:
    """The tangent that terms are inserted into.

    Parameters
    ----------
    numbering : Numbering
    constraints : Constraints
    """

    def __init__(self, numbering: Numbering, constraints: Constraints) -> None:
        self.numbering, self.constraints = numbering, constraints
        self.data = np.zeros(numbering.indices.size)
        self.matrix = sp.csc_array(
            (self.data, numbering.indices, numbering.indptr.astype(numbering.indices.dtype)),
            shape=(numbering.dofs, numbering.dofs),
        )

    def blocks(self, pairs: Pairs) -> IntArray:
        """Positions (n, 3, 3) in the tangent's values of the blocks of pairs; -1 where a component is held."""
        if not pairs.rows.size:
            return np.empty((0, 3, 3), dtype=np.int64)
        number, rank = self.numbering.number, self.numbering.rank
        rows, columns = COLUMNS[pairs.row_field], COLUMNS[pairs.column_field]
        offset = self.numbering.offsets(pairs.columns, pairs.rows)
        row_number, column_number = number[pairs.rows, rows], number[pairs.columns, columns]
        start = self.numbering.indptr[column_number]
        at = start[:, None, :] + offset[:, None, None] + rank[pairs.rows, rows][:, :, None]
        return np.where((row_number[:, :, None] >= 0) & (column_number[:, None, :] >= 0), at, -1)

    def add_blocks(self, pairs: Pairs, at: IntArray, blocks: FloatArray) -> None:
        """Add blocks (n, 3, 3), global axes, at the positions of pairs."""
        if len(self.constraints.frames):
            rows = bases(self.constraints, pairs.row_field, pairs.rows)
            columns = bases(self.constraints, pairs.column_field, pairs.columns)
            blocks = np.einsum("nij,njk,nlk->nil", rows, blocks, columns)
        np.add.at(self.data, at[at >= 0], blocks[at >= 0])
