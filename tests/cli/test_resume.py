"""`magshell run --resume`: where it goes on, what it mends, what it refuses, and what a stopped run says."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from shlex import quote

import numpy as np
import problem_files
import pytest
from problem_files import changed

import magshell as ms
from magshell.cli import main
from magshell.output.checkpoint import CheckpointWriter, content, read_step, step_files
from magshell.output.lock import alone
from magshell.problem import copies
from magshell.progress import ProgressDisplay
from magshell.solver import Step

FIELD = 'flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]'
STRIP = changed(problem_files.STRIP, (FIELD, 'flux_density = [0, 0, "5 mT"]\nstops = ["1 mT", "3 mT"]'))
LEFT = 2  # steps of the run that was stopped


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of a run that nothing disturbed."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "strip.toml").write_text(STRIP)
    assert main(["run", str(folder / "strip.toml"), "--out", str(folder / "out")]) == 0
    return folder / "out"


@pytest.fixture
def stopped(finished: Path, tmp_path: Path) -> Path:
    """The same folder as a run would have left it that was killed after two steps."""
    out = tmp_path / "out"
    shutil.copytree(finished, out)
    for file in step_files(out)[LEFT + 1 :]:
        file.unlink()
    for name in ("summary.json", "curve.png", "shape.png"):
        (out / name).unlink()
    return out


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take longer than all the rest."""
    monkeypatch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])


def contents(out: Path) -> dict[str, object]:
    """What the files of a folder hold, but for pictures and for the time it took."""
    found: dict[str, object] = {}
    for file in out.rglob("*"):
        name = str(file.relative_to(out))
        if file.suffix == ".npz" and file.stat().st_size > 100:
            with np.load(file) as arrays:
                found[name] = {key: arrays[key].tobytes() for key in arrays.files if key != "cpu_seconds"}
        elif file.name == "summary.json":
            found[name] = {**json.loads(file.read_text()), "cpu_seconds": None}
        elif file.is_file() and file.suffix != ".png" and file.name != ".lock":
            found[name] = file.read_bytes()
    return found


