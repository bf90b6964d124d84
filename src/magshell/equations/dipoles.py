"""Magnetic moments of rigid bodies as a term of the equations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.loads import LoadTerm
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.dipole import Dipole
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS


class DipoleTerm(LoadTerm):
    """Minus the couples of the field on the magnetic moments of rigid bodies, linear in the field.

    Parameters
    ----------
    dipoles : sequence of Dipole
        Three of each body, for the components of the field.
    constraints : Constraints
    """

    def __init__(self, dipoles: Sequence[Dipole], constraints: Constraints) -> None:
        super().__init__(dipoles, constraints)
        self._dipoles = dipoles

    def _amplitudes(self, loading: Loading) -> FloatArray:
        return np.tile(loading.flux_density, len(self._dipoles) // 3)

    def torques(self, state: State, loading: Loading) -> FloatArray:
        """Couples on the spins (rows, 3), N m."""
        return self.forces(state, self._amplitudes(loading))[:, COLUMNS["omega"]]

    def energy(self, state: State, loading: Loading) -> float:
        """-Σ R m · B, J."""
        fields = zip(self._dipoles, self._amplitudes(loading), strict=True)
        return -sum(float(B * dipole.turned(state) @ dipole.axis) for dipole, B in fields)
