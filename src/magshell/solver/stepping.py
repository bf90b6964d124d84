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
from magshell.solver.balance import balance
from magshell.solver.events import Iteration, Observer
from magshell.solver.newton import StepFailure, Trial, newton
from magshell.solver.path import Path, Step
from magshell.solver.settings import Settings

logger = logging.getLogger(__name__)

GROWTH, CUT = 2.5, 0.35


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
    """Step until the last stop; raises StepFailure with the reason."""
    settings, discretisation = path.settings, path.discretisation
    stops = path.model.field.stop_factors
    _keep(path, Step(0, 0.0, discretisation.undeformed(), 0, 0.0, None), observers)
    size = settings.first_step
    while path.steps[-1].load_factor < 1.0:
        last = path.steps[-1]
        stop = next(factor for factor in stops if factor > last.load_factor * (1.0 + 1e-12))
        left = stop - last.load_factor
        d_factor = left if size > 0.75 * left else min(size, 0.5 * left) if size > 0.5 * left else size
        load_factor = stop if d_factor == left else last.load_factor + d_factor

        def report(iteration: int, kind: str, residual: float, at: float = load_factor) -> None:
            path.solves += iteration > 0
            for observer in observers:
                seconds = time.perf_counter() - begin
                observer.iterated(Iteration(len(path.steps), at, iteration, residual, kind, seconds))

        try:
            trial = _predicted(path, load_factor)
            solution = newton(discretisation, linear_solver, trial, load_factor, settings, report)
        except (StepFailure, InvertedElement) as failure:
            reason = (
                str(failure) if isinstance(failure, StepFailure) else f"element {failure.element} is turned inside out"
            )
            path.cuts += 1
            for observer in observers:
                observer.cut(load_factor, reason)
            size = CUT * d_factor
            if size < settings.smallest_step:
                raise StepFailure(_give_up(path, load_factor, reason)) from None
            continue
        step = Step(
            len(path.steps), load_factor, solution.state, solution.solves, solution.residuals[-1],
            balance(discretisation, solution.state, load_factor, solution.assembly.residual),
        )  # fmt: skip
        _keep(path, step, observers)
        ratio = settings.target_iterations / max(solution.solves, 1)
        size = min(max(size, d_factor) * float(np.clip(ratio, 0.4, GROWTH)), settings.largest_step)


def _keep(path: Path, step: Step, observers: Sequence[Observer]) -> None:
    path.steps.append(step)
    for observer in observers:
        observer.converged(step)


def _predicted(path: Path, load_factor: float) -> Trial:
    """Trial state by extrapolation of the last converged steps, its stresses predicted linearly."""
    discretisation, steps = path.discretisation, path.steps
    last = steps[-1]
    if len(steps) == 1:
        imposed = discretisation.imposed(load_factor)
        return Trial(last.state, discretisation.stresses_at(last.state), imposed if np.any(imposed) else None)
    increment, d_alpha = _extrapolated(steps, load_factor)
    increment = discretisation.with_imposed(increment, load_factor - last.load_factor)
    return Trial(
        last.state.moved(increment, d_alpha),
        discretisation.predicted_stresses(last.state, increment, d_alpha),
        None,
    )


def _extrapolated(steps: list[Step], load_factor: float) -> tuple[FloatArray, FloatArray]:
    """Increment from the last state by the polynomial through up to four converged steps."""
    last = steps[-1]
    history = steps[-4:]
    t = [step.load_factor for step in history]
    total: FloatArray = np.zeros(())
    total_alpha: FloatArray = np.zeros(())
    for i, step in enumerate(history[:-1]):
        weight = np.prod([(load_factor - t[j]) / (t[i] - t[j]) for j in range(len(t)) if j != i])
        increment, d_alpha = step.state.increment_from(last.state)
        total = total + weight * increment
        total_alpha = total_alpha + weight * d_alpha
    return total, total_alpha


def _give_up(path: Path, load_factor: float, reason: str) -> str:
    magnitude = path.model.field.magnitude
    last = path.steps[-1].load_factor
    field = f" ({1e3 * last * magnitude:.4g} mT)" if magnitude > 0.0 else ""
    return (
        f"stopped at load factor {last:.6g}{field}: after {path.cuts} cut{'s' * (path.cuts != 1)} the step to "
        f"{load_factor:.6g} still fails: {reason}. Likely causes: a limit point or buckling (the path turns back), "
        "a mesh too coarse for the local bending, or a unit slip; `magshell check` shows the magnitudes"
    )