def test_an_older_folder_keeps_the_defaults_of_its_time(
    stopped: Path, finished: Path, no_pictures: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its file says no coupling modulus and no length scale, which then were what the file of `finished` says."""
    said = 'coupling_modulus = "0.1 mu"\nlength_scale = "0.1 h"\n'
    (stopped / "problem.toml").write_text(changed(STRIP, (said, "")))
    digest = copies.digest(ms.problem.load(stopped / "problem.toml"))
    steps = {file: read_step(file) for file in step_files(stopped)}
    with monkeypatch.context() as then:
        then.setattr("magshell.output.checkpoint.VERSION", 1)
        for file, (waypoint, origin) in steps.items():
            file.write_bytes(content(waypoint, origin._replace(problem=digest)))
    material = ms.results.read(stopped).problem.model.shell.material
    assert material == ms.results.read(finished).problem.model.shell.material
    assert main(["run", "--resume", str(stopped)]) == 0
    assert contents(stopped)["history.csv"] == contents(finished)["history.csv"]
    assert ms.results.read(stopped).path.model.shell.material == material


@pytest.mark.parametrize("command", [["run", "--resume"], ["run", "strip.toml", "--out"], ["view"], ["plot"]])
def test_folder_of_a_sweep_is_no_folder_of_a_run(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sweep").mkdir()
    for file in ("strip.toml", "sweep/problem.toml"):
        Path(file).write_text(STRIP)
    Path("sweep/sweep.toml").write_text("version = 1\n")
    before = sorted(tmp_path.rglob("*"))
    assert main([*command, "sweep"]) == 2
    assert "is the folder of a sweep, not of a run; `magshell sweep --resume`" in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


def test_goes_on(stopped: Path, finished: Path, no_pictures: None, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "--resume", str(stopped)]) == 0
    shown = capsys.readouterr()
    last = ms.results.read(finished).path.steps[LEFT]
    assert f"2 steps up to {100 * last.load_factor:.4g} %" in shown.out
    assert "step 3 " in shown.out
    assert "step 2 " not in shown.out
    assert shown.err == ""
    assert contents(stopped) == contents(finished)


@pytest.mark.usefixtures("no_pictures")
def test_mends_the_other_files(stopped: Path, finished: Path) -> None:
    """Rows and steps beyond the checkpoint (here: all), torn and missing ones, what a killed writer left."""
    history = (stopped / "history.csv").read_bytes()
    (stopped / "history.csv").write_bytes(history[:-9] + b"\nrubbish")
    (stopped / "shell.pvd").write_text("<VTK")
    torn = stopped / "steps" / "step-0001.vtu"
    torn.write_bytes(torn.read_bytes()[:-20])
    (stopped / "steps" / "step-0000.vtu").unlink()
    (stopped / "steps" / "step-0099.vtu").touch()
    (stopped / "checkpoint" / ".step-0003.npz.4711.tmp").touch()
    (stopped / ".history.csv.4711.tmp").touch()
    assert main(["run", "--resume", str(stopped)]) == 0
    assert contents(stopped) == contents(finished)


@pytest.mark.usefixtures("no_pictures")
def test_a_folder_without_reactions_gets_them(stopped: Path, finished: Path) -> None:
    """Of a version whose history ended at `negative_pivots`: read as it is, and gone on with."""
    rows = [line.split(",") for line in (stopped / "history.csv").read_text().splitlines()]
    end = rows[0].index("negative_pivots") + 1
    assert rows[0][end] == "left.R1"
    (stopped / "history.csv").write_text("".join(",".join(row[:end]) + "\n" for row in rows))
    assert len(ms.results.read(stopped).path.steps) == LEFT + 1
    assert main(["run", "--resume", str(stopped)]) == 0
    assert contents(stopped) == contents(finished)


def test_a_finished_run_is_left_alone(finished: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = {file: file.stat().st_mtime_ns for file in finished.rglob("*") if file.name != ".lock"}
    assert main(["run", "--resume", str(finished)]) == 0
    steps = len(step_files(finished)) - 1
    assert f"this run is finished: all {steps} steps and their files are in {finished}" in capsys.readouterr().out
    assert {file: file.stat().st_mtime_ns for file in finished.rglob("*") if file.name != ".lock"} == before


def test_the_end_that_was_not_written(
    finished: Path, tmp_path: Path, no_pictures: None, capsys: pytest.CaptureFixture[str]
) -> None:
    """Killed after the last step: nothing is solved, the end is written."""
    shutil.copytree(finished, tmp_path / "out")
    (tmp_path / "out" / "summary.json").unlink()
    (tmp_path / "out" / "history.csv").unlink()
    assert main(["run", "--resume", str(tmp_path / "out")]) == 0
    assert "solved at 100 %" in capsys.readouterr().out
    assert contents(tmp_path / "out") == contents(finished)


@pytest.mark.usefixtures("no_pictures")
def test_no_step_yet(stopped: Path, finished: Path) -> None:
    shutil.rmtree(stopped / "checkpoint")
    assert main(["run", "--resume", str(stopped)]) == 0
    assert contents(stopped) == contents(finished)


def test_not_solved_then_with_other_settings(
    tmp_path: Path, no_pictures: None, capsys: pytest.CaptureFixture[str]
) -> None:
    """The [solver] of the folder's problem may be changed; the run says so."""
    file, out = tmp_path / "strip.toml", tmp_path / "out"
    file.write_text(STRIP + "[solver]\nmax_iterations = 1\nfirst_step = 0.1\nsmallest_step = 9e-3\n")
    assert main(["run", str(file), "--out", str(out)]) == 1
    assert main(["run", "--resume", str(out)]) == 1, "it fails again"
    capsys.readouterr()
    copy = out / "problem.toml"
    copy.write_text(changed(copy.read_text(), ("max_iterations = 1\n", "")))
    assert main(["run", "--resume", str(out)]) == 0
    shown = capsys.readouterr().out
    assert "warning: the solver's settings have changed since the last step: max_iterations" in shown
    assert json.loads((out / "summary.json").read_text())["converged"] is True


REFUSED = {
    "another problem": (
        lambda out: (out / "problem.toml").write_text(changed(STRIP, ('"1 mm"', '"1.1 mm"'))),
        r"problem\.toml: is not the problem of the steps in .*, apart from its \[solver\]",
    ),
    "a damaged step": (
        lambda out: (out / "checkpoint/step-0002.npz").write_bytes(b"PK"),
        r"step-0002\.npz: is damaged .*Delete it .* goes on from step 1",
    ),
    "a missing step": (
        lambda out: (out / "checkpoint/step-0001.npz").unlink(),
        r"step-0001\.npz: is missing\. .* goes on from step 0",
    ),
    "no problem": (lambda out: (out / "problem.toml").unlink(), r"is not a results folder"),
    "a step of another mesh": (
        lambda out: reshape(out / "checkpoint/step-0002.npz"),
        r"step-0002\.npz: is of another mesh",
    ),
}


def reshape(file: Path) -> None:
    """Take a node away, as a version would with another generator of meshes (one without a digest)."""
    with np.load(file) as arrays:
        others = {name: values for name, values in arrays.items() if name != "digest"}
    np.savez(file, **{**others, "u": others["u"][1:]})


@pytest.mark.parametrize("fault", REFUSED)
def test_refused(fault: str, stopped: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spoil, message = REFUSED[fault]
    spoil(stopped)
    before = contents(stopped)
    assert main(["run", "--resume", str(stopped)]) == 2
    assert_line(capsys.readouterr().err, message)
    assert contents(stopped) == before


def assert_line(shown: str, message: str) -> None:
    """One line of error that says this."""
    assert len(shown.splitlines()) == 1, shown
    assert re.search(message, shown), shown


@pytest.mark.usefixtures("no_pictures")
def test_what_the_message_says_helps(stopped: Path, finished: Path) -> None:
    (stopped / "checkpoint/step-0002.npz").write_bytes(b"PK")
    assert main(["run", "--resume", str(stopped)]) == 2
    (stopped / "checkpoint/step-0002.npz").unlink()
    assert main(["run", "--resume", str(stopped)]) == 0
    assert contents(stopped) == contents(finished)


def test_versions(stopped: Path, no_pictures: None, monkeypatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("magshell.results.__version__", "99.0")
    assert main(["run", "--resume", str(stopped)]) == 0
    assert f"the last step was made by magshell {ms.__version__}, this is 99.0: the steps" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["strip-10", "--resume", "out"], "takes the problem from its folder"),
        (["--out", "out"], "name a problem file"),
        (["--resume", "nowhere"], "nowhere: is not a folder"),
        (["--resume", "."], "is not a results folder"),
    ],
)
def test_arguments(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", *arguments]) == 2
    assert_line(capsys.readouterr().err, message)


@pytest.mark.skipif(sys.platform == "win32", reason="no locks")
def test_one_run_at_a_time(stopped: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = contents(stopped)
    with alone(stopped):
        assert main(["run", "--resume", str(stopped)]) == 2
    assert_line(capsys.readouterr().err, rf"another run writes into it \(process {os.getpid()} on ")
    assert contents(stopped) == before


@pytest.fixture
def strip(tmp_path: Path) -> str:
    (tmp_path / "strip.toml").write_text(STRIP)
    return str(tmp_path / "strip.toml")


def stopping(monkeypatch: pytest.MonkeyPatch, how: Callable[[], None]) -> None:
    """Have something happen when the third step is shown."""

    def converged(self: ProgressDisplay, step: Step) -> None:
        if step.number == 3:
            how()

    monkeypatch.setattr(ProgressDisplay, "converged", converged)


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGTERM")
@pytest.mark.parametrize(("number", "word"), [(signal.SIGTERM, "terminated"), (signal.SIGINT, "interrupted")])
def test_stopped_by_a_signal(
    number: int, word: str, strip: str, tmp_path: Path, monkeypatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = signal.getsignal(signal.SIGTERM)
    kept = signal.signal(signal.SIGINT, signal.default_int_handler)
    stopping(monkeypatch, lambda: os.kill(os.getpid(), number))
    out = tmp_path / "the results"
    try:
        assert main(["run", strip, "--out", str(out)]) == 130
    finally:
        signal.signal(signal.SIGINT, kept)
    shown = capsys.readouterr().err
    assert f"{word}; the 3 steps that converged are in {out}" in shown
    assert f"go on with: magshell run --resume '{out}'" in shown
    assert json.loads((out / "summary.json").read_text())["reason"] == word
    assert signal.getsignal(signal.SIGTERM) == before


def test_summary_while_it_runs(strip: str, tmp_path: Path, no_pictures: None, monkeypatch) -> None:
    seen = []

    def converged(self: ProgressDisplay, step: Step) -> None:
        seen.append(json.loads((tmp_path / "out" / "summary.json").read_text()))

    monkeypatch.setattr(ProgressDisplay, "converged", converged)
    assert main(["run", strip, "--out", str(tmp_path / "out")]) == 0
    assert [one["steps"] for one in seen] == list(range(len(seen)))
    assert {(one["converged"], one["reason"]) for one in seen} == {(False, "running")}


def test_disk_that_is_full(
    strip: str, finished: Path, tmp_path: Path, no_pictures: None, capsys: pytest.CaptureFixture[str]
) -> None:
    """From the third step on no file may grow to what a step needs; with room again the run goes on."""
    resource = pytest.importorskip("resource")
    size = step_files(finished)[1].stat().st_size
    kept, before = CheckpointWriter.kept, resource.getrlimit(resource.RLIMIT_FSIZE)

    def filling(self: CheckpointWriter, path: ms.Path) -> None:
        if len(path.steps) == 4:
            resource.setrlimit(resource.RLIMIT_FSIZE, (size // 2, before[1]))
        kept(self, path)

    out = tmp_path / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CheckpointWriter, "kept", filling)
        try:
            assert main(["run", strip, "--out", str(out)]) == 1
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
    shown = capsys.readouterr().err
    assert f"{out}/checkpoint/step-0003.npz: File too large; the 2 steps that converged are in {out}" in shown
    assert f"go on with: magshell run --resume {quote(str(out))}" in shown
    assert len(step_files(out)) == len((out / "history.csv").read_text().splitlines()) - 1 == 3
    assert main(["run", "--resume", str(out)]) == 0
    assert contents(out) == contents(finished)


def test_the_folder_runs_by_itself(tmp_path: Path, no_pictures: None) -> None:
    """With copies of the files that the problem names; its comments stay."""
    home, out = tmp_path / "home", tmp_path / "out"
    (home / "fields").mkdir(parents=True)
    np.save(home / "fields" / "b.npy", np.tile([0.143, 0.0, 0.0], (4, 1)))
    np.save(home / "b.npy", np.tile([0.12, 0.0, 0.0], (4, 1)))
    table = '[[remanence]]\nkind = "file"  # measured\ngroup = "{}"\nfile = "{}"\nflux_density_unit = "T"\n'
    one = '[[remanence]]\nkind = "constant"\nvector = ["143 mT", 0, 0]\n'
    text = changed(problem_files.BLOCKS, (one, table.format("one", "fields/b.npy") + table.format("two", "b.npy")))
    (home / "strip.toml").write_text(text)
    assert main(["run", str(home / "strip.toml"), "--out", str(out)]) == 0
    shutil.rmtree(home)
    copy = (out / "problem.toml").read_text()
    expected = text.replace('"fields/b.npy"', '"inputs/b.npy"').replace('"b.npy"', '"inputs/b-2.npy"')
    assert copy == expected
    found = ms.results.read(out)
    assert found.path.converged
    assert found.notes == []
    again = tmp_path / "again"
    assert main(["run", str(out / "problem.toml"), "--out", str(again)]) == 0
    assert contents(again) == contents(out)
    assert main(["run", str(out / "problem.toml"), "--out", str(out)]) == 0, "into its own folder"
    assert contents(again) == contents(out)


def test_somebodys_own_problem_is_not_overwritten(
    strip: str, tmp_path: Path, no_pictures: None, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tmp_path / "problem.toml"
    own.write_text("# mine\n" + STRIP)
    assert main(["run", strip, "--out", str(tmp_path)]) == 2
    assert_line(capsys.readouterr().err, r"problem\.toml would be lost and is not of an earlier run")
    assert own.read_text() == "# mine\n" + STRIP
    assert main(["run", str(own), "--out", str(tmp_path)]) == 0
    assert own.read_text() == "# mine\n" + STRIP


def test_reading_a_finished_folder(finished: Path) -> None:
    results = ms.results.read(finished)
    rows = (finished / "history.csv").read_text().splitlines()
    assert results.path.converged
    assert repr(results).endswith(f"{results.path!r})")
    assert "data:image/png" in results._repr_html_()
    assert results.path.summary == json.loads((finished / "summary.json").read_text()) | {
        "cpu_seconds": results.path.cpu_seconds
    }
    assert len(results.path.steps) == len(rows) - 1
    tip = results.path.probe("tip").u3[-1]
    assert repr(float(tip)) == rows[-1].split(",")[6]
    assert read_step(step_files(finished)[-1])[0].step.number == results.path.steps[-1].number
