r"""Where the path of a body begins that supports let turn and the field alone holds, as a compass needle.

Without a field every angle is an equilibrium, and the tangent is singular. In the weakest field the body has turned
already, as a whole, until its torque vanishes. With the residual r of a body turned rigidly by δθ about c,

    G = Σ (x - c) × r_u + d × r_w + r_ω,

the torque along the free axes a_i is g_i = a_i · G and vanishes there. It is driven to zero by steps -|H|⁻¹ g, with
H = ∂g/∂θ by differences and |H| of the magnitudes of its eigenvalues, so that the body turns the way that the torque
drives it, also where the torque falls with the angle. Each step is at most `LONGEST`.
"""

from __future__ import annotations

import logging

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Increment, Instant
from magshell.evaluation.reactions import moments_of
from magshell.model.course import Loading
from magshell.model.doubts.needles import UNSTABLE, unheld
from magshell.model.rigid import FreeTurn
from magshell.shell.rotation import exponential, matrix
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS
from magshell.solver.newton import StepFailure

logger = logging.getLogger(__name__)

# Of a step, rad: the longest, the one of the differences, and one that is round-off.
LONGEST, APART, ROUND_OFF = 0.5, 1e-3, 1e-11
MOST = 100
# Share of the largest stiffness below which a rotation is neutral.
NEUTRAL = 1e-7
# Of the size of the body: by how much a turned body may miss its supports.
MISSED = 1e-9


def turned(discretisation: Discretisation, loading: Loading) -> State:
    """The undeformed body, turned until nothing turns it any further.

    Parameters
    ----------
    discretisation : Discretisation
        Of a model with `turns`.
    loading : Loading
        What acts there.

    Raises
    ------
    StepFailure
        Nothing holds an angle, or the supports do not let the body turn as far.
    """
    state = discretisation.undeformed()
    for turn in discretisation.model.turns:
        state = _Turning(discretisation, loading, turn).settled(state)
    held = (discretisation.model.constraints.fixed & discretisation.carried)[:, COLUMNS["u"]]
    moved = np.pad(state.u, ((0, 0), (0, COMPONENTS - 3)))
    missed = np.abs(discretisation.to_frames(moved))[:, COLUMNS["u"]][held]
    if missed.max(initial=0.0) > MISSED * discretisation.mesh.size:
        raise StepFailure(
            "the supports let the body turn by a small angle only, and the field turns it further: a support holds "
            "points away from the axis. Hold the rotation, or clamp the body"
        )
    return state


class _Turning:
    """One part that turns about its point."""

    def __init__(self, discretisation: Discretisation, loading: Loading, turn: FreeTurn) -> None:
        self.discretisation, self.loading, self.turn = discretisation, loading, turn
        mine = np.isin(discretisation.rows.of, turn.places)
        self._carried = discretisation.rows.shared(discretisation.carried.copy()) & mine[:, None]

    def settled(self, state: State) -> State:
        """The state in which no torque is left."""
        for _ in range(MOST):
            (g, size), H = self._torque(state), self._slope(state)
            values, vectors = np.linalg.eigh(0.5 * (H + H.T))
            sizes, along = np.abs(values), vectors.T @ g
            scale = max(size, float(sizes.max()))
            if np.abs(g).max() <= NEUTRAL * scale and sizes.min() <= NEUTRAL * scale:
                raise StepFailure(unheld(self.turn.axes.T @ vectors[:, int(sizes.argmin())]))
            step = -vectors @ (along / np.maximum(sizes, NEUTRAL * scale))
            length = float(np.linalg.norm(step))
            if length <= ROUND_OFF:
                if values.min() < 0.0:
                    logger.warning(UNSTABLE)
                return state
            state = self._moved(state, step * min(1.0, LONGEST / length))
        raise StepFailure("the body that the field turns comes to no rest")

    def _torque(self, state: State) -> tuple[FloatArray, float]:
        """About the point along the free axes (n,), N m: minus what drives the body; and the sum of its magnitudes."""
        d, rows = self.discretisation, self.discretisation.rows
        r = np.where(self._carried, d.to_global(d.assemble(Instant(state, self.loading), tangent=False).residual), 0.0)
        arm, director = rows.points + state.u - self.turn.centre, rows.normals + state.w
        moments = moments_of(r, arm, director)
        return self.turn.axes @ moments.sum(axis=0), float(np.linalg.norm(moments, axis=1).sum())

    def _slope(self, state: State) -> FloatArray:
        """Derivative (n, n) of the torque."""
        steps = APART * np.eye(len(self.turn.axes))
        changes = [self._torque(self._moved(state, s))[0] - self._torque(self._moved(state, -s))[0] for s in steps]
        return np.stack(changes, axis=1) / (2.0 * APART)

    def _moved(self, state: State, angles: FloatArray) -> State:
        """The state, turned on by angles (n,) about the free axes."""
        rows, spin = self.discretisation.rows, angles @ self.turn.axes
        R = matrix(exponential(spin))
        arm, director = rows.points + state.u - self.turn.centre, rows.normals + state.w
        increment = np.zeros((len(arm), COMPONENTS))
        increment[:, COLUMNS["u"]], increment[:, COLUMNS["w"]] = arm @ R.T - arm, director @ R.T - director
        increment[:, COLUMNS["omega"]] = spin
        nodal = np.where(self._carried, increment, 0.0)
        return self.discretisation.moved(state, Increment(nodal, np.zeros_like(state.alpha)))
