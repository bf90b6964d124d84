"""Problems solved in parallel: the same states as one at a time; failures are outcomes."""

from __future__ import annotations

import csv
import io
import multiprocessing
import signal
import sys
import threading
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import numpy as np
import pytest
from problem_files import STRIP, changed
from rich.console import Console

from magshell import solve
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.schema import ProblemFile
from magshell.reproduction import reproduce as module
from magshell.reproduction.catalogue import Example
from magshell.reproduction.runs import Outcome, _outcome, solve_all

GOOD = check(parse(STRIP, "good"), "good")
HOPELESS = check(
    parse(
        changed(STRIP, ('flux_density = [0, 0, "2 mT"]', 'flux_density = [0, 0, "20 T"]'))
        + "[solver]\nmax_iterations = 1\nfirst_step = 0.5\nsmallest_step = 9e-3\n",
        "hopeless",
    ),
    "hopeless",
)


@pytest.fixture(scope="module")
def outcomes() -> tuple[dict[str, Outcome], list[tuple[str, float]]]:
    """Two that can be solved and one that cannot, and what was told on the way."""
    told: list[tuple[str, float]] = []
    files = {"good": GOOD, "hopeless": HOPELESS, "again": GOOD}
    results = {one.name: one for one in solve_all(files, lambda *message: told.append(message), workers=2)}
    return results, told


def test_parallel_run_is_the_same_as_a_direct_one(outcomes) -> None:
    """But for round-off, as BLAS has other threads in the processes: it moves steps by 1e-9, but not the stops."""
    built = build(GOOD, "good")
    direct = solve(built.model, built.settings)
    for name in ("good", "again"):
        path = outcomes[0][name].path
        assert path is not None, outcomes[0][name].reason
        loads = [step.load_factor for step in direct.steps]
        assert [step.load_factor for step in path.steps] == pytest.approx(loads, rel=1e-8)
        for one, other in zip(path.steps, direct.steps, strict=True):
            apart = np.abs(one.state.u - other.state.u).max()
            within = 1e-9 if other.load_factor in (0.5, 1.0) else 1e-7
            assert apart <= within * np.abs(other.state.u).max(), f"step {one.number}: {apart:.1e} m"
            assert one.load_factor == other.load_factor or within > 1e-9
        assert path.summary.keys() == direct.summary.keys()
        for probe, displacement in direct.summary["probes"].items():
            assert path.summary["probes"][probe] == pytest.approx(displacement, rel=1e-9, abs=1e-12)
        assert path.converged


def test_progress_of_every_run_is_told(outcomes) -> None:
    assert {name for name, load in outcomes[1] if load == 1.0} == {"good", "again"}


@pytest.mark.skipif(sys.platform == "win32", reason="no signal to a thread")
def test_interrupt_ends_a_run_far_before_its_end() -> None:
    """It comes with the first step of a thousand; no process is left."""
    steps = "[solver]\nfirst_step = 1e-3\nlargest_step = 1e-3\n"
    files = {"good": GOOD, "long": check(parse(STRIP + steps, "long"), "long")}
    reached = [0.0]

    def interrupting(name: str, load: float) -> None:
        if name == "long":
            if len(reached) == 1:
                signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
            reached.append(load)

    kept = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            list(solve_all(files, interrupting, workers=1))
    finally:
        signal.signal(signal.SIGINT, kept)
    assert len(reached) > 1
    assert max(reached) < 0.9, reached
    assert multiprocessing.active_children() == []


def test_run_that_fails_is_an_outcome_with_its_reason(outcomes) -> None:
    failed = outcomes[0]["hopeless"]
    assert failed.path is None
    assert "smallest_step" in failed.reason or "stopped at load factor" in failed.reason, failed.reason


def test_process_that_dies_is_an_outcome_with_its_reason() -> None:
    future: Future = Future()
    future.set_exception(BrokenProcessPool("a process was terminated abruptly"))
    assert _outcome("lost", future, None) == Outcome(
        "lost", None, "BrokenProcessPool: a process was terminated abruptly"
    )


def test_failed_example_is_recorded_and_the_other_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def files(example: Example) -> dict[str, ProblemFile]:
        return {f"{example.name} itself": HOPELESS if example.name == "h-shape" else GOOD}

    def section(example: Example, paths: object, directory: Path) -> module.Section:
        return module.Section(example, [module.Row(example.name, "a number", "mm", 1.0, 1.0)])

    monkeypatch.setattr(module, "variants", files)
    monkeypatch.setattr(module, "section_of", section)
    result = module.reproduce(["pump", "h-shape"], tmp_path, Console(file=io.StringIO()))
    assert result.failed == ["h-shape"]
    with open(tmp_path / "reproduction.csv", newline="") as file:
        rows = {row["example"]: row for row in csv.DictReader(file)}
    assert rows["pump"]["quantity"] == "a number"
    assert rows["h-shape"]["quantity"] == "not solved"
    assert "stopped at load factor" in rows["h-shape"]["note"]
    assert "stopped at load factor" in (tmp_path / "index.html").read_text()
