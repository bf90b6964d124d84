"""Newton's method for one load factor, with the mixed-integration-point tangent.

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
from magshell.solver.settings import Settings

HALVINGS = 4
# An increment of so many body lengths or radians says that the tangent is singular to round-off.
ABSURD = 1e8


class StepFailure(ArithmeticError):
    """The iteration did not converge; the message says why."""


class Solution(NamedTuple):
    """A converged state: its assembly, linear solves spent, history of worst relative residuals."""

    state: State
    assembly: Assembly
    solves: int
    residuals: list[float]


class Trial(NamedTuple):
    """Where an iteration starts: state, stresses of the geometric part, and increments still to be imposed."""

    state: State
    stresses: Stresses
    imposed: FloatArray | None


def newton(
    discretisation: Discretisation,
    linear_solver: LinearSolver,
    trial: Trial,
    load_factor: float,
    settings: Settings,
    report: Callable[[int, str, float], None],
) -> Solution:
    """Solve for equilibrium at a load factor.

    Raises
    ------
    StepFailure
        No convergence, an inverted element, a singular tangent.
    """
    state, imposed = trial.state, trial.imposed
    residuals: list[float] = []
    assembly = _assemble(discretisation, trial, load_factor, settings)
    while True:
        kind, residual = assembly.worst
        residuals.append(residual)
        report(len(residuals) - 1, kind, residual)
        if not np.isfinite(residual):
            raise StepFailure("the residual is not finite")
        if residual <= settings.tolerance and imposed is None:
            return Solution(state, assembly, len(residuals) - 1, residuals)
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
        increment = discretisation.expand(linear_solver.solve(assembly.right_side), imposed)
        if _size(discretisation, increment).max() > ABSURD:
            raise StepFailure(_free_direction(discretisation, increment))
        d_alpha = discretisation.recover(increment)
        for halving in range(HALVINGS + 1):
            size = 0.5**halving
            trial = Trial(
                state.moved(size * increment, size * d_alpha),
                discretisation.predicted_stresses(state, size * increment, size * d_alpha),
                None if imposed is None or halving == 0 else (1.0 - size) * imposed,
            )
            try:
                assembly = _assemble(discretisation, trial, load_factor, settings)
                break
            except InvertedElement as inverted:
                if halving == HALVINGS:
                    raise StepFailure(_inverted(inverted)) from None
        state, imposed = trial.state, trial.imposed


def _assemble(discretisation: Discretisation, trial: Trial, load_factor: float, settings: Settings) -> Assembly:
    stresses = trial.stresses if settings.mixed_tangent else None
    return discretisation.assemble(trial.state, load_factor, stresses, trial.imposed)


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
