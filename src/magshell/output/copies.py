"""Copies of a modelled part: rigid motions, and those that make the structure that a repeated part stands for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.repeated import Cyclic, Periodic

if TYPE_CHECKING:
    from magshell.evaluation.converged import Converged


class Copy(NamedTuple):
    """x to matrix x + shift, shift in m."""

    matrix: FloatArray
    shift: FloatArray | tuple[float, float, float] = (0.0, 0.0, 0.0)

    def of(self, points: FloatArray) -> FloatArray:
        """Images of points (..., 3)."""
        return points @ self.matrix.T + np.asarray(self.shift)


def neighbours(reached: Converged) -> list[Copy]:
    """Copies of a repeated part in a state: all other sectors about an axis, the cells next to a cell."""
    shell = reached.discretisation.model.shell
    if not shell.repeated:
        return []
    rows = reached.discretisation.rows
    copies = [Copy(np.eye(3))]
    jumps = iter(rows.points[rows.jumps] + reached.state.u[rows.jumps])
    for one in shell.repeated:
        if isinstance(one, Cyclic):
            Q, point = one.rotation(shell.mesh), np.asarray(one.point)
            turns = [np.linalg.matrix_power(Q, k) for k in range(one.sectors)]
            motions = [Copy(turn, point - turn @ point) for turn in turns]
        elif isinstance(one, Periodic):
            step = next(jumps)
            motions = [Copy(np.eye(3), k * step) for k in (0, -1, 1)]
        copies = [Copy(a.matrix @ b.matrix, a.of(np.asarray(b.shift))) for a, b in product(motions, copies)]
    return copies[1:]


def with_copies(points: FloatArray, copies: Sequence[Copy]) -> FloatArray:
    """Points (n, 3) and their images, ((copies + 1) n, 3)."""
    return np.concatenate([points, *(copy.of(points) for copy in copies)])


def between(one: Sequence[Copy], other: Sequence[Copy], share: float) -> list[Copy]:
    """A share of the way from the copies of one state to those of another."""
    shifts = [(np.asarray(a.shift), np.asarray(b.shift)) for a, b in zip(one, other, strict=True)]
    return [Copy(a.matrix, here + share * (there - here)) for a, (here, there) in zip(one, shifts, strict=True)]
