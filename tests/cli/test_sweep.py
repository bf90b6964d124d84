"""`magshell sweep` from the command line: solved, gone on with, interrupted, refused."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
from pathlib import Path
from shlex import quote

import pytest
from problem_files import STRIP
from processes import PATIENCE, hear_ctrl_c, until

from magshell import problem
from magshell.cli import main
from magshell.results import read
from magshell.solver import solve

SETTINGS = ["--set", "field.flux_density=0 mT:1.5 mT:2", "--set", "shell.thickness=0.8,1.2 mm"]


def rows(out: Path) -> list[dict[str, str]]:
    with (out / "sweep.csv").open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def strip(tmp_path: Path) -> str:
    file = tmp_path / "strip.toml"
    file.write_text(STRIP)
    return str(file)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("swept")
    (folder / "strip.toml").write_text(STRIP)
    assert main(["sweep", str(folder / "strip.toml"), *SETTINGS, "--out", str(folder / "out"), "--workers", "1"]) == 0
    return folder / "out"


def test_table_cells_and_picture(swept: Path) -> None:
    found = rows(swept)
    assert [(row["field.flux_density [T]"], row["shell.thickness [m]"]) for row in found] == [
        ("0.0", "0.0008"),
        ("0.0", "0.0012"),
        ("0.0015", "0.0008"),
        ("0.0015", "0.0012"),
    ]
    assert [row["converged"] for row in found] == ["True"] * 4
    assert [row["tip.u3 [m]"] for row in found[:2]] == ["0.0", "0.0"]
    assert [row["reason"] for row in found] == ["nothing acts: undeformed"] * 2 + [""] * 2
    assert (swept / "sweep.png").read_bytes()[:4] == b"\x89PNG"
    assert sorted(path.name for path in (swept / "cells").iterdir()) == ["0003", "0004"]


def test_all_steps_of_all_cells(swept: Path) -> None:
    """The histories of the cells below each other, with what the cells are, and units in the header."""
    with (swept / "sweep-history.csv").open(newline="") as file:
        heading, *found = csv.reader(file)
    first = ["cell", "field.flux_density [T]", "shell.thickness [m]", "load_factor", "B1 [T]", "B2 [T]", "B3 [T]"]
    assert heading[:8] == [*first, "tip.u1 [m]"]
    for column in ("left.R3 [N]", "left.M2 [N m]", "elastic [J]", "torque2 [N m]", "max_von_mises [Pa]", "stage"):
        assert column in heading
    expected = []
    for cell, thickness in (("0003", "0.0008"), ("0004", "0.0012")):
        with (swept / "cells" / cell / "history.csv").open(newline="") as file:
            columns, *rows_of_cell = csv.reader(file)
        assert [column.split(" [")[0] for column in heading[3:]] == columns
        expected += [[cell, "0.0015", thickness, *row] for row in rows_of_cell]
    assert found == expected


def test_a_cell_is_a_folder_of_results_that_runs_by_itself(swept: Path, tmp_path: Path) -> None:
    cell, row = swept / "cells" / "0004", rows(swept)[3]
    alone = problem.load(cell / "problem.toml")
    assert alone.model.shell.thickness == 1.2e-3
    assert alone.file.field.flux_density == (0.0, 0.0, 1.5e-3)
    assert alone.file.field.stops == (1e-3,)
    assert alone.title == "(field.flux_density = 1.5 mT, shell.thickness = 1.2 mm)"
    path = solve(alone.model, alone.settings)
    # The cell was solved with one thread.
    assert float(row["tip.u3 [m]"]) == pytest.approx(path.probe("tip").u3[-1], rel=1e-9)
    assert row["steps"] == str(len(path.steps) - 1)
    assert len(read(cell).path.steps) == len(path.steps)


def test_the_same_command_again_solves_nothing(swept: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = {file: file.stat().st_mtime_ns for file in (swept / "cells").rglob("*")}
    assert main(["sweep", str(swept.parent / "strip.toml"), *SETTINGS, "--out", str(swept)]) == 0
    assert "4 cells, of which 4 are done" in capsys.readouterr().out
    (swept.parent / "strip.toml").unlink()
    assert main(["sweep", "--resume", str(swept)]) == 0
    assert before == {file: file.stat().st_mtime_ns for file in (swept / "cells").rglob("*")}


def test_a_cell_that_is_not_solved(strip: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path(strip).write_text(STRIP + "[solver]\nmax_iterations = 1\nfirst_step = 0.1\nsmallest_step = 9e-3\n")
    out = tmp_path / "the results"
    arguments = ["sweep", strip, "--set", "solver.max_iterations=1", "--out", str(out), "--workers", "1"]
    assert main(arguments) == 1
    shown = capsys.readouterr()
    assert shown.err == f"error: 1 of 1 cells are not solved; try them again with --resume {quote(str(out))}\n"
    assert "cell 0001 (solver.max_iterations = 1): not solved: stopped at load factor 0" in shown.out
    assert "no picture: no setting has several numbers" in shown.out
    assert rows(out)[0]["converged"] == "False"
    assert rows(out)[0]["reason"] in shown.out


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_interrupt_key(tmp_path: Path) -> None:
    """Ctrl-C, which the terminal sends to the workers as well; what is done stays, and the rest can be gone on with."""
    file, out = tmp_path / "strip.toml", tmp_path / "the results"
    file.write_text(STRIP + "[solver]\nfirst_step = 1e-3\n")
    command = [sys.executable, "-m", "magshell", "sweep", str(file), "--out", str(out), "--workers", "1"]
    command += ["--set", "solver.largest_step=1,0.001"]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, preexec_fn=hear_ctrl_c, start_new_session=True
    ) as process:
        until(lambda: bool(list(out.glob("cells/0002/checkpoint/*0001*"))), process)
        os.killpg(process.pid, signal.SIGINT)
        _, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert stderr == f"error: interrupted; go on with: magshell sweep --resume {quote(str(out))}\n"
    assert [row["converged"] for row in rows(out)] == ["True", ""]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["strip", "--out", "out"], "--set: is missing"),
        (["--out", "out"], "FILE|NAME: is missing"),
        (["strip", "--set", "a=1", "--resume", "out"], "--resume DIR: knows its problem and settings"),
        (["strip", "--set", "shell.thicknes=1 mm", "--out", "out"], "shell.thicknes: is an unknown key. Did you mean"),
        (["strip", "--set", "shell.thickness=1", "--out", "out"], "shell.thickness: '1' has no unit"),
        (["strip", "--set", "shell.thickness", "--out", "out"], "--set shell.thickness: write KEY=VALUES"),
        (["strip", "--set", "shell.thickness=1 mm", "--out", "out", "--workers", "0"], "--workers 0: must be"),
        (["strip", "--set", "a=1", "--out", "out", "--workers", "2", "--dask", "x"], "--workers: a cluster has"),
        (["nowhere.toml", "--set", "a=1", "--out", "out"], "nowhere.toml: there is no such file"),
        (["--resume", "nowhere"], "sweep.toml: there is no such file, so this is no folder of a sweep"),
    ],
)
def test_refused(
    arguments: list[str],
    words: str,
    strip: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", *(strip if part == "strip" else part for part in arguments)]) == 2
    assert words in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["strip.toml"], "nothing is made before all is checked"
