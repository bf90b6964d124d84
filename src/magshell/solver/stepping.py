"""Load stepping: from the undeformed state to load factor 1, hitting every stop on the way."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.assembly import Discretisation, InvertedElement
from magshell.errors import SolveError
from magshell.linalg import LinearSolver, make_solver, nested_dissection
from magshell.model import Model
from magshell.solver.arc import Cylinder, distance
from magshell.solver.balance import balance
from magshell.solver.events import Iteration, Observer
from magshell.solver.newton import Solution, StepFailure, Trial, newton
from magshell.solver.path import Path, Step
from magshell.solver.settings import Settings

logger = logging.getLogger(__name__)

GROWTH, CUT = 2.5, 0.35
# Cuts in a row after which the load factor becomes an unknown, and steps that it may take to come back.
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
    begin, cpu = time.perf_counter(), time.process_time()
    try:
        for observer in observers:
            observer.started(discretisation, settings)
        _follow(path, linear_solver, observers, begin)
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


def _follow(path: Path, linear_solver: LinearSolver, observers: Sequence[Observer], begin: float) -> None:
    """Step until the last stop; raises StepFailure with the reason.

    Under load control, or by arc length from where that fails until the next stop is reached.
    """
    settings, discretisation = path.settings, path.discretisation
    stops = path.model.field.stop_factors
    _keep(path, Step(0, 0.0, discretisation.undeformed(), 0, 0.0, None, 0.0), observers)
    size, radius, in_a_row, wandered, reason = settings.first_step, 0.0, 0, 0, ""

    def attempt(trial: Trial, cylinder: Cylinder | None) -> bool:
        """Whether the step converged, and is kept; otherwise the observers know why not."""
        nonlocal reason

        def report(iteration: int, kind: str, residual: float) -> None:
            path.solves += iteration > 0
            for observer in observers:
                seconds = time.perf_counter() - begin
                observer.iterated(Iteration(len(path.steps), trial.load_factor, iteration, residual, kind, seconds))

        try:
            solution = newton(discretisation, linear_solver, trial, cylinder, settings, report)
            if cylinder is not None and _turns_back(path, solution):
                raise StepFailure("the path turns back on itself")
        except (StepFailure, InvertedElement) as failure:
            reason = (
                str(failure) if isinstance(failure, StepFailure) else f"element {failure.element} is turned inside out"
            )
            path.cuts += 1
            for observer in observers:
                observer.cut(trial.load_factor, reason)
            return False
        _keep(path, _step(path, solution), observers)
        return True

    while path.steps[-1].load_factor < 1.0:
        last = path.steps[-1]
        stop = next(factor for factor in stops if factor > last.load_factor * (1.0 + 1e-12))
        if radius > 0.0:
            trial = _along(path, last.arc_length + radius)
            across = trial.load_factor >= stop
            cylinder = None if across else _cylinder(path, trial)
            if attempt(_at_stop(path, radius, stop) if across else trial, cylinder):
                in_a_row, wandered = 0, wandered + 1
                radius = 0.0 if across else radius * _growth(path)
            else:
                radius *= CUT
            if radius > 0.0 and (radius < settings.smallest_step or wandered > WANDERING):
                raise StepFailure(_give_up(path, trial.load_factor, reason))
            size = abs(path.steps[-1].load_factor - path.steps[-2].load_factor)
            continue
        left = stop - last.load_factor
        d_factor = left if size > 0.75 * left else min(size, 0.5 * left) if size > 0.5 * left else size
        load_factor = stop if d_factor == left else last.load_factor + d_factor
        trial = _predicted(path, load_factor)
        if attempt(trial, None):
            in_a_row = 0
            size = min(max(size, d_factor) * _growth(path), settings.largest_step)
            continue
        size, in_a_row = CUT * d_factor, in_a_row + 1
        if len(path.steps) > 2 and (in_a_row == PATIENCE or size < settings.smallest_step):
            radius, wandered = 0.5 * (last.arc_length - path.steps[-2].arc_length), 0
        elif size < settings.smallest_step:
            raise StepFailure(_give_up(path, load_factor, reason))


def _growth(path: Path) -> float:
    """Factor of the step size after the solves that the last step took."""
    return float(np.clip(path.settings.target_iterations / max(path.steps[-1].iterations, 1), 0.4, GROWTH))


def _step(path: Path, solution: Solution) -> Step:
    last, discretisation = path.steps[-1], path.discretisation
    travelled = distance(last.state, solution.state, discretisation.mesh.size)
    return Step(
        len(path.steps), solution.load_factor, solution.state, solution.solves, solution.residuals[-1],
        balance(discretisation, solution.state, solution.load_factor, solution.assembly.residual),
        last.arc_length + travelled,
    )  # fmt: skip


def _turns_back(path: Path, solution: Solution) -> bool:
    """Whether a solution lies more than `SHARPEST` off the direction of the last step."""
    before, last = path.steps[-2].state, path.steps[-1].state
    old, new = last.u - before.u, solution.state.u - last.u
    return float(np.sum(old * new)) < np.cos(SHARPEST) * float(np.linalg.norm(old) * np.linalg.norm(new))


def _keep(path: Path, step: Step, observers: Sequence[Observer]) -> None:
    path.steps.append(step)
    for observer in observers:
        observer.converged(step)


def _predicted(path: Path, load_factor: float) -> Trial:
    """Trial state at a load factor, by extrapolation of the last converged steps, its stresses predicted linearly."""
    discretisation, steps = path.discretisation, path.steps
    last = steps[-1]
    if len(steps) == 1:
        imposed = discretisation.imposed(load_factor)
        return Trial(
            last.state, load_factor, discretisation.stresses_at(last.state), imposed if np.any(imposed) else None
        )
    weights = _weights([step.load_factor for step in steps[-4:]], load_factor)
    return _extrapolated(path, weights, load_factor)


def _along(path: Path, arc_length: float) -> Trial:
    """Trial state at a length of the path, by the same extrapolation, of the load factor too."""
    history = path.steps[-4:]
    weights = _weights([step.arc_length for step in history], arc_length)
    return _extrapolated(path, weights, float(weights @ [step.load_factor for step in history]))


def _at_stop(path: Path, radius: float, stop: float) -> Trial:
    """Trial state where the extrapolated path meets a stop, within a radius from the last state."""
    near, far = path.steps[-1].arc_length, path.steps[-1].arc_length + radius
    lengths, factors = [step.arc_length for step in path.steps[-4:]], [step.load_factor for step in path.steps[-4:]]
    for _ in range(60):
        middle = 0.5 * (near + far)
        near, far = (near, middle) if _weights(lengths, middle) @ factors >= stop else (middle, far)
    return _extrapolated(path, _weights(lengths, far), stop)


def _weights(nodes: list[float], at: float) -> FloatArray:
    """Of the values at up to four nodes, in the polynomial through them."""
    return np.array([np.prod([(at - u) / (t - u) for u in nodes if u != t]) for t in nodes])


def _extrapolated(path: Path, weights: FloatArray, load_factor: float) -> Trial:
    """The weighted sum of the last states, as increments from the last of them, at a load factor."""
    discretisation, last = path.discretisation, path.steps[-1]
    total: FloatArray = np.zeros(())
    total_alpha: FloatArray = np.zeros(())
    for weight, step in zip(weights[:-1], path.steps[-len(weights) : -1], strict=True):
        increment, d_alpha = step.state.increment_from(last.state)
        total = total + weight * increment
        total_alpha = total_alpha + weight * d_alpha
    total = discretisation.with_imposed(total, load_factor - last.load_factor)
    return Trial(
        last.state.moved(total, total_alpha),
        load_factor,
        discretisation.predicted_stresses(last.state, total, total_alpha),
        None,
    )


def _cylinder(path: Path, trial: Trial) -> Cylinder:
    """States as far from the last one as the trial state."""
    last = path.steps[-1].state
    return Cylinder(last.u, trial.state.u - last.u)


def _give_up(path: Path, load_factor: float, reason: str) -> str:
    magnitude = path.model.field.magnitude
    last = path.steps[-1].load_factor
    field = f" ({1e3 * last * magnitude:.4g} mT)" if magnitude > 0.0 else ""
    return (
        f"stopped at load factor {last:.6g}{field}: after {path.cuts} cut{'s' * (path.cuts != 1)} the step to "
        f"{load_factor:.6g} still fails: {reason}. Likely causes: a limit point or buckling (the path turns back), "
        "a mesh too coarse for the local bending, or a unit slip; `magshell check` shows the magnitudes"
    )
