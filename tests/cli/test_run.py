"""`magshell run`: what it writes and says when a problem is solved, is not solved, or is interrupted."""

from __future__ import annotations

import csv
import errno
import io
import json
import re
import signal
import subprocess
import sys
from pathlib import Path
from shlex import quote

import numpy as np
import problem_files
import pytest
from problem_files import changed
from processes import PATIENCE, hear_ctrl_c, until
from rich.console import Console

from magshell import problem
from magshell.cli import main
from magshell.kernel_cache import log
from magshell.output.history import HistoryWriter
from magshell.progress import ProgressDisplay
from magshell.solver import Step, solve

FIELD = 'flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]'
STRIP = changed(problem_files.STRIP, (FIELD, 'flux_density = [0, 0, "5 mT"]\nstops = ["1 mT", "3 mT"]'))


@pytest.fixture
def strip(tmp_path: Path) -> str:
    file = tmp_path / "strip.toml"
    file.write_text(STRIP)
    return str(file)


def rows(out: Path) -> list[dict[str, float]]:
    with (out / "history.csv").open(newline="") as file:
        return [{key: float(value or "nan") for key, value in row.items()} for row in csv.DictReader(file)]


def series(out: Path) -> list[str]:
    """Step files that the PVD file names."""
    return re.findall(r'file="([^"]+)"', (out / "shell.pvd").read_text())


def test_solved(strip: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "new" / "results"
    assert main(["run", strip, "--out", str(out)]) == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    history, summary = rows(out), json.loads((out / "summary.json").read_text())
    path = solve(problem.load(strip).model)
    assert [row["load_factor"] for row in history] == [step.load_factor for step in path.steps]
    np.testing.assert_array_equal([row["tip.u3"] for row in history], path.probe("tip").u3)
    for stop in (1e-3, 3e-3, 5e-3):
        assert min(abs(row["B3"] - stop) for row in history) < 1e-15, f"{stop} T is not hit"
    assert summary["converged"] is True
    assert summary["steps"] == len(history) - 1
    assert summary["probes"]["tip"][2] == history[-1]["tip.u3"]
    assert len(series(out)) == len(history)
    assert all((out / name).is_file() for name in series(out))
    assert (out / "curve.png").read_bytes()[:4] == b"\x89PNG"
    for words in (
        "linear solver",
        "step 1 ",
        "solved at 100 % (5 mT)",
        "tip: u = (",
        "picture: ",
        f"results: {out}",
    ):
        assert words in shown.out, f"{words!r} is not in {shown.out}"


def test_displacement_that_has_gone_again_is_zero(
    strip: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = Path(strip).read_text().replace('stops = ["1 mT", "3 mT"]', "history = [1, 0]")
    Path(strip).write_text(text + '\n[[stages]]\nname = "on"\n\n[[stages]]\nname = "off"\n')
    assert main(["run", strip, "--out", str(tmp_path / "out")]) == 0
    assert "tip: u = (0, 0, 0)" in capsys.readouterr().out


def test_a_second_run_replaces_the_first(strip: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["run", strip, "--out", str(out)]) == 0
    first = len(rows(out))
    again = changed(STRIP, ('"5 mT"', '"4 mT"'), ('["1 mT", "3 mT"]', "[]"))
    Path(strip).write_text(again + "[solver]\nfirst_step = 0.5\n")
    assert main(["run", strip, "--out", str(out)]) == 0
    history = rows(out)
    assert history[-1]["B3"] == 4e-3
    assert len(history) < first
    assert sorted(file.name for file in (out / "steps").iterdir()) == [Path(name).name for name in series(out)]


def test_not_solved(strip: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path(strip).write_text(STRIP + "[solver]\nmax_iterations = 1\nfirst_step = 0.1\nsmallest_step = 9e-3\n")
    out = tmp_path / "out"
    assert main(["run", strip, "--out", str(out)]) == 1
    shown = capsys.readouterr()
    summary = json.loads((out / "summary.json").read_text())
    assert shown.err.startswith("error: strip.toml: not solved: ")
    assert len(shown.err.splitlines()) == 1
    assert summary["converged"] is False
    assert summary["reason"] in shown.err
    assert "no convergence in 1 iterations" in summary["reason"]
    assert rows(out)[0]["load_factor"] == 0.0
    assert f"results: {out}" in shown.out


def test_interrupted_keeps_every_converged_step(
    strip: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupting(self: ProgressDisplay, step: Step) -> None:
        if step.number == 3:
            raise KeyboardInterrupt

    monkeypatch.setattr(ProgressDisplay, "converged", interrupting)
    out = tmp_path / "out"
    assert main(["run", strip, "--out", str(out)]) == 130
    shown = capsys.readouterr().err
    assert f"interrupted; the 3 steps that converged are in {out}" in shown
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["converged"], summary["reason"], summary["steps"]) == (False, "interrupted", 3)
    assert len(rows(out)) == len(series(out)) == 4
    assert summary["probes"]["tip"][2] == rows(out)[-1]["tip.u3"]


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_interrupt_key(tmp_path: Path) -> None:
    """Ctrl-C in the middle of a long run, with the process's own signal handling."""
    file, out = tmp_path / "long.toml", tmp_path / "out"
    fine, steps = ("elements = [4, 1]", "elements = [20, 6]"), "[solver]\nfirst_step = 1e-3\nlargest_step = 1e-3\n"
    file.write_text(changed(STRIP, fine) + steps)
    command = [sys.executable, "-m", "magshell", "run", str(file), "--out", str(out)]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, **pipes, text=True, preexec_fn=hear_ctrl_c) as process:
        until(lambda: (out / "history.csv").exists() and len(rows(out)) > 2, process)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, stderr
    assert "Traceback" not in stderr
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["converged"], summary["reason"]) == (False, "interrupted")
    assert summary["steps"] - (len(rows(out)) - 1) in (0, 1), "it may come between a step and its row"


def test_disk_that_refuses(
    strip: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(self: HistoryWriter, step: Step) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(self.file))

    monkeypatch.setattr(HistoryWriter, "converged", full)
    out = tmp_path / "out"
    out.mkdir()
    (out / "checkpoint").mkdir()
    (out / "problem.toml").touch()
    (out / "summary.json").write_text("of an earlier run")
    assert main(["run", strip, "--out", str(out)]) == 1
    shown = capsys.readouterr()
    full = f"{out}/history.csv: No space left on device"
    assert shown.err.splitlines() == [
        f"error: strip.toml: {full}; the 0 steps that converged are in {out}",
        f"error: go on with: magshell run --resume {quote(str(out))}",
    ]
    assert f"an earlier run in {out} are replaced" in shown.out
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["converged"], summary["reason"]) == (False, full)


