"""`solve`: the whole path of a model, from the undeformed state to the end of its last stage."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence

from magshell.arguments import instance
from magshell.equations.discretisation import Discretisation
from magshell.linalg import make_solver, nested_dissection
from magshell.model.model import Model
from magshell.solver.events import Observer
from magshell.solver.follower import Follower
from magshell.solver.newton import StepFailure, System
from magshell.solver.path import Path, SolveError
from magshell.solver.settings import Settings

logger = logging.getLogger(__name__)


def solve(model: Model, settings: Settings | None = None, observers: Sequence[Observer] = ()) -> Path:
    """Follow the model's load path.

    Parameters
    ----------
    model : Model
    settings : Settings, optional
    observers : sequence of Observer
        Told of every iteration, step and critical point, for instance writers of files.

    Returns
    -------
    Path
        All converged steps, the undeformed state first.

    Raises
    ------
    SolveError
        The path cannot be followed to its end; `.reason` says why, `.path` holds every converged step.
    """
    instance("solve: model", model, Model, "a Model")
    settings = Settings() if settings is None else settings
    instance("solve: settings", settings, Settings, "Settings, as ms.Settings(tolerance=1e-9)")
    linear_solver = make_solver(settings.linear_solver)
    return resume(Path(model, Discretisation(model, nested_dissection), settings, linear_solver.name), observers)


def resume(path: Path, observers: Sequence[Observer] = ()) -> Path:
    """Go on with a path where its last step left it.

    Where the linear solver repeats its results (all but PARDISO), every step after it is the same to the last bit as if
    the path had never been left.

    Parameters
    ----------
    path : Path
        Of a results folder (`magshell.results.read`), or one that was interrupted; it is lengthened.
    observers : sequence of Observer
        Told of the steps so far by `Observer.resumed`.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    SolveError
        As by `solve`.
    InputError
        Another thread goes on with the path.
    """
    with path.solving():
        return _resumed(path, observers)


def _resumed(path: Path, observers: Sequence[Observer]) -> Path:
    model, discretisation, settings = path.model, path.discretisation, path.settings
    linear_solver = make_solver(settings.linear_solver)
    logger.info("%d unknowns, linear solver: %s", discretisation.dofs, linear_solver.name)
    cpu = time.process_time() - path.cpu_seconds
    try:
        for observer in observers:
            if path.steps:
                observer.resumed(path)
            else:
                observer.started(discretisation, settings)
        system = System(discretisation, linear_solver, model.course(0), settings)
        Follower(path, system, observers).run(len(model.stages))
        path.end()
    except StepFailure as failure:
        path.reason = str(failure)
        raise SolveError(path.reason, path) from None
    except KeyboardInterrupt:
        path.reason = "interrupted"
        raise
    finally:
        path.cpu_seconds = time.process_time() - cpu
        path.solves = linear_solver.factorisations
        for observer in observers:
            observer.finished(path)
    return path
