"""Many problems solved at once, each in a process of its own.

A process sends back only steps and counts: the model and its equations are made again here, which is cheap.
"""

from __future__ import annotations

import multiprocessing
import signal
import threading
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from typing import TYPE_CHECKING, Any, NamedTuple

from magshell.equations.discretisation import Discretisation
from magshell.errors import InputError
from magshell.kernel_cache import FIRST_USE, log
from magshell.linalg import nested_dissection
from magshell.problem.building import build
from magshell.processes import cores, interrupts_wait
from magshell.shell.loops import are_compiled
from magshell.solver.critical import CriticalPoint
from magshell.solver.events import Iteration, Observer
from magshell.solver.path import Path, SolveError
from magshell.solver.step import Step
from magshell.solver.stepping import solve

if TYPE_CHECKING:
    from magshell.problem.schema import ProblemFile

Watcher = Callable[[str, float], None]
"""Told the name of a run and the load factor that it has reached."""


class Outcome(NamedTuple):
    """How a run ended: with a path, or with a reason why there is none."""

    name: str
    path: Path | None
    reason: str = ""


class _Solved(NamedTuple):
    """What a process sends back."""

    steps: list[Step]
    critical_points: list[CriticalPoint]
    reason: str
    solver_name: str
    solves: int
    cuts: int
    cpu_seconds: float


def solve_all(
    files: Mapping[str, ProblemFile], watch: Watcher, workers: int | None = None
) -> Generator[Outcome, None, None]:
    """Solve problems in parallel; outcomes come as they are ready.

    The smallest goes first and alone: where the kernels must be compiled, that happens once. Of the others the largest
    start first. If the consumer stops early, by Ctrl-C or otherwise, the runs end at their next iteration.

    Parameters
    ----------
    files : mapping of str to ProblemFile
    watch : callable
        Called from another thread with the name of a run and its load factor.
    workers : int, optional
        Processes; as many as there are cores without it.

    Yields
    ------
    Outcome
    """
    problems = {name: build(file, name) for name, file in files.items()}
    if not are_compiled():
        log.info(FIRST_USE)
    by_size = sorted(problems, key=lambda name: len(problems[name].model.shell.mesh.elements))
    context = multiprocessing.get_context("spawn")
    messages, stop = context.Queue(), context.Event()
    listener = threading.Thread(target=_listen, args=(messages, watch), daemon=True)
    listener.start()
    executor = ProcessPoolExecutor(
        min(workers or cores(), len(files)), context, initializer=_prepare, initargs=(messages, stop)
    )
    names: dict[Future[_Solved], str] = {}
    try:
        for group in (by_size[:1], by_size[:0:-1]):
            try:
                with interrupts_wait():
                    names = {executor.submit(_run, name, files[name]): name for name in group}
            except BrokenExecutor as error:
                yield from (Outcome(name, None, _words(error)) for name in group)
                continue
            waiting = set(names)
            while waiting:
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    yield _outcome(names[future], future, problems[names[future]])
    finally:
        stop.set()
        executor.shutdown(cancel_futures=True)
        messages.put(None)
        listener.join()


def _outcome(name: str, future: Future[_Solved], problem: Any) -> Outcome:
    error = future.exception()
    if error is not None:
        return Outcome(name, None, _words(error))
    solved = future.result()
    if solved.reason:
        return Outcome(name, None, solved.reason)
    discretisation = Discretisation(problem.model, nested_dissection)
    path = Path(
        problem.model, discretisation, problem.settings, solved.solver_name, solved.steps, [problem.model.course(0)],
        solved.critical_points, True, "the end of the path is reached", solved.solves, solved.cuts, solved.cpu_seconds,
    )  # fmt: skip
    return Outcome(name, path)


def _words(error: BaseException) -> str:
    return str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"


def _listen(messages: Any, watch: Watcher) -> None:
    while (message := messages.get()) is not None:
        watch(*message)


# -- in the processes ------------------------------------------------------------------------------------------------

_messages: Any = None
_stop: Any = None


def _prepare(messages: Any, stop: Any) -> None:
    global _messages, _stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _messages, _stop = messages, stop


class _Reporter(Observer):
    """Tells the parent how far a run is, and ends it when the parent asks for it."""

    def __init__(self, name: str) -> None:
        self._name = name

    def iterated(self, iteration: Iteration) -> None:
        if _stop.is_set():
            raise KeyboardInterrupt

    def converged(self, step: Step) -> None:
        _messages.put((self._name, step.load_factor))


def _run(name: str, file: ProblemFile) -> _Solved:
    problem = build(file, name)
    try:
        path = solve(problem.model, problem.settings, [_Reporter(name)])
        reason = ""
    except SolveError as error:
        path, reason = error.path, error.reason
    except KeyboardInterrupt:
        return _Solved([], [], "interrupted", "", 0, 0, 0.0)
    return _Solved(path.steps, path.critical_points, reason, path.solver_name, path.solves, path.cuts, path.cpu_seconds)
