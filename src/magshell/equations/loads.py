"""Forces at nodes as terms of the equations: loads and others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.dependence import Dependence
from magshell.equations.frames import to_frames, to_global
from magshell.equations.insertion import Insertion
from magshell.equations.instant import Increment, Instant, Prediction, Weights
from magshell.equations.nodal import NodalBlocks
from magshell.equations.term import Contribution, squares_by_kind
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.loads import Applied, Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS


class NodalTerm:
    """Minus forces at nodes, with their derivatives at pairs of rows.

    A subclass says what the forces are, what minus their derivatives are (one array of blocks (n, 3, 3) for each of the
    pairs, None for none), and their derivative along a rate of the loading.

    Parameters
    ----------
    pairs : sequence of Pairs
    constraints : Constraints
    """

    def __init__(self, pairs: Sequence[Pairs], constraints: Constraints) -> None:
        self._pairs, self._constraints = pairs, constraints

    def _forces(self, instant: Instant) -> FloatArray:
        raise NotImplementedError

    def _blocks(self, instant: Instant) -> Sequence[FloatArray | None]:
        raise NotImplementedError

    def _rates(self, instant: Instant, rate: Loading) -> FloatArray:
        raise NotImplementedError

    def _loaded(self, rows: int) -> AnyArray:
        """Whether there may be forces on u or d, and couples, at each row without derivatives (2, rows)."""
        return np.zeros((2, rows), dtype=bool)

    def place(self, insertion: Insertion, dependence: Dependence) -> None:
        """Tell the term where its blocks go."""
        free = insertion.numbering.number >= 0
        loaded, carrying = self._loaded(len(free))
        for pairs in self._pairs:
            (carrying if pairs.row_field == "omega" else loaded)[pairs.rows] = True
        self._dependence = dependence
        self._places = NodalBlocks(insertion, dependence, self._pairs, loaded)
        nodes = np.flatnonzero(carrying & np.all(free[:, COLUMNS["omega"]], axis=1))
        self._couples = Pairs("omega", "omega", nodes, nodes)
        self._couples_at = insertion.blocks(self._couples)

    def couplings(self) -> Sequence[IntArray]:
        """See `Term`."""
        pairs = [np.column_stack([one.rows, one.columns]) for one in self._pairs]
        return [np.unique(np.sort(one, axis=1), axis=0) for one in pairs if len(one)]

    def evaluate(
        self, instant: Instant, weights: Weights, insertion: Insertion | None, imposed: FloatArray | None
    ) -> Contribution:
        """See `Term`."""
        forces = self._forces(instant)
        levers = self._dependence.levers(instant.state)
        residual = condensed = -to_frames(self._constraints, self._dependence.gathered(forces, levers))
        if insertion is not None:
            blocks = self._blocks(instant)
            self._places.insert(weights.displacement, forces, blocks, levers)
            self._transport(weights, insertion, forces)
            if imposed is not None:
                given = to_global(self._constraints, imposed)
                moving = weights.displacement * self._places.product(given, forces, blocks, levers)
                condensed = residual + to_frames(self._constraints, moving)
        return Contribution(residual, condensed, squares_by_kind(residual), 0.0)

    def _transport(self, weights: Weights, insertion: Insertion, forces: FloatArray) -> None:
        """Add a transport of the couples.

        Elements differentiate in the chart exp(ϑ) R̃, in which a couple c on the spins of the new state is
        c + c × ϑ / 2: so K = K_chart - [c]×/2, with the sum c of the couples of a node's elements. In equilibrium c is
        the loads' couple where no rotation is held. Where some are, the loops over elements have all of c, loads and
        reaction; where all are, [c]× meets no free rotation.
        """
        if self._couples.rows.size:
            couples = forces[self._couples.rows, COLUMNS["omega"]]
            insertion.add_blocks(self._couples, self._couples_at, -0.5 * weights.displacement * cross_matrix(couples))

    def load_rate(self, instant: Instant, rate: Loading) -> FloatArray:
        """See `Term`."""
        forces = self._rates(instant, rate)
        gathered = self._dependence.gathered(forces, self._dependence.levers(instant.state))
        return -to_frames(self._constraints, gathered)

    def predict(self, instant: Instant, increment: Increment) -> Prediction:
        """See `Term`."""
        return None

    def recovered(self, nodal: FloatArray, whole: bool) -> FloatArray | None:
        """See `Term`."""
        return None

    def noise(self) -> FloatArray:
        """See `Term`."""
        return np.zeros(len(COLUMNS) + 1)


class LoadTerm(NodalTerm):
    """Minus the forces of the loads of a model.

    Parameters
    ----------
    applied : sequence of Applied
    constraints : Constraints
    """

    def __init__(self, applied: Sequence[Applied], constraints: Constraints) -> None:
        self._applied, self._own = applied, [tuple(one.pairs) for one in applied]
        super().__init__([pairs for own in self._own for pairs in own], constraints)

    def _loaded(self, rows: int) -> AnyArray:
        undeformed = State.undeformed(rows, 0, 0)
        loaded, carrying = np.zeros((2, rows), dtype=bool)
        for one in self._applied:
            forces = one.forces(undeformed)
            carrying[np.flatnonzero(np.any(forces[:, COLUMNS["omega"]], axis=1))] = True
            loaded[np.flatnonzero(np.any(forces[:, :6], axis=1))] = True
        return np.array([loaded, carrying])

    def forces(self, state: State, amplitudes: FloatArray) -> FloatArray:
        """Sum of the loads (rows, 11), global axes: N on u, N m on directors and spins."""
        total = np.zeros((len(state.u), COMPONENTS))
        for amplitude, one in zip(amplitudes, self._applied, strict=True):
            if amplitude:
                forces = one.forces(state)
                total[: len(forces)] += amplitude * forces
        return total

    def _amplitudes(self, loading: Loading) -> FloatArray:
        """Multiplier of each."""
        return loading.loads

    def _forces(self, instant: Instant) -> FloatArray:
        return self.forces(instant.state, self._amplitudes(instant.loading))

    def _blocks(self, instant: Instant) -> Sequence[FloatArray | None]:
        blocks: list[FloatArray | None] = []
        for amplitude, one, own in zip(self._amplitudes(instant.loading), self._applied, self._own, strict=True):
            blocks += [amplitude * block for block in one.stiffness(instant.state)] if amplitude else [None] * len(own)
        return blocks

    def _rates(self, instant: Instant, rate: Loading) -> FloatArray:
        return self.forces(instant.state, self._amplitudes(rate))
