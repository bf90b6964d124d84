r"""Work along a path, summed by the trapezoidal rule over its steps.

From one step to the next, nodal forces f do the work

    ∫ f · dv ≈ ½ (f_before + f_after) · Δv,

with the increments Δv of u, w, φ and the micro-rotations' spins. Its error falls with the square of the steps' size.
In statics the elastic energy is the work of loads, supports and field, up to that error.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant, difference
from magshell.magnetics.law import is_conservative
from magshell.model.course import Loading
from magshell.shell.state import State


class Work(NamedTuple):
    """Work along the path, J.

    Attributes
    ----------
    applied : float
        Of the loads and of the supports that move.
    field : float or None
        Of the field; None where it has a potential, the magnetic energy.
    """

    applied: float
    field: float | None

    def plus(self, other: Work) -> Work:
        """The sum."""
        field = None if self.field is None or other.field is None else self.field + other.field
        return Work(self.applied + other.applied, field)


class Acting(NamedTuple):
    """Nodal forces that do work at a state, (rows, 11), global axes; of the field only where it has no potential."""

    state: State
    applied: FloatArray
    field: FloatArray | None


def no_work(discretisation: Discretisation) -> Work:
    """At the start of a path."""
    return Work(0.0, None if is_conservative(discretisation.model.coupling) else 0.0)


def acting(
    discretisation: Discretisation, state: State, loading: Loading, residual: FloatArray, supports: FloatArray
) -> Acting:
    """What does work at a state, with its residual (in the nodes' frames) and the supports' forces (global axes)."""
    applied = discretisation.loads.forces(state, loading.loads)
    applied += supports
    if is_conservative(discretisation.model.coupling):
        return Acting(state, applied, None)
    field = np.zeros_like(applied)
    if np.any(loading.drives):
        without = loading.without_field()
        others = discretisation.assemble(Instant(state, without), tangent=False).residual
        field = discretisation.to_global(others - residual)
    return Acting(state, applied, field)


def work_between(before: Acting, after: Acting) -> Work:
    """The work from one step to the next."""
    moved = difference(after.state, before.state).nodal
    field = None
    if before.field is not None and after.field is not None:
        field = 0.5 * float(np.vdot(before.field + after.field, moved))
    return Work(0.5 * float(np.vdot(before.applied + after.applied, moved)), field)
