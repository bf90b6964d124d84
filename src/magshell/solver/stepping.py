"""Load stepping: from the undeformed state to load factor 1, hitting every stop on the way."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence

import numpy as np

from magshell.assembly import Discretisation
from magshell.errors import SolveError
from magshell.linalg import LinearSolver, make_solver, nested_dissection
from magshell.model import Model
from magshell.solver.arc import Cylinder, distance
from magshell.solver.balance import balance
from magshell.solver.events import Iteration, Observer
from magshell.solver.newton import Solution, StepFailure, Trial, newton
from magshell.solver.path import Path, Step
from magshell.solver.prediction import along, at_stop, predicted
from magshell.solver.settings import Settings

logger = logging.getLogger(__name__)

GROWTH, CUT = 2.5, 0.35
# Cuts in a row after which the load factor becomes an unknown, and steps that it may take to reach the next stop.
PATIENCE, WANDERING = 4, 400
# Largest angle between two steps by arc length: beyond it the path has been left, or run back.
SHARPEST = np.pi / 3


def solve(model: Model, settings: Settings | None = None, observers: Sequence[Observer] = ()) -> Path:
    """Follow the model's load path.

    Parameters
    ----------
    model : Model
    settings : Settings, optional
    observers : sequence of Observer
        Told of every iteration and step, for instance writers of files.

    Returns
    -------
    Path
        All converged steps, the undeformed state first.

    Raises
    ------
    SolveError
        The path cannot be followed to its end; `.reason` says why, `.path` holds every converged step.
    """
    settings = settings or Settings()
    linear_solver = make_solver(settings.linear_solver)
    discretisation = Discretisation(model, nested_dissection)
    path = Path(model, discretisation, settings, linear_solver.name)
    logger.info("%d unknowns, linear solver: %s", discretisation.dofs, linear_solver.name)
    cpu = time.process_time()
    try:
        for observer in observers:
            observer.started(discretisation, settings)
        _Follower(path, linear_solver, observers).run()
        path.converged, path.reason = True, "load factor 1 reached"
    except StepFailure as failure:
        path.reason = str(failure)
        raise SolveError(path.reason, path) from None
    except KeyboardInterrupt:
        path.reason = "interrupted"
        raise
    finally:
        path.cpu_seconds = time.process_time() - cpu
        for observer in observers:
            observer.finished(path)
    return path


class _Follower:
    """Steps until the last stop: under load control, or by arc length from where that fails until the next stop."""

    def __init__(self, path: Path, linear_solver: LinearSolver, observers: Sequence[Observer]) -> None:
        self.path, self.linear_solver, self.observers = path, linear_solver, observers
        self.settings, self.discretisation = path.settings, path.discretisation
        self.size, self.radius = self.settings.first_step, 0.0
        self.cuts_in_a_row, self.steps_by_arc = 0, 0
        self.reason = ""
        self.begin = time.perf_counter()

    def run(self) -> None:
        """Follow the path; raises StepFailure with the reason."""
        self._keep(Step(0, 0.0, self.discretisation.undeformed(), 0, 0.0, None, 0.0))
        for stop in self.path.model.field.stop_factors:
            while self.path.steps[-1].load_factor != stop:
                if self.radius > 0.0:
                    self._step_by_arc(stop)
                else:
                    self._step_by_load(stop)

    def _step_by_load(self, stop: float) -> None:
        last = self.path.steps[-1]
        left = stop - last.load_factor
        size = self.size
        d_factor = left if size > 0.75 * left else min(size, 0.5 * left) if size > 0.5 * left else size
        load_factor = stop if d_factor == left else last.load_factor + d_factor
        if self._converges(predicted(self.path, load_factor), None):
            self.cuts_in_a_row = 0
            self.size = min(max(size, d_factor) * self._growth(), self.settings.largest_step)
            return
        self.size, self.cuts_in_a_row = CUT * d_factor, self.cuts_in_a_row + 1
        too_small = self.size < self.settings.smallest_step
        if len(self.path.steps) > 2 and (self.cuts_in_a_row == PATIENCE or too_small):
            self.radius, self.steps_by_arc = 0.5 * (last.arc_length - self.path.steps[-2].arc_length), 0
        elif too_small:
            raise StepFailure(_give_up(self.path, load_factor, self.reason))

    def _step_by_arc(self, stop: float) -> None:
        last = self.path.steps[-1]
        trial = along(self.path, last.arc_length + self.radius)
        if trial.load_factor >= stop:
            if self._converges(at_stop(self.path, self.radius, stop), None):
                self.radius, self.cuts_in_a_row = 0.0, 0
                self.size = max(stop - last.load_factor, self.settings.smallest_step)
                return
            self.radius *= CUT
        elif self._converges(trial, Cylinder(last.state.u, trial.state.u - last.state.u)):
            self.radius *= self._growth()
        else:
            self.radius *= CUT
        self.steps_by_arc += 1
        if self.steps_by_arc > WANDERING:
            self.reason = f"{WANDERING} steps by arc length do not lead to the next stop"
        elif self.radius >= self.settings.smallest_step:
            return
        raise StepFailure(_give_up(self.path, trial.load_factor, self.reason))

    def _converges(self, trial: Trial, cylinder: Cylinder | None) -> bool:
        """Whether the step converged, and is kept; otherwise the observers know why not."""
        try:
            solution = newton(
                self.discretisation, self.linear_solver, trial, cylinder, self.settings,
                lambda iteration, kind, residual: self._report(trial, iteration, kind, residual),
            )  # fmt: skip
            if cylinder is not None and self._turns_back(solution):
                raise StepFailure("the path turns back on itself")
        except StepFailure as failure:
            self.reason = str(failure)
            self.path.cuts += 1
            for observer in self.observers:
                observer.cut(trial.load_factor, self.reason)
            return False
        last = self.path.steps[-1]
        step = Step(
            len(self.path.steps), solution.load_factor, solution.state, solution.solves, solution.residuals[-1],
            balance(self.discretisation, solution.state, solution.load_factor, solution.assembly.residual),
            last.arc_length + distance(last.state, solution.state, self.discretisation.mesh.size),
        )  # fmt: skip
        self._keep(step)
        return True

    def _report(self, trial: Trial, iteration: int, kind: str, residual: float) -> None:
        self.path.solves += iteration > 0
        seconds = time.perf_counter() - self.begin
        for observer in self.observers:
            observer.iterated(Iteration(len(self.path.steps), trial.load_factor, iteration, residual, kind, seconds))

    def _keep(self, step: Step) -> None:
        self.path.steps.append(step)
        for observer in self.observers:
            observer.converged(step)

    def _growth(self) -> float:
        """Factor of the step size after the solves that the last step took."""
        return float(np.clip(self.settings.target_iterations / max(self.path.steps[-1].iterations, 1), 0.4, GROWTH))

    def _turns_back(self, solution: Solution) -> bool:
        """Whether a solution lies more than `SHARPEST` off the direction of the last step."""
        before, last = self.path.steps[-2].state, self.path.steps[-1].state
        old, new = last.u - before.u, solution.state.u - last.u
        return float(np.sum(old * new)) < np.cos(SHARPEST) * float(np.linalg.norm(old) * np.linalg.norm(new))


def _give_up(path: Path, load_factor: float, reason: str) -> str:
    magnitude = path.model.field.magnitude
    last = path.steps[-1].load_factor
    field = f" ({1e3 * last * magnitude:.4g} mT)" if magnitude > 0.0 else ""
    return (
        f"stopped at load factor {last:.6g}{field}: after {path.cuts} cut{'s' * (path.cuts != 1)} the step to "
        f"{load_factor:.6g} still fails: {reason}. Likely causes: a limit point or buckling (the path turns back), "
        "a mesh too coarse for the local bending, or a unit slip; `magshell check` shows the magnitudes"
    )
