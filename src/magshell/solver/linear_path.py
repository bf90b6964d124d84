r"""The linear path from a loaded state, and the mixed tangent along it.

With v' the increment per load factor by the tangent of the state (α condensed, recovered with it), the linear path is

    v(t) = v0 + t v',      S(t) = S0 + t S',      S' = U⁻¹ (C : U' - U' S0)  and the same for the couple stress,

its configuration and its stresses both of first order in t. The tangent K(t) is the *mixed* one: strains vary as the
configuration v(t) says, their second variation works on S(t), not on the stresses of that configuration,

    K(t) = ∫ B(v(t))ᵀ C B(v(t)) + G(S(t)) + loads.

For displacements alone B is linear in v, so K(t) is quadratic in t; rotations of nodes add a little. Why not the
stresses of v(t): a straight increment that turns the shell by θ stretches it by θ²/2, which the true path does not.
Times the stiffness of membrane and shear, that is as large as what buckles the shell. In the mixed tangent it never
enters (the reason why Newton's method takes it, `newton.py`). Nor may K(t) be cut off at first order: the square
t² B(v')ᵀ C B(v') would be missing, and with it that a stiff shell which turns stays stiff.

The path is measured by the part of its displacement gradient t F' F0⁻¹ that is symmetric (strain) and that is not
(rotation), both linear in t. These say how far the assumption holds, and in which unit t is counted: results do not
depend on the size of the reference load.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from magshell.equations.instant import Instant, Prediction, combined
from magshell.equations.term import FieldLost, InvertedElement
from magshell.linalg import Factorisation
from magshell.linalg.factorisation import scaled
from magshell.model.course import Loading
from magshell.shell.deformed import evaluate
from magshell.shell.state import State
from magshell.solver.newton import StepFailure, System, factorise

# Strain or rotation at s = 1, and the most that the scaled tangent may change up to there.
UNIT, CHANGE = 0.02, 0.1
# Strain or rotation at s = 1 that is round-off, and up to which the linear path is followed.
MOTIONLESS, REACH = 1e-9, 0.1
PASSES = 20


class LinearPath:
    """The linear path of a stage, at load factors t = s `unit`.

    Attributes
    ----------
    unit : float
    strain, rotation : float
        The largest in the shell at s = 1; rotation in rad.

    Raises
    ------
    StepFailure
        The tangent of the state is singular.
    """

    def __init__(self, system: System, state: State) -> None:
        self.system, self.state = system, state
        discretisation = system.discretisation
        self._start = Instant(state, system.course.at(0.0), system.predicted(state, 0.0))
        self._assembly = discretisation.assemble(self._start)
        factors = factorise(system, self._assembly)
        self.unit = 1.0
        for _ in range(2):  # twice: in a unit that suits the load, no digits are lost beside forces that are there
            self._advance(factors)
            self.strain, self.rotation = self._motion()
            if self.motion > 0.0:
                self.unit *= UNIT / self.motion
        self._advance(factors)
        self.strain, self.rotation = self._motion()
        self._stresses, self._stress_rate = self._along()
        self._fit()

    @property
    def motion(self) -> float:
        """Strain or rotation at s = 1, whichever is larger."""
        return max(self.strain, self.rotation)

    @property
    def reach(self) -> float:
        """Largest s for which the path stands for anything; infinite where nothing moves."""
        return REACH / self.motion if self.motion > MOTIONLESS else np.inf

    def tangent(self, s: float) -> sp.csc_array:
        """A copy of the mixed tangent at s.

        Raises
        ------
        StepFailure
            An element is turned inside out there.
        """
        stresses = combined([1.0, s], [self._stresses, self._stress_rate])
        state = self.system.discretisation.moved(self.state, s * self._increment)
        instant = Instant(state, self.system.course.at(s * self.unit), stresses)
        try:
            matrix = self.system.discretisation.assemble(instant).matrix
        except (InvertedElement, FieldLost) as inverted:
            raise StepFailure(f"element {inverted.element} is turned inside out on the linear path") from None
        assert matrix is not None
        return matrix.copy()

    def _advance(self, factors: Factorisation) -> None:
        """The increment at s = 1."""
        discretisation, course = self.system.discretisation, self.system.course
        rate = Loading(*(self.unit * one for one in course.rate(0.0)))
        direction = discretisation.load_direction(self._start, rate, self._assembly)
        self._increment = discretisation.direction(factors.solve(direction), discretisation.imposed(rate.held))

    def _motion(self) -> tuple[float, float]:
        """Largest strain and rotation of t F' F0⁻¹ at s = 1. (F is quadratic in s, so that the difference is exact.)"""
        discretisation, state = self.system.discretisation, self.state
        moved = (discretisation.moved(state, side * self._increment) for side in (1.0, -1.0))
        ahead, back = (evaluate(discretisation.reference, one).F for one in moved)
        gradient = 0.5 * (ahead - back) @ np.linalg.inv(evaluate(discretisation.reference, state).F)
        turned = np.swapaxes(gradient, -1, -2)
        strain, spin = 0.5 * (gradient + turned), 0.5 * (gradient - turned)
        return float(np.linalg.norm(strain, 2, (-2, -1)).max()), float(np.linalg.norm(spin, 2, (-2, -1)).max())

    def _along(self) -> tuple[Prediction, Prediction]:
        """Stresses of the state, and what they grow by up to s = 1."""
        now = self.system.predicted(self.state, 0.0)
        ahead = self.system.predicted(self.state, 0.0, self._increment)
        return now, combined([1.0, -1.0], [ahead, now])

    def _fit(self) -> None:
        """Make the unit one over which the loads change the tangent little, but not only by round-off."""
        start = self.tangent(0.0)
        scale = scaled(start).scale
        columns = np.repeat(scale, np.diff(start.indptr))
        for _ in range(PASSES):
            try:
                difference = np.abs((self.tangent(1.0).data - start.data) * scale[start.indices] * columns).max()
            except StepFailure:
                difference = 10.0 * CHANGE
            small = difference < 0.1 * CHANGE and self.motion <= MOTIONLESS
            if difference == 0.0 or not (difference > CHANGE or small):
                return
            self._stretch(0.5 * CHANGE / difference)

    def _stretch(self, factor: float) -> None:
        self.unit, self.strain, self.rotation = factor * self.unit, factor * self.strain, factor * self.rotation
        self._increment = factor * self._increment
        self._stress_rate = combined([factor], [self._stress_rate])
