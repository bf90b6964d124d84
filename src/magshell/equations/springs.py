"""Springs as a term of the equations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.instant import Instant
from magshell.equations.loads import LoadTerm
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.elastic import Elastic
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS


class SpringTerm(LoadTerm):
    """Minus the forces of the springs of a model: nodal forces as those of loads, but without a multiplier.

    Parameters
    ----------
    springs : sequence of Elastic
    constraints : Constraints
    """

    def __init__(self, springs: Sequence[Elastic], constraints: Constraints) -> None:
        super().__init__(springs, constraints)
        self._springs = springs

    def _amplitudes(self, loading: Loading) -> FloatArray:
        return np.ones(len(self._springs))

    def each(self, state: State) -> list[FloatArray]:
        """The forces (rows, 11) of each spring, global axes."""
        return [spring.forces(state) for spring in self._springs]

    def energy(self, state: State) -> float:
        """Of all springs, J."""
        return sum(spring.energy(state) for spring in self._springs)

    def load_rate(self, instant: Instant, rate: Loading) -> FloatArray:
        """See `Term`. None."""
        return np.zeros((len(instant.state.u), COMPONENTS))
