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
from magshell.assembly import Assembly, Discretisation, InvertedElement
from magshell.linalg import LinearSolver, SingularMatrix
from magshell.shell.loops import Stresses
from magshell.shell.state import State
from magshell.solver.arc import Cylinder, NoRoot
from magshell.solver.settings import Settings

HALVINGS = 4
# An increment of so many body lengths or radians says that the tangent is singular to round-off.
ABSURD = 1e8


class StepFailure(ArithmeticError):
    """The iteration did not converge; the message says why."""


class Solution(NamedTuple):
    """A converged state: its assembly, linear solves spent, history of worst relative residuals."""

    state: State
    load_factor: float
    assembly: Assembly
    solves: int
    residuals: list[float]


class Trial(NamedTuple):
    """Where an iteration is: state, load factor, stresses of the geometric part, increments still to be imposed."""

    state: State
    load_factor: float
    stresses: Stresses
    imposed: FloatArray | None


def newton(
    discretisation: Discretisation,
    linear_solver: LinearSolver,
    trial: Trial,
    cylinder: Cylinder | None,
    settings: Settings,
    report: Callable[[int, str, float], None],
) -> Solution:
    """Solve for equilibrium at the trial's load factor or, with a cylinder, on it at a load factor that is found.

    Raises
    ------
    StepFailure
        No convergence, an inverted element, a singular tangent.
    """
    residuals: list[float] = []
    try:
        assembly = _assemble(discretisation, trial, settings)
    except InvertedElement as inverted:
        raise StepFailure(_inverted(inverted)) from None
    while True:
        kind, residual = assembly.worst
        residuals.append(residual)
        report(len(residuals) - 1, kind, residual)
        if not np.isfinite(residual):
            raise StepFailure("the residual is not finite")
        if residual <= settings.tolerance and trial.imposed is None:
            return Solution(trial.state, trial.load_factor, assembly, len(residuals) - 1, residuals)
        if len(residuals) > settings.max_iterations:
            raise StepFailure(
                f"no convergence in {settings.max_iterations} iterations (residual of {kind}: {residual:.1e})"
            )
        if len(residuals) > 6 and residual > 1e3 * min(residuals):
            raise StepFailure(f"the iteration diverges (residual of {kind}: {residual:.1e})")
        assert assembly.matrix is not None
        try:
            linear_solver.factorise(assembly.matrix)
        except SingularMatrix as singular:
            direction = discretisation.expand(singular.null_vector)
            raise StepFailure(_free_direction(discretisation, direction)) from None
        increment = discretisation.expand(linear_solver.solve(assembly.right_side), trial.imposed)
        d_load = 0.0
        if cylinder is not None:
            stresses = _geometric(trial, settings)
            direction = discretisation.load_direction(trial.state, trial.load_factor, stresses, assembly.residual)
            per_load = discretisation.expand(linear_solver.solve(direction), discretisation.imposed(1.0))
            try:
                d_load = cylinder.d_load(trial.state, increment, per_load)
            except NoRoot:
                raise StepFailure("the increment misses the arc length") from None
            increment = increment + d_load * per_load
        if _size(discretisation, increment).max() > ABSURD:
            raise StepFailure(_free_direction(discretisation, increment))
        d_alpha = discretisation.recover(increment)
        start = trial
        for halving in range(HALVINGS + 1):
            size = 0.5**halving
            trial = Trial(
                start.state.moved(size * increment, size * d_alpha),
                start.load_factor + size * d_load,
                discretisation.predicted_stresses(start.state, size * increment, size * d_alpha),
                None if start.imposed is None or halving == 0 else (1.0 - size) * start.imposed,
            )
            try:
                assembly = _assemble(discretisation, trial, settings)
                break
            except InvertedElement as inverted:
                if halving == HALVINGS:
                    raise StepFailure(_inverted(inverted)) from None


def _assemble(discretisation: Discretisation, trial: Trial, settings: Settings) -> Assembly:
    return discretisation.assemble(trial.state, trial.load_factor, _geometric(trial, settings), trial.imposed)


def _geometric(trial: Trial, settings: Settings) -> Stresses | None:
    """Stresses of the geometric part; None: the state's own."""
    return trial.stresses if settings.mixed_tangent else None


def _inverted(inverted: InvertedElement) -> str:
    return f"element {inverted.element} is turned inside out (det F = {inverted.determinant:.2g})"


def _size(discretisation: Discretisation, increment: FloatArray) -> FloatArray:
    """Magnitudes (nodes, 10) of an increment in body lengths, directors, thickness ratios and radians."""
    thickness = discretisation.model.shell.thickness
    units = np.array([discretisation.mesh.size] * 3 + [1.0] * 3 + [1.0 / thickness] + [1.0] * 3)
    return np.abs(increment) / units


def _free_direction(discretisation: Discretisation, direction: FloatArray) -> str:
    node, column = np.unravel_index(np.argmax(_size(discretisation, direction)), direction.shape)
    name = ("u1", "u2", "u3", "w1", "w2", "w3", "phi", "omega1", "omega2", "omega3")[column]
    position = ", ".join(f"{1e3 * x:.4g}" for x in discretisation.mesh.points[node])
    return f"the tangent is singular; the free direction is largest in {name} of node {node} at ({position}) mm"
