"""Which cells are solved and which are kept, what the table says meanwhile, and what is shown."""

from __future__ import annotations

import csv
import errno
import io
import json
from pathlib import Path

import pytest
from rich.console import Console

from magshell.problem.alternatives import Setting
from magshell.sweep.display import Display
from magshell.sweep.folder import SweepFolder
from magshell.sweep.grid import Cell
from magshell.sweep.outcomes import Outcome
from magshell.sweep.sweep import sweep
from sweep import cells as ends
from sweep.conftest import Here


def rows(folder: SweepFolder) -> list[dict[str, str]]:
    with folder.table.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(autouse=True)
def instead(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", ends.instead)


@pytest.fixture(autouse=True)
def compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: True)


def test_the_table(
    folder: SweepFolder, settings: list[Setting], cells: list[Cell], here: Here, display: Display, shown: io.StringIO
) -> None:
    outcomes = sweep(folder, settings, cells, here, display)
    assert all(outcome.converged for outcome in outcomes.values())
    assert rows(folder)[1] == {
        "cell": "0002",
        "shell.thickness [m]": "0.001",
        "converged": "True",
        "reason": "",
        "load_factor": "1.0",
        "steps": "3",
        "solves": "9",
        "cpu_seconds": "0.5",
        "force_imbalance": "1e-12",
        "tip.u1 [m]": "0.0",
        "tip.u2 [m]": "0.0",
        "tip.u3 [m]": "0.002",
    }
    assert shown.getvalue().splitlines()[-1] == (
        "cell 0003 (shell.thickness = 1.2 mm): solved, 3 steps, 0.5 s  [3 of 3 done]"
    )


def test_the_table_is_up_to_date_after_each_cell(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    here: Here,
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen = []

    def looking(*arguments: str) -> Outcome:
        seen.append([row["converged"] for row in rows(folder)])
        return ends.instead(*arguments)

    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", looking)
    sweep(folder, settings, cells, here, display)
    assert seen == [["", "", ""], ["True", "", ""], ["True", "True", ""]]


def test_what_failed_or_is_missing_is_solved_again(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    display: Display,
    shown: io.StringIO,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def failing(name: str, text: str, place: str, directory: str, stop: str) -> Outcome:
        if Path(directory).name == "0002":
            return Outcome(False, "it buckles, and jumps", {"steps": 1, "probes": {"tip": [1.0, 1.0, 1.0]}})
        return ends.instead(name, text, place, directory, stop)

    first = Here()
    with monkeypatch.context() as patch:
        patch.setattr("magshell.sweep.sweep.solve_cell", failing)
        outcomes = sweep(folder, settings, cells, first, display)
    assert first.cells == ["0001", "0002", "0003"]
    assert [outcomes[n].converged for n in (1, 2, 3)] == [True, False, True]
    row = rows(folder)[1]
    assert (row["converged"], row["reason"], row["steps"]) == ("False", "it buckles, and jumps", "1")
    assert row["tip.u3 [m]"] == "", "a displacement on the way is not one at the end"
    assert "cell 0002 (shell.thickness = 1 mm): not solved: it buckles, and jumps" in shown.getvalue()
    (folder.cell("0003") / "summary.json").unlink()
    again = Here()
    outcomes = sweep(folder, settings, cells, again, display)
    assert again.cells == ["0002", "0003"]
    assert [row["converged"] for row in rows(folder)] == ["True"] * 3
    third = Here()
    sweep(folder, settings, cells, third, display)
    assert third.cells == []


@pytest.mark.parametrize(
    "damage", ["", "{", "[]", '{"converged": true}', '{"converged": 1, "reason": "", "probes": {}}']
)
def test_a_damaged_summary_is_none(
    damage: str, folder: SweepFolder, settings: list[Setting], cells: list[Cell], here: Here, display: Display
) -> None:
    out = folder.cell("0001")
    out.mkdir(parents=True)
    (out / "summary.json").write_text(damage)
    sweep(folder, settings, cells, here, display)
    assert here.cells == ["0001", "0002", "0003"]


def test_a_worker_that_fails_is_a_reason(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    here: Here,
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def lost(*arguments: str) -> Outcome:
        raise ModuleNotFoundError("No module named 'magshell'")

    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", lost)
    outcomes = sweep(folder, settings, cells, here, display)
    assert {outcome.reason for outcome in outcomes.values()} == {"its worker failed: No module named 'magshell'"}


def test_ctrl_c_keeps_what_is_done(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    here: Here,
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def interrupted(*arguments: str) -> Outcome:
        if Path(arguments[3]).name == "0003":
            raise KeyboardInterrupt
        return ends.instead(*arguments)

    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sweep(folder, settings, cells, here, display)
    assert [row["converged"] for row in rows(folder)] == ["True", "True", ""]
    assert rows(folder)[2]["reason"] == "not solved yet"
    assert not folder.stop.exists()


def test_a_full_disk_is_an_error_that_names_the_file(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    here: Here,
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def full(file: Path, *rest: object) -> None:
        if here.cells:
            raise OSError(errno.ENOSPC, "No space left on device", str(file))

    monkeypatch.setattr("magshell.sweep.sweep.write_table", full)
    with pytest.raises(OSError, match=r"No space left on device: .*sweep\.csv"):
        sweep(folder, settings, cells, here, display)


def test_the_first_cell_goes_ahead_where_kernels_are_to_be_compiled(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    here: Here,
    display: Display,
    shown: io.StringIO,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: False)
    monkeypatch.setattr(here, "places", 3)
    before = []

    def looking(*arguments: str) -> Outcome:
        before.append([row["converged"] for row in rows(folder)])
        return ends.instead(*arguments)

    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", looking)
    sweep(folder, settings, cells, here, display)
    assert before[0] == ["", "", ""]
    assert before[1:] == [["True", "", ""]] * 2, "the others wait for the first"
    assert shown.getvalue().count("compiling the kernels") == 1


def test_the_bar_on_a_terminal(folder: SweepFolder, settings: list[Setting], cells: list[Cell], here: Here) -> None:
    text = io.StringIO()
    display = Display(Console(file=text, force_terminal=True, width=160))
    with display:
        sweep(folder, settings, cells, here, display)
    for words in ("0 of 3 done, 1 running", "3 of 3 done, 0 running", "left"):
        assert words in text.getvalue(), f"{words!r} is not in {text.getvalue()!r}"
    assert "solved" not in text.getvalue(), "cells have no lines of their own on a terminal"


def test_the_folder_says_what_the_sweep_is(folder: SweepFolder) -> None:
    source, texts = folder.read()
    assert (source.name, texts) == ("strip.toml", ["shell.thickness=0.8 mm:1.2 mm:3"])
    folder.begin(source, texts)
    assert json.dumps(texts)[1:-1] in folder.definition.read_text()
