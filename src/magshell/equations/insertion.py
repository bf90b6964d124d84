"""Element matrices and forces, put into the equations: every entry in its place, in the nodes' own frames.

Values of elements are gathered in rows of nodal arrays. Where a node has a frame of its own, its vectors v = T y are
given by components y in that frame, so that forces become Tᵀ r, and matrices Tᵀ K T.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Kernel, inline
from magshell.equations.frames import bases
from magshell.equations.numbering import Numbering
from magshell.model.loads import Pairs
from magshell.model.supports import Constraints
from magshell.shell.unknowns import COLUMNS


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
    partner : ndarray, shape (values, 3)
        Places of the components of a value's vector; of a scalar -1.
    number, rank : ndarray, shape (nodes, 10)
    indptr : ndarray, shape (equations + 1,)
    offset : ndarray, shape (elements, m, m)
        Of the first row of node I in the columns of node J, at [e, J, I].
    frame_of : ndarray, shape (nodes, 3)
    frames : ndarray, shape (frames, 3, 3)
        Rows are the base vectors.
    """

    elements: Elements
    partner: IntArray
    number: IntArray
    rank: IntArray
    indptr: IntArray
    offset: IntArray
    frame_of: IntArray
    frames: FloatArray


class Sums(NamedTuple):
    """What elements are summed into.

    Attributes
    ----------
    data : ndarray, shape (nonzeros,)
        Values of the tangent, compressed columns.
    residual : ndarray, shape (nodes, 10)
    condensed : ndarray, shape (nodes, 10)
        The residual after the elimination of what elements own, plus the tangent's product with imposed increments.
    """

    data: FloatArray
    residual: FloatArray
    condensed: FloatArray


def destination(elements: Elements, numbering: Numbering, constraints: Constraints) -> Destination:
    """Where the values of these elements go."""
    count, m = elements.nodes.shape
    pairs = np.repeat(elements.nodes, m, axis=1), np.tile(elements.nodes, (1, m))
    place = {key: at for at, key in enumerate(zip(elements.node.tolist(), elements.component.tolist(), strict=True))}
    partner = np.full((elements.node.size, 3), -1)
    for field in ("u", "w", "omega"):
        start = COLUMNS[field].start
        for at, (node, component) in enumerate(zip(elements.node, elements.component, strict=True)):
            if start <= component < start + 3:
                partner[at] = [place[int(node), start + i] for i in range(3)]
    return Destination(
        elements=elements,
        partner=partner,
        number=numbering.number,
        rank=numbering.rank,
        indptr=numbering.indptr,
        offset=numbering.offsets(*pairs).reshape(count, m, m),
        frame_of=np.ascontiguousarray(constraints.frame_of),
        frames=np.ascontiguousarray(constraints.frames),
    )


@inline
def _turn_rows(to: Destination, e: int, rows: FloatArray, width: int) -> None:
    """Turn the rows of each node's vectors into the node's own frame."""
    if len(to.frames) == 0:
        return
    for l in range(len(to.partner)):
        component = to.elements.component[l]
        if component == 0 or component == 3 or component == 7:
            field = 0 if component == 0 else 1 if component == 3 else 2
            frame = to.frame_of[to.elements.nodes[e, to.elements.node[l]], field]
            if frame < 0:
                continue
            at0, at1, at2 = to.partner[l, 0], to.partner[l, 1], to.partner[l, 2]
            for j in range(width):
                a0, a1, a2 = rows[at0, j], rows[at1, j], rows[at2, j]
                for i in range(3):
                    row = to.frames[frame, i]
                    rows[to.partner[l, i], j] = row[0] * a0 + row[1] * a1 + row[2] * a2


@inline
def _turn_columns(to: Destination, e: int, rows: FloatArray, height: int) -> None:
    """Turn the columns likewise."""
    if len(to.frames) == 0:
        return
    for l in range(len(to.partner)):
        component = to.elements.component[l]
        if component == 0 or component == 3 or component == 7:
            field = 0 if component == 0 else 1 if component == 3 else 2
            frame = to.frame_of[to.elements.nodes[e, to.elements.node[l]], field]
            if frame < 0:
                continue
            at0, at1, at2 = to.partner[l, 0], to.partner[l, 1], to.partner[l, 2]
            for j in range(height):
                a0, a1, a2 = rows[j, at0], rows[j, at1], rows[j, at2]
                for i in range(3):
                    row = to.frames[frame, i]
                    rows[j, to.partner[l, i]] = row[0] * a0 + row[1] * a1 + row[2] * a2


@Kernel
def add_forces(to: Destination, first: int, r: FloatArray, out: Sums) -> None:
    """Add forces r (range, values, 2) of elements from `first` on: to the residual, and to what is condensed."""
    values = len(to.partner)
    for e in range(first, min(first + len(r), len(to.elements.nodes))):
        _turn_rows(to, e, r[e - first], 2)
        for l in range(values):
            node, component = to.elements.nodes[e, to.elements.node[l]], to.elements.component[l]
            out.residual[node, component] += r[e - first, l, 0]
            out.condensed[node, component] += r[e - first, l, 1]


@Kernel
def add_matrices(to: Destination, first: int, K: FloatArray, weight: float, imposed: FloatArray, out: Sums) -> None:
    """Add transposed matrices K (range, values, values) of elements from `first` on, and products with what is imposed.

    K is turned into the nodes' frames in place. The rows of one node lie side by side in a column.
    """
    values, m = len(to.partner), to.elements.nodes.shape[1]
    place = np.zeros((m, values), dtype=np.int64)
    for e in range(first, min(first + len(K), len(to.elements.nodes))):
        nodes, matrix = to.elements.nodes[e], K[e - first]
        _turn_rows(to, e, matrix, values)
        _turn_columns(to, e, matrix, values)
        for J in range(m):
            for l in range(values):
                I, component = to.elements.node[l], to.elements.component[l]
                held = to.number[nodes[I], component] < 0
                place[J, l] = -1 if held else to.offset[e, J, I] + to.rank[nodes[I], component]
        for l in range(values):
            J, component = to.elements.node[l], to.elements.component[l]
            number, row = to.number[nodes[J], component], matrix[l]
            if number < 0:
                given = weight * imposed[nodes[J], component]
                if given != 0.0:
                    for k in range(values):
                        out.condensed[nodes[to.elements.node[k]], to.elements.component[k]] += row[k] * given
                continue
            start, places = to.indptr[number], place[J]
            for k in range(values):
                if places[k] >= 0:
                    out.data[start + places[k]] += weight * row[k]


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
