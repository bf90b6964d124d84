"""Element matrices and forces, put into the equations: every entry in its place, in the nodes' own frames.

Values of elements are gathered in rows of nodal arrays. Where a node has a frame of its own, its vectors v = T y are
given by components y in that frame, so that forces become Tᵀ r, and matrices Tᵀ K T.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.equations.frames import bases
from magshell.equations.numbering import Numbering
from magshell.equations.reduction import Reduction
from magshell.equations.scatter import Destination, Elements
from magshell.model.constraints import Constraints
from magshell.model.loads import Pairs
from magshell.shell.unknowns import COLUMNS, COMPONENTS


def destination(elements: Elements, numbering: Numbering) -> Destination:
    """Where the values of these elements go."""
    places, slot = _slots(elements, numbering.place)
    m = places.shape[1]
    pairs = np.repeat(places, m, axis=1), np.tile(places, (1, m))
    return Destination(
        elements=elements,
        slot=slot,
        entry=np.ascontiguousarray(COMPONENTS * elements.nodes[:, elements.node] + elements.component),
        number=numbering.number,
        rank=numbering.rank,
        indptr=numbering.indptr,
        offset=numbering.offsets(*pairs).reshape(len(places), m, m),
    )


def _slots(elements: Elements, place: IntArray) -> tuple[IntArray, IntArray]:
    """Places (elements, slots) of the elements, and the slot (values,) of each value (see `Destination`).

    Fields whose values are elsewhere (on rigid bodies, beyond a jump) have slots of their own.
    """
    places: list[IntArray] = []
    slot, width = elements.node.copy(), elements.nodes.shape[1]
    for columns in COLUMNS.values():
        there = place[elements.nodes, columns.start]
        number = next((n for n, known in enumerate(places) if np.array_equal(known, there)), len(places))
        places += [there] if number == len(places) else []
        slot[(columns.start <= elements.component) & (elements.component < columns.stop)] += number * width
    return np.concatenate(places, axis=1), slot


def summed(to: Destination, forces: FloatArray, nodes: int) -> FloatArray:
    """Forces (elements, values) of all elements, summed at the nodes (nodes, 11)."""
    flat = np.bincount(to.entry.ravel(), forces.ravel(), COMPONENTS * nodes)
    return np.asarray(flat, dtype=float).reshape(nodes, COMPONENTS)


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
        self._matrix = sp.csc_array(
            (self.data, numbering.indices, numbering.indptr.astype(numbering.indices.dtype)),
            shape=(numbering.placed, numbering.placed),
        )
        self._reduction = Reduction(self._matrix, numbering.following) if numbering.following is not None else None

    def tangent(self) -> sp.csc_array:
        """The tangent of the free unknowns; the next insertion overwrites its values."""
        return self._matrix if self._reduction is None else self._reduction.of(self.data)

    def blocks(self, pairs: Pairs) -> IntArray:
        """Positions (n, 3, 3) in the tangent's values of the blocks of pairs; -1 where a component is held."""
        if not pairs.rows.size:
            return np.empty((0, 3, 3), dtype=np.int64)
        number, rank = self.numbering.number, self.numbering.rank
        rows, columns = COLUMNS[pairs.row_field], COLUMNS[pairs.column_field]
        place = self.numbering.place
        offset = self.numbering.offsets(place[pairs.columns, columns.start], place[pairs.rows, rows.start])
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
