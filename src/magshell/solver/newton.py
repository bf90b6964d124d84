"""Newton's method for one step, with the mixed-integration-point tangent.

The geometric part of the tangent is made with the stresses that the last iteration predicted linearly,
S' = S + C ΔU, in place of those of the new state (Magisano, Leonetti and Garcea, Comput. Methods Appl. Mech. Engrg.
313, 2017). The residual is exact, so the solution is the same; thin bending converges in a few large steps because
the membrane stresses of a trial state, large and meaningless, never enter the tangent.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Assembly, Discretisation
from magshell.equations.instant import Increment, Instant, Prediction
from magshell.equations.term import FieldLost, InvertedElement
from magshell.linalg import Factorisation, LinearSolver, SingularMatrix
from magshell.model.course import Course
from magshell.shell.state import State
from magshell.solver.constraints import Constraint, NoRoot
from magshell.solver.extension import beyond
from magshell.solver.settings import Settings

HALVINGS = 4
# Residual below which an iteration that no longer converges has met round-off (very thin shells on graded meshes).
ROUND_OFF = 1e-5
# An increment of so many body lengths or radians says that the tangent is singular to round-off.
ABSURD = 1e8
# Of GMRES: the residual that it leaves, and its largest number of vectors.
FORCING, MOST_VECTORS = 1e-5, 60


class StepFailure(ArithmeticError):
    """The iteration did not converge; the message says why, `inverted` which element it turned inside out."""

    def __init__(self, message: str, inverted: int | None = None) -> None:
        super().__init__(message)
        self.inverted = inverted


class Trial(NamedTuple):
    """Where an iteration is: state, load factor, and what the mixed tangent takes of the state."""

    state: State
    load_factor: float
    prediction: Prediction


class Solution(NamedTuple):
    """A converged trial.

    Attributes
    ----------
    trial : Trial
    assembly : Assembly
    residuals : list of float
        The worst relative one before each iteration and at the end.
    increment : Increment or None
        The last one: this far from the state is that of the tangent which was factorised.
    factors : Factorisation or None
        Of that tangent; None: none was needed.
    """

    trial: Trial
    assembly: Assembly
    residuals: list[float]
    increment: Increment | None
    factors: Factorisation | None

    @property
    def solves(self) -> int:
        """Linear solves spent."""
        return len(self.residuals) - 1


class System(NamedTuple):
    """The equations of a stage, and what solves them."""

    discretisation: Discretisation
    linear_solver: LinearSolver
    course: Course
    settings: Settings

    def instant(self, trial: Trial) -> Instant:
        """What the equations are evaluated at."""
        prediction = trial.prediction if self.settings.mixed_tangent else None
        return Instant(trial.state, self.course.at(trial.load_factor), prediction)

    def assemble(self, trial: Trial) -> Assembly:
        """Residual and tangent."""
        return self.discretisation.assemble(self.instant(trial))

    def predicted(self, state: State, load_factor: float, increment: Increment | None = None) -> Prediction:
        """What the mixed tangent takes of a state after an increment; by default of the state itself."""
        return self.discretisation.predicted(Instant(state, self.course.at(load_factor)), increment)

    def per_load(self, trial: Trial, assembly: Assembly, factors: Factorisation) -> Increment:
        """Increment per load factor, by the factors of a tangent."""
        discretisation, rate = self.discretisation, self.course.rate(trial.load_factor)
        direction = discretisation.load_direction(self.instant(trial), rate, assembly)
        solution = self.solved(trial, factors, direction)
        return discretisation.direction(solution, discretisation.imposed(rate.held))

    def solved(self, trial: Trial, factors: Factorisation, right_side: FloatArray) -> FloatArray:
        """Solution (dofs,) of the derivative of the residual, with the factors of the tangent.

        Where that leaves something out, by GMRES with these factors as preconditioner.

        Raises
        ------
        StepFailure
            The body's own field is not known beside the trial.
        """
        discretisation = self.discretisation
        first = factors.solve(right_side)
        if discretisation.exact_tangent or not np.isfinite(first).all():
            return first
        from scipy.sparse.linalg import LinearOperator, gmres

        units, instant = discretisation.units, self.instant(trial)

        def product(scaled: FloatArray) -> FloatArray:
            change = discretisation.left_out(instant, discretisation.direction(units * scaled))
            return scaled + factors.solve(change) / units

        operator = LinearOperator((discretisation.dofs, discretisation.dofs), product, dtype=float)
        try:
            found, _ = gmres(operator, first / units, rtol=FORCING, restart=MOST_VECTORS, maxiter=1)
            return np.asarray(units * found)
        except (InvertedElement, FieldLost) as failure:
            raise _failed(failure) from None


def newton(
    system: System,
    trial: Trial,
    constraint: Constraint | None,
    report: Callable[[int, str, float], None],
) -> Solution:
    """Solve for equilibrium at the trial's load factor or, with a constraint, at one that is found.

    Raises
    ------
    StepFailure
        No convergence, an inverted element, a singular tangent.
    """
    discretisation, settings = system.discretisation, system.settings
    residuals: list[float] = []
    increment: Increment | None = None
    factors: Factorisation | None = None
    try:
        assembly = system.assemble(trial)
    except (InvertedElement, FieldLost) as failure:
        raise _failed(failure) from None
    while True:
        kind, residual = assembly.worst
        residuals.append(residual)
        report(len(residuals) - 1, kind, residual)
        if not np.isfinite(residual):
            raise StepFailure(f"the residual is not finite{beyond(discretisation, trial.state)}")
        if residual <= settings.tolerance or _stalled(residuals):
            return Solution(trial, assembly, residuals, increment, factors)
        if len(residuals) > settings.max_iterations:
            raise StepFailure(
                f"no convergence in {settings.max_iterations} iterations (residual of {kind}: {residual:.1e})"
            )
        if len(residuals) > 6 and residual > 1e3 * min(residuals):
            raise StepFailure(f"the iteration diverges (residual of {kind}: {residual:.1e})")
        factors = None  # two sets of factors at a time would be twice the memory
        factors = factorise(system, assembly)
        increment = discretisation.correction(system.solved(trial, factors, assembly.right_side))
        d_load = 0.0
        if constraint is not None:
            per_load = system.per_load(trial, assembly, factors)
            try:
                d_load = constraint.d_load(trial.state, trial.load_factor, increment.u, per_load.u)
            except NoRoot as miss:
                raise StepFailure(str(miss)) from None
            increment = increment + d_load * per_load
        if discretisation.largest(increment)[0] > ABSURD:
            raise StepFailure(_free_direction(discretisation, increment))
        start = trial
        for halving in range(HALVINGS + 1):
            size = 0.5**halving
            trial = Trial(
                discretisation.moved(start.state, size * increment),
                start.load_factor + size * d_load,
                system.predicted(start.state, start.load_factor, size * increment),
            )
            try:
                assembly = system.assemble(trial)
                if np.isfinite(assembly.worst[1]):
                    break
            except (InvertedElement, FieldLost) as failure:
                if halving == HALVINGS:
                    raise _failed(failure) from None


def _stalled(residuals: list[float]) -> bool:
    """Whether round-off has stopped the iteration, which converges quadratically until there."""
    return len(residuals) > 2 and max(residuals[-3:]) < ROUND_OFF and residuals[-1] > 0.1 * residuals[-3]


def factorise(system: System, assembly: Assembly) -> Factorisation:
    """Factorise the tangent.

    Raises
    ------
    StepFailure
        It is singular; the message says in which direction.
    """
    assert assembly.matrix is not None
    try:
        return system.linear_solver.factorise(assembly.matrix)
    except SingularMatrix as singular:
        direction = system.discretisation.direction(singular.null_vector)
        raise StepFailure(_free_direction(system.discretisation, direction)) from None


def _failed(failure: InvertedElement | FieldLost) -> StepFailure:
    if isinstance(failure, FieldLost):
        where = "the field" if failure.element is None else f"the field at element {failure.element}"
        return StepFailure(f"{where}: {failure.why}", failure.element)
    element, determinant = failure.element, failure.determinant
    if determinant == 0.0:
        return StepFailure(f"the inner unknowns of element {element} cannot be eliminated")
    return StepFailure(f"element {element} is turned inside out (det F = {determinant:.2g})", element)


def _free_direction(discretisation: Discretisation, direction: Increment) -> str:
    return f"the tangent is singular; the free direction is largest in {discretisation.largest(direction)[1]}"
