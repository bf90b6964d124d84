r"""Magnetic moments of rigid bodies as a term of the equations.

A dipole m turns with the body, R m, at its reference point x. Its energy -R m · B(x) gives the couple R m × B and the
force f_j = (R m)_i ∂B_i/∂x_j. Of the energy in the body's own field (`own_field.py`) half counts; the tangent is that
of a field which stays, as in the shell.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.instant import Instant
from magshell.equations.loads import NodalTerm
from magshell.equations.magnets import Magnets
from magshell.equations.own_field import Own, OwnField
from magshell.magnetics.fields import Field, Values
from magshell.magnetics.fields.own import own_multiplier
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.loads import Pairs
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA, U
from magshell.shell.rotation import cross
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS


class DipoleTerm(NodalTerm):
    """Minus what the field exerts on the magnetic moments of rigid bodies.

    Parameters
    ----------
    magnets : Magnets
    field : Field
    own : OwnField or None
        What the body itself makes, where the field has that as a part.
    constraints : Constraints
    """

    def __init__(self, magnets: Magnets, field: Field, own: OwnField | None, constraints: Constraints) -> None:
        self._magnets, self._at = magnets, magnets.rows
        self._field, self._own = field, own
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
        """The external field."""
        if self._field.is_uniform:
            B = np.broadcast_to(loading.flux_density, (len(self._at), 3))
            return Values(B, np.zeros((len(self._at), 3, 3)), np.zeros((len(self._at), 3, 3, 3)))
        return self._field.at(loading.drives, self._magnets.positions(state))

    def _with_own(self, values: Values, state: State, multiplier: float) -> Values:
        """With a multiple of the body's own field."""
        if self._own is None or not multiplier:
            return values
        own = self._own.at(state)
        return values._replace(
            flux_density=values.flux_density + multiplier * own.at_magnets,
            gradient=values.gradient + multiplier * own.slopes_at_magnets,
        )

    def _of(self, state: State, values: Values) -> FloatArray:
        forces, m = np.zeros((len(state.u), COMPONENTS)), self._magnets.turned(state)
        forces[self._at, U] = np.einsum("ni,nij->nj", m, values.gradient)
        forces[self._at, OMEGA] = cross(m, values.flux_density)
        return forces

    def acting(self, state: State, loading: Loading) -> FloatArray:
        """Forces and couples (rows, 11) of the field, N and N m."""
        if not self.present:
            return np.zeros((len(state.u), COMPONENTS))
        multiplier = own_multiplier(self._field, loading.drives)
        return self._of(state, self._with_own(self._values(state, loading), state, multiplier))

    def acting_in(self, state: State, field: Field, amounts: FloatArray) -> FloatArray:
        """The same in another field, for its amounts."""
        return self._of(state, field.at(amounts, self._magnets.positions(state), second=False))

    def _forces(self, instant: Instant) -> FloatArray:
        return self.acting(instant.state, instant.loading)

    def _blocks(self, instant: Instant) -> Sequence[FloatArray]:
        multiplier = own_multiplier(self._field, instant.loading.drives)
        values = self._with_own(self._values(instant.state, instant.loading), instant.state, multiplier)
        m = self._magnets.turned(instant.state)
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
        values = self._field.rate(instant.loading.drives, rate.drives, self._magnets.positions(instant.state))
        multiplier = own_multiplier(self._field, rate.drives)
        return self._of(instant.state, self._with_own(values, instant.state, multiplier))

    def own_rate(self, instant: Instant, change: Own, multiplier: float) -> FloatArray:
        """Derivative of the residual (rows, 11) along a multiple of a change of the body's own field, global axes."""
        values = Values(multiplier * change.at_magnets, multiplier * change.slopes_at_magnets, None)
        return -self._of(instant.state, values)

    def energy(self, state: State, loading: Loading) -> float:
        """-Σ R m · (B + ½ B_own), J."""
        if not self.present:
            return 0.0
        half = 0.5 * own_multiplier(self._field, loading.drives)
        B = self._with_own(self._values(state, loading), state, half).flux_density
        return -float(np.sum(self._magnets.turned(state) * B))