def test_progress_on_a_terminal(strip: str) -> None:
    text = io.StringIO()
    display = ProgressDisplay(Console(file=text, force_terminal=True, width=160))
    with display:
        log.info("compiling a kernel ...")
        log.warning("the folder is damaged")
        path = solve(problem.load(strip).model, observers=[display])
        display.cut(0.5, "too bold")
    assert display.path is path
    shown = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text.getvalue())
    for words in (
        "linear solver",
        "compiling a kernel ...",
        "warning: the folder is damaged",
        "100%",
        "step to 50 % is too large, trying a smaller one",
        "solved at 100 % (5 mT)",
    ):
        assert words in shown, f"{words!r} is not in {shown!r}"
    assert "too bold" not in shown
    assert not re.search(r"step 1  \d", shown), "no line per step on a terminal"
    log.info("after the end")
    assert "after the end" not in text.getvalue()


def test_set(strip: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is changed stands in the copy of the problem, from which a run that is broken off goes on."""
    out = tmp_path / "out"
    assert (
        main(["run", strip, "--set", "shell.thickness=1.2 mm", "--set", "field.flux_density=3 mT", "--out", str(out)])
        == 0
    )
    assert "(shell.thickness = 1.2 mm, field.flux_density = 3 mT)" in capsys.readouterr().out
    copy = problem.load(out / "problem.toml")
    assert (copy.model.shell.thickness, copy.file.field.flux_density) == (1.2e-3, (0.0, 0.0, 3e-3))
    assert rows(out)[-1]["B3"] == 3e-3
    for arguments, words in (
        (["run", strip, "--set", "shell.thickness=1,2 mm", "--out", str(out)], "has 2 values (1 mm, 2 mm, …)"),
        (["run", strip, "--set", "shell.thicknes=1 mm", "--out", str(out)], "Did you mean 'thickness'"),
        (["run", "--set", "shell.thickness=1 mm", "--resume", str(out)], "--resume alone"),
    ):
        assert main(arguments) == 2
        assert words in capsys.readouterr().err
