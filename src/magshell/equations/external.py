"""The loads in the equations: their sum at a state, and their places in the tangent."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.frames import bases
from magshell.model.loads import Applied, Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.model.supports import Constraints
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS

Places = Callable[[Pairs], IntArray]


class External:
    """The loads of a model.

    Parameters
    ----------
    applied : sequence of Applied
    constraints : Constraints
    places : callable
        From pairs of nodal fields to the positions (n, 3, 3) of their blocks in the tangent's values, -1 for none.
    turning : ndarray of bool, shape (nodes,)
        Nodes with three free rotations.
    """

    def __init__(self, applied: Sequence[Applied], constraints: Constraints, places: Places, turning: AnyArray) -> None:
        self._applied, self._constraints = applied, constraints
        self._at = [None if one.pairs is None else places(one.pairs) for one in applied]
        undeformed = State.undeformed(len(turning), 0, 0)
        carrying = np.zeros(len(turning), dtype=bool)
        for one in applied:
            carrying |= np.any(one.forces(undeformed)[:, COLUMNS["omega"]], axis=1)
        nodes = np.flatnonzero(carrying & turning)
        self._couples = Pairs("omega", "omega", nodes, nodes)
        self._couples_at = places(self._couples)

    def forces(self, state: State, amplitudes: FloatArray) -> FloatArray:
        """Sum of the loads (nodes, 10), global axes: N on u, N m on directors and spins."""
        total = np.zeros((len(state.u), COMPONENTS))
        for amplitude, one in zip(amplitudes, self._applied, strict=True):
            if amplitude:
                total += amplitude * one.forces(state)
        return total

    def add_stiffness(self, state: State, amplitudes: FloatArray, forces: FloatArray, data: FloatArray) -> None:
        """Add what the loads contribute to the values of the tangent; `forces` is their sum.

        That is minus the derivative of the forces, and a transport of the couples. Elements differentiate in the chart
        exp(ϑ) R̃, in which a couple c on the spins of the new state is c + c × ϑ / 2: so K = K_chart - [c]×/2, with the
        sum c of the couples of a node's elements. In equilibrium c is the loads' couple where no rotation is held.
        Where exactly one is, the loops over elements have all of c, loads and reaction; where more are, [c]× does not
        meet two free rotations.
        """
        for amplitude, one, at in zip(amplitudes, self._applied, self._at, strict=True):
            if amplitude and at is not None and one.pairs is not None:
                self._scatter(one.pairs, at, amplitude * one.stiffness(state), data)
        if self._couples.rows.size:
            couples = forces[self._couples.rows, COLUMNS["omega"]]
            self._scatter(self._couples, self._couples_at, -0.5 * cross_matrix(couples), data)

    def _scatter(self, pairs: Pairs, at: IntArray, blocks: FloatArray, data: FloatArray) -> None:
        rows = bases(self._constraints, pairs.row_field, pairs.rows)
        columns = bases(self._constraints, pairs.column_field, pairs.columns)
        local = np.einsum("nij,njk,nlk->nil", rows, blocks, columns)
        np.add.at(data, at[at >= 0], local[at >= 0])
