"""`magshell reproduce`: what is on disk after Ctrl-C, what is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from magshell import cli
from magshell.reproduction.table import COLUMNS
from reproduction.conftest import Interrupted


def test_interrupt_keeps_the_example_that_is_done(interrupted: Interrupted) -> None:
    assert interrupted.status == 130, interrupted.errors
    assert "interrupted" in interrupted.errors
    assert "Traceback" not in interrupted.errors, interrupted.errors
    with open(interrupted.directory / "reproduction.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["example"] for row in rows} == {"thin-cross"}
    assert "Magnetic pump" in (interrupted.directory / "index.html").read_text()


def test_interrupt_ends_every_process(interrupted: Interrupted) -> None:
    """How soon: `test_runs.py`."""
    assert not interrupted.left_running


def test_earlier_figures_are_gone_and_other_files_stay(interrupted: Interrupted) -> None:
    assert not (interrupted.directory / "pump-shapes.png").exists()
    assert (interrupted.directory / "mine.png").read_bytes() == b"of the user"


def test_table_holds_the_number_of_the_paper_and_ours(interrupted: Interrupted) -> None:
    text = (interrupted.directory / "reproduction.csv").read_text()
    header, first, *_ = csv.reader(text.splitlines())
    assert tuple(header) == COLUMNS
    row = dict(zip(header, first, strict=True))
    assert (row["example"], row["unit"], row["paper"]) == ("thin-cross", "mm", "22.78")
    computed, difference = float(row["computed"]), float(row["difference_percent"])
    assert difference == pytest.approx(100.0 * (computed / 22.78 - 1.0), abs=0.01), row
    assert abs(difference) < 1.0, f"u3(A) is {computed} mm, the paper has 22.78: a note would be due"


def test_unknown_example_names_the_nearest_and_makes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "results"
    assert cli.main(["reproduce", "griper", "--out", str(target)]) == 2
    assert "Did you mean 'gripper'?" in capsys.readouterr().err
    assert not target.exists()


def test_folder_is_needed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["reproduce", "gripper"])
    assert ended.value.code == 2
    assert "--out" in capsys.readouterr().err


def test_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        cli.main(["reproduce", "--help"])
    assert "examples:\n  magshell reproduce" in capsys.readouterr().out
