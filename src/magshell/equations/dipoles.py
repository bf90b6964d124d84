r"""Magnetic moments of rigid bodies as a term of the equations.

A dipole m turns with the body, R m, at its reference point x. Its energy -R m · B(x) gives the couple R m × B and the
force f_j = (R m)_i ∂B_i/∂x_j.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.instant import Instant
from magshell.equations.loads import NodalTerm
from magshell.magnetics.fields import Field, Values
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.loads import Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA, Rows, U
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.rotation import cross
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS


class DipoleTerm(NodalTerm):
    """Minus what the field exerts on the magnetic moments of rigid bodies.

    Parameters
    ----------
    shell : Shell
    rows : Rows
    field : Field
    constraints : Constraints
    """

    def __init__(self, shell: Shell, rows: Rows, field: Field, constraints: Constraints) -> None:
        numbers = [number for number, body in enumerate(shell.rigid) if np.any(body.moment)]
        self._at = rows.nodes + np.array(numbers, dtype=np.int64)
        self._moments = np.array([shell.rigid[number].moment for number in numbers]).reshape(-1, 3)
        self._field, self._points = field, rows.points[self._at]
        spins = Pairs("omega", "omega", self._at, self._at)
        places = [
            Pairs(row, column, self._at, self._at) for row, column in (("u", "u"), ("u", "omega"), ("omega", "u"))
        ]
        super().__init__([spins] if field.is_uniform else [spins, *places], constraints)

    @property
    def present(self) -> bool:
        """Whether there are any."""
        return bool(self._at.size)

    def _values(self, state: State, loading: Loading) -> Values:
        if self._field.is_uniform:
            B = np.broadcast_to(loading.flux_density, (len(self._at), 3))
            return Values(B, np.zeros((len(self._at), 3, 3)), np.zeros((len(self._at), 3, 3, 3)))
        return self._field.at(loading.drives, self._points + state.u[self._at])

    def _turned(self, state: State) -> FloatArray:
        """R m (n, 3)."""
        return np.asarray(np.einsum("nij,nj->ni", rotation.matrix(state.q[self._at]), self._moments))

    def _of(self, state: State, values: Values) -> FloatArray:
        forces, m = np.zeros((len(state.u), COMPONENTS)), self._turned(state)
        forces[self._at, U] = np.einsum("ni,nij->nj", m, values.gradient)
        forces[self._at, OMEGA] = cross(m, values.flux_density)
        return forces

    def acting(self, state: State, loading: Loading) -> FloatArray:
        """Forces and couples (rows, 11) of the field, N and N m."""
        if not self.present:
            return np.zeros((len(state.u), COMPONENTS))
        return self._of(state, self._values(state, loading))

    def acting_in(self, state: State, field: Field, amounts: FloatArray) -> FloatArray:
        """The same in another field, for its amounts."""
        return self._of(state, field.at(amounts, self._points + state.u[self._at], second=False))

    def _forces(self, instant: Instant) -> FloatArray:
        return self.acting(instant.state, instant.loading)

    def _blocks(self, instant: Instant) -> Sequence[FloatArray]:
        values, m = self._values(instant.state, instant.loading), self._turned(instant.state)
        crossed = cross_matrix(m)
        spins = -cross_matrix(np.array(values.flux_density)) @ crossed
        if self._field.is_uniform:
            return [spins]
        assert values.second is not None
        turned = np.swapaxes(values.gradient, 1, 2) @ crossed
        return [spins, -np.einsum("ni,nijk->njk", m, values.second), turned, -crossed @ values.gradient]

    def _rates(self, instant: Instant, rate: Loading) -> FloatArray:
        if not self.present:
            return np.zeros((len(instant.state.u), COMPONENTS))
        if self._field.is_uniform:
            return self._of(instant.state, self._values(instant.state, rate))
        points = self._points + instant.state.u[self._at]
        return self._of(instant.state, self._field.rate(instant.loading.drives, rate.drives, points))

    def energy(self, state: State, loading: Loading) -> float:
        """-Σ R m · B, J."""
        if not self.present:
            return 0.0
        return -float(np.sum(self._turned(state) * self._values(state, loading).flux_density))
