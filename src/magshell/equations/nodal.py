r"""Nodal forces and their derivatives, put into the equations through the dependent values.

Where values depend on others (`dependence.py`), δv = … + L δω, forces on u and d act on the spins too. A block B of the
tangent between v of two rows gives them Lᵀ B, B L and Lᵀ B L, and the couples of the forces change with the levers.

Elements differentiate in the chart exp(ϑ) R̃, and so do these. What is not symmetric of the change of a couple c, half
of [c]×, is the transport of the same couple in the elements, and neither is made. Where some of the rotations of a row
are held the elements have theirs (`loops.py`), and so have these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.dependence import Dependence, Levers
from magshell.equations.insertion import Insertion
from magshell.model.loads import Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA
from magshell.shell.unknowns import COLUMNS


class _Part(NamedTuple):
    """Blocks of some members of a pair, with L of the rows, of the columns, or none; where they go."""

    source: int
    members: AnyArray
    by_row: bool
    by_column: bool
    pairs: Pairs
    at: IntArray


class NodalBlocks:
    """Places in the tangent of the derivatives of nodal forces.

    Parameters
    ----------
    insertion : Insertion
    dependence : Dependence
    pairs : sequence of Pairs
        Where there are derivatives.
    loaded : ndarray of bool, shape (rows,)
        Rows on whose u or d there may be forces.
    """

    def __init__(self, insertion: Insertion, dependence: Dependence, pairs: Sequence[Pairs], loaded: AnyArray) -> None:
        self._insertion, self._dependence, self._pairs = insertion, dependence, pairs
        self._parts = [part for number in range(len(pairs)) for part in self._parts_of(number)]
        rows = np.flatnonzero(loaded & dependence.depends)
        self._levers = Pairs("omega", "omega", rows, rows)
        self._levers_at = insertion.blocks(self._levers)
        self._transported = insertion.numbering.partly_held[rows]

    def _parts_of(self, number: int) -> Iterator[_Part]:
        pairs = self._pairs[number]
        row = self._dependence.depends_of(pairs.row_field)[pairs.rows]
        column = self._dependence.depends_of(pairs.column_field)[pairs.columns]
        everywhere = np.ones(len(pairs.rows), dtype=bool)
        for by_row, by_column, members in (
            (False, False, everywhere),
            (True, False, row),
            (False, True, column),
            (True, True, row & column),
        ):
            if members.any():
                spins = Pairs(
                    "omega" if by_row else pairs.row_field,
                    "omega" if by_column else pairs.column_field,
                    pairs.rows[members],
                    pairs.columns[members],
                )
                yield _Part(number, members, by_row, by_column, spins, self._insertion.blocks(spins))

    def insert(self, weight: float, forces: FloatArray, blocks: Sequence[FloatArray | None], levers: Levers) -> None:
        """Add weight times the blocks (n, 3, 3) of each of the pairs, and of the levers of forces (rows, 11).

        Blocks are derivatives of minus the forces, as the residual has them; None for none.
        """
        for pairs, at, block in self._made(forces, blocks, levers):
            self._insertion.add_blocks(pairs, at, weight * block)

    def product(
        self, increments: FloatArray, forces: FloatArray, blocks: Sequence[FloatArray | None], levers: Levers
    ) -> FloatArray:
        """Product of what `insert` adds at weight 1 with increments (rows, 11), global axes."""
        result = np.zeros_like(increments)
        for pairs, _, block in self._made(forces, blocks, levers):
            along = np.einsum("nij,nj->ni", block, increments[pairs.columns, COLUMNS[pairs.column_field]])
            np.add.at(result[:, COLUMNS[pairs.row_field]], pairs.rows, along)
        return result

    def _made(
        self, forces: FloatArray, blocks: Sequence[FloatArray | None], levers: Levers
    ) -> Iterator[tuple[Pairs, IntArray, FloatArray]]:
        """Pairs, their places and blocks."""
        for part in self._parts:
            whole, of = blocks[part.source], self._pairs[part.source]
            if whole is None:
                continue
            block = whole[part.members]
            if part.by_row:
                L = self._dependence.lever_matrices(of.row_field, levers)[part.pairs.rows]
                block = np.swapaxes(L, 1, 2) @ block
            if part.by_column:
                block = block @ self._dependence.lever_matrices(of.column_field, levers)[part.pairs.columns]
            yield part.pairs, part.at, block
        rows = self._levers.rows
        if rows.size:
            change = self._dependence.curvature(forces, levers)[rows]
            couples = (self._dependence.gathered(forces, levers) - forces)[rows, OMEGA]
            change[self._transported] -= 0.5 * cross_matrix(couples[self._transported])
            yield self._levers, self._levers_at, -change
