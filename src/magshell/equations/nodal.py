r"""Nodal forces and their derivatives, put into the equations through the dependent values.

Where values depend on others (`dependence.py`), δv = … + L δω, forces on u and d act on the spins too. A block B of the
tangent between v of two rows gives them Lᵀ B, B L and Lᵀ B L, and the couples of the forces change with the levers.

Elements differentiate in the chart exp(ϑ) R̃, and so do these. What is not symmetric of the change of a couple c, half
of [c]×, is the transport of the same couple in the elements, and neither is made. Where exactly one rotation of a row
is held the elements have theirs (`loops.py`), and so have these.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.dependence import Dependence, Levers
from magshell.equations.insertion import Insertion
from magshell.model.loads import Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA


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
        self._insertion, self._dependence = insertion, dependence
        self._direct = [(one, insertion.blocks(one)) for one in pairs]
        self._chained = [_Chained(insertion, dependence, one) for one in pairs]
        rows = np.flatnonzero(loaded & dependence.depends)
        self._levers = Pairs("omega", "omega", rows, rows)
        self._levers_at = insertion.blocks(self._levers)
        self._transported = insertion.numbering.one_rotation_held[rows]

    def insert(self, weight: float, forces: FloatArray, blocks: Sequence[FloatArray | None], levers: Levers) -> None:
        """Add weight times the blocks (n, 3, 3) of each of the pairs, and of the levers of forces (rows, 11).

        Blocks are derivatives of minus the forces, as the residual has them; None for none.
        """
        for (pairs, at), chained, block in zip(self._direct, self._chained, blocks, strict=True):
            if block is not None:
                self._insertion.add_blocks(pairs, at, weight * block)
                chained.insert(weight, block, levers)
        rows = self._levers.rows
        if rows.size:
            change = self._dependence.curvature(forces, levers)[rows]
            couples = (self._dependence.gathered(forces, levers) - forces)[rows, OMEGA]
            change[self._transported] -= 0.5 * cross_matrix(couples[self._transported])
            self._insertion.add_blocks(self._levers, self._levers_at, -weight * change)


class _Chained:
    """What a pair's blocks give to spins."""

    def __init__(self, insertion: Insertion, dependence: Dependence, pairs: Pairs) -> None:
        self._insertion, self._dependence, self._pairs = insertion, dependence, pairs
        by_row, by_column = (
            dependence.depends_of(field)[nodes]
            for field, nodes in ((pairs.row_field, pairs.rows), (pairs.column_field, pairs.columns))
        )
        self._parts: list[tuple[AnyArray, bool, bool, Pairs, IntArray]] = []
        for rows, columns, members in (
            (True, False, by_row),
            (False, True, by_column),
            (True, True, by_row & by_column),
        ):
            if members.any():
                spins = Pairs(
                    "omega" if rows else pairs.row_field,
                    "omega" if columns else pairs.column_field,
                    pairs.rows[members],
                    pairs.columns[members],
                )
                self._parts.append((members, rows, columns, spins, insertion.blocks(spins)))

    def insert(self, weight: float, blocks: FloatArray, levers: Levers) -> None:
        """Add weight times Lᵀ B, B L and Lᵀ B L."""
        for members, rows, columns, spins, at in self._parts:
            block = weight * blocks[members]
            if rows:
                L = self._dependence.lever_matrices(self._pairs.row_field, levers)[spins.rows]
                block = np.swapaxes(L, 1, 2) @ block
            if columns:
                block = block @ self._dependence.lever_matrices(self._pairs.column_field, levers)[spins.columns]
            self._insertion.add_blocks(spins, at, block)
