"""Solves one at a time, with its CPU time, and keeps what is finished in a small file."""

from __future__ import annotations

import hashlib
import json
import pathlib
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.files import write_atomically
from magshell.linalg import make_solver, nested_dissection
from magshell.solver.newton import StepFailure, System, Trial, newton
from magshell.solver.path import Path

ROOT = pathlib.Path(__file__).parents[2]
CACHE = ROOT / "results" / "element-study" / "runs.json"
REPEATS, QUICK = 3, 2.0
"""What a run does in less than so many seconds is made so many times; the least time counts."""


class Run(NamedTuple):
    """A solve.

    Attributes
    ----------
    unknowns : int
    loads : list of float
        Load factors that were hit.
    displacements : dict of str to list of (3,)
        Of each probe, at these loads, m.
    cpu : list of float
        From the start of the solve to each of these loads, s.
    solves : int
        Linear solves, in all.
    reason : str
        Why the path ended early; "" where it did not.
    """

    unknowns: int
    loads: list[float]
    displacements: dict[str, list[list[float]]]
    cpu: list[float]
    solves: int
    reason: str


class Enough(Exception):
    """The load is reached up to which a repeated run is wanted."""


class Clock(ms.Observer):
    """CPU time from the start of a solve to each converged step; raises `Enough` at a load."""

    def __init__(self, last: float = np.inf) -> None:
        self.last = last
        self.loads: list[float] = []
        self.seconds: list[float] = []

    def started(self, discretisation: Any, settings: Any) -> None:
        self.begin = time.process_time()

    def converged(self, step: Any) -> None:
        self.loads.append(step.load_factor)
        self.seconds.append(time.process_time() - self.begin)
        if step.load_factor >= self.last:
            raise Enough

    def at(self, loads: Sequence[float]) -> list[float]:
        """Seconds to each of some loads that were hit."""
        return [self.seconds[int(np.argmin(np.abs(np.array(self.loads) - load)))] for load in loads]


class Store:
    """Finished runs by name, in a file that is rewritten after each; those of other sources are forgotten."""

    def __init__(self, file: pathlib.Path = CACHE) -> None:
        self.file, self.sources = file, _digest()
        self.entries: dict[str, Any] = {}
        if file.exists():
            kept = json.loads(file.read_text(encoding="utf-8"))
            if kept["sources"] == self.sources:
                self.entries = kept["entries"]

    def get(self, name: str, make: Callable[[], Any]) -> Any:
        """The entry, made now if it is not there."""
        if name not in self.entries:
            self.entries[name] = make()
            self.file.parent.mkdir(parents=True, exist_ok=True)
            content = json.dumps({"sources": self.sources, "entries": self.entries}, indent=1)
            write_atomically(self.file, content.encode())
        return self.entries[name]


def _digest() -> str:
    """Of every source that a solve is made of."""
    package = ROOT / "src" / "magshell"
    folders = ("shell", "materials", "magnetics", "mesh", "model", "equations", "evaluation", "linalg", "solver")
    folders += ("problem/examples",)
    files = [file for folder in folders for file in (package / folder).rglob("*") if file.suffix in (".py", ".toml")]
    files += [file for file in package.glob("*.py") if file.name not in ("__main__.py", "cli.py", "progress.py")]
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def run(
    model: Callable[[], ms.Model], stops: Sequence[float], released: Callable[[], ms.Model] | None = None
) -> dict[str, Any]:
    """Solve a model and read its probes at the load factors that are reached; a `Run` as a dictionary."""
    clock, reason = Clock(), ""
    try:
        path = ms.solve(model(), observers=[clock])
        if released is not None:
            _settle(path, released(), clock)
    except ms.SolveError as failure:
        path, reason = failure.path, failure.reason
    except StepFailure as failure:
        reason = str(failure)
    reached = np.array([step.load_factor for step in path.steps])
    at = [int(np.argmin(np.abs(reached - stop))) for stop in stops if np.min(np.abs(reached - stop)) < 1e-9]
    at = at if released is None or not reason else []
    probes = {name: path.probe(name).u[at].tolist() for name in path.model.probes}
    hit = [float(reached[i]) for i in at]
    return Run(path.discretisation.dofs, hit, probes, clock.at(hit), path.solves, reason)._asdict()


def _settle(path: Path, free: ms.Model, clock: Clock) -> None:
    """Replace the last step of a path by the equilibrium of another model that starts from it."""
    discretisation, last = Discretisation(free, nested_dissection), path.steps[-1]
    system = System(discretisation, make_solver("superlu"), free.course(0), path.settings)
    start = Trial(last.state, 1.0, discretisation.predicted(last.state))
    solution = newton(system, start, None, lambda *_: None)
    path.steps[-1] = last._replace(state=solution.trial.state)
    path.discretisation = discretisation
    path.solves += solution.solves
    clock.seconds[-1] = time.process_time() - clock.begin


def again(model: Callable[[], ms.Model], first: Run) -> list[float]:
    """Least CPU times of a run and of repetitions of its quick part, s."""
    quick = [load for load, seconds in zip(first.loads, first.cpu, strict=True) if seconds < QUICK]
    least = list(first.cpu)
    for _ in range(REPEATS - 1 if quick else 0):
        clock = Clock(quick[-1])
        with suppress(Enough):
            ms.solve(model(), observers=[clock])
        least[: len(quick)] = np.minimum(least[: len(quick)], clock.at(quick)).tolist()
    return least
