"""What a solve says while it runs, of stages and critical points."""

from __future__ import annotations

import io
import re
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console
from solver.arches import arch, to_the_crown_at

import magshell as ms
from magshell import kernel_cache
from magshell.kernel_cache import COMPILING, FIRST_USE, WAITING, log
from magshell.kernel_messages import KernelMessages
from magshell.progress import ProgressDisplay
from magshell.solver import Settings


def said(model: ms.Model) -> tuple[ms.Path, list[str]]:
    """The path, and the lines that were written on the way."""
    text = io.StringIO()
    with ProgressDisplay(Console(file=text, width=200, highlight=False, markup=False)) as display:
        path = ms.solve(model, observers=[display])
    return path, text.getvalue().splitlines()


@pytest.mark.parametrize("waits", [False, True])
def test_a_first_use_is_told_by_one_line(monkeypatch: pytest.MonkeyPatch, waits: bool) -> None:
    """At its start: what is waited for, and how long, whatever comes first. Warnings are shown as ever."""
    monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: False)
    text = io.StringIO()
    with ProgressDisplay(Console(file=text, width=200, highlight=False, markup=False)):
        log.info(WAITING if waits else COMPILING, "the law Ogden")
        monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: True)
        for name in ("fill", "eliminate"):
            log.info(COMPILING, f"the kernel {name}")
        log.warning("the folder is full")
    assert text.getvalue().splitlines() == [FIRST_USE, "warning: the folder is full"]
    assert re.search("about half a minute, once", FIRST_USE)


def test_a_further_law_is_told_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: True)
    text = io.StringIO()
    with ProgressDisplay(Console(file=text, width=200, highlight=False, markup=False)):
        log.info(COMPILING, "the law Ogden")
        log.info(WAITING, "the law Field")
    assert text.getvalue().splitlines() == [
        "compiling the law Ogden (some seconds, once) ...",
        "waiting for another process that compiles the law Field (some seconds, once) ...",
    ]


def test_every_command_tells_what_it_compiles() -> None:
    """By the kernel's name; of the large one how long; a display of its own has the messages meanwhile."""
    outer, inner = [], []
    messages = KernelMessages(lambda text, style=None: outer.append(text))
    display = KernelMessages(lambda text, style=None: inner.append(text))
    messages.listen()
    log.info(COMPILING, "the kernel _walk_rows")
    display.listen()
    log.info(COMPILING, "the law Ogden")
    display.stop()
    log.warning(FIRST_USE)
    log.info(COMPILING, "the kernel fill")
    messages.stop()
    log.info(COMPILING, "the kernel unheard")
    assert outer == ["compiling the kernel _walk_rows (some seconds, once) ...", FIRST_USE]
    assert inner == ["compiling the law Ogden (some seconds, once) ..."]


def test_a_program_without_a_display_is_told_of_the_large_kernels(caplog: pytest.LogCaptureFixture) -> None:
    """By a warning, which Python writes to the terminal where nothing else is said of logging; once."""
    context = SimpleNamespace(refresh=lambda: None)
    kernel_cache._warn_once.cache_clear()
    for name in ("_walk_rows", "fill", "predict_stresses"):
        assert kernel_cache.Store(None, name, f"the kernel {name}").load_overload((), context) is None
    kernel_cache._warn_once.cache_clear()
    assert [record.message for record in caplog.records if record.levelname == "WARNING"] == [FIRST_USE]


def test_one_stage() -> None:
    """The load in percent; limit points with what the count of negative pivots does."""
    path, lines = said(arch([ms.Stage(control="arc-length")]))
    first, second = path.critical_points
    for point, pivots in ((first, "0 before, 1 after"), (second, "1 before, 0 after")):
        expected = (
            f"critical point {point.number}: limit point at {100 * point.load_factor:.4g} %; negative pivots {pivots}"
        )
        assert expected in lines, lines
    assert sum(line.startswith("step ") and "trying a smaller" not in line for line in lines) == len(path.steps) - 1
    assert re.fullmatch(
        rf"solved at 100 %: {len(path.steps) - 1} steps, {path.solves} linear solves, [\d.]+ s", lines[-1]
    )


def test_several_stages() -> None:
    """Each by its name, or by its number; names are shown as they are."""
    _, lines = said(arch([to_the_crown_at(0.01, name="[push] it"), ms.Stage()]))
    assert any(re.match(r"step \d+  [\d.]+ % of \[push\] it  \d+ iterations", line) for line in lines), lines
    assert any(re.match(r"step \d+  [\d.]+ % of stage 2  \d+ iterations", line) for line in lines), lines
    assert lines[-1].startswith("solved at 100 % of stage 2: ")


@pytest.mark.parametrize(("pivots", "text"), [((0, 2), "; negative pivots 0 before, 2 after"), ((None, 1), "")])
def test_critical_point_in_a_field(pivots: tuple[int | None, int], text: str) -> None:
    lines = io.StringIO()
    display = ProgressDisplay(Console(file=lines, width=200))
    discretisation = SimpleNamespace(model=arch(), mesh=arch().shell.mesh, dofs=12)
    display.started(discretisation, Settings())
    display.critical(
        SimpleNamespace(
            number=3, kind="bifurcation", stage=0, load_factor=0.25, flux_density=np.array([0, 0, 7.5e-3]),
            negative_pivots=pivots,
        )
    )  # fmt: skip
    assert lines.getvalue().splitlines()[-1] == f"critical point 3: bifurcation at 25 % (7.5 mT){text}"
