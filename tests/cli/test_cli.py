"""The command line without a solve: help, version, examples, check, and how it fails."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

from magshell import cli
from magshell.problem import examples


def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "magshell", *arguments], capture_output=True, text=True, check=False, **options
    )


def test_check_with_settings(capsys: pytest.CaptureFixture[str]) -> None:
    setting = ["--set", "shell.thickness=0.5 mm", "--set", "field.magnitude=20 mT"]
    assert cli.main(["check", "strip-10", *setting]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "thickness h 0.5 mm" in said
    assert "flux density B (0, 0, 20 mT)" in said
    assert cli.main(["check", "strip-10", "--set", "shell.thicknes=0.5 mm"]) == 2
    assert "Did you mean 'thickness'" in capsys.readouterr().err


def test_version_and_help_in_a_process() -> None:
    assert run("--version").stdout == f"magshell {version('magshell')}\n"
    without = run()
    assert without.returncode == 2
    assert "Traceback" not in without.stderr


@pytest.mark.parametrize("command", [[], *([name] for name in cli.COMMANDS)])
def test_every_command_has_help_with_examples(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main([*command, "--help"])
    assert ended.value.code == 0
    assert "examples:\n  magshell" in capsys.readouterr().out


def test_help_is_quick_to_import() -> None:
    """Help needs no solver, no pydantic and no rich."""
    code = 'import sys, magshell.cli as c; c._parser(); print({"pydantic", "rich", "numba"} & set(sys.modules))'
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown == "set()\n"


def test_examples_lists_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["examples"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == examples.names()
    assert all(len(line.split()) > 1 for line in lines)


def test_examples_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["examples", "--copy", "gripper"]) == 0
    assert Path("gripper.toml").read_text() == examples.text("gripper")
    assert cli.main(["examples", "--copy", "pump", "mine.toml"]) == 0
    assert Path("mine.toml").read_text() == examples.text("pump")
    Path("mine.toml").write_text("my work")
    capsys.readouterr()
    for arguments, words in (
        (["--copy", "pump", "mine.toml"], "exists already"),
        (["--copy", "pumpe"], "Did you mean 'pump'"),
        (["--copy", "pump", "no/such/folder.toml"], "cannot be written"),
        (["mine.toml"], "--copy"),
    ):
        assert cli.main(["examples", *arguments]) == 2
        assert words in capsys.readouterr().err
    assert Path("mine.toml").read_text() == "my work"


@pytest.mark.parametrize("name", examples.names())
def test_check_of_a_built_in_problem(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", name]) == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    made_of = "Regions" if name in ("bilayer-strip", "stepped-strip", "starfish") else "Material"
    for section in ("Mesh", "Shell", made_of, "Remanence", "Field", "Supports", "Probes"):
        assert f"\n{section}\n" in shown.out
    assert "warning" not in shown.out


def test_a_file_goes_before_a_built_in_problem_of_the_same_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("gripper").write_text(examples.text("strip-10"))
    assert cli.main(["check", "gripper"]) == 0
    assert "Strip of aspect ratio 10" in capsys.readouterr().out
    Path("pump").mkdir()
    assert cli.main(["check", "pump"]) == 0
    assert "Magnetic pump" in capsys.readouterr().out


@pytest.mark.parametrize("below", ["", "/deeper"])
def test_out_that_is_a_file(below: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "taken").write_text("my work")
    assert cli.main(["run", "strip-10", "--out", f"{tmp_path}/taken{below}"]) == 2
    shown = capsys.readouterr().err
    assert shown.startswith(f"error: --out {tmp_path}/taken{below}: ")
    assert "file" in shown
    assert (tmp_path / "taken").read_text() == "my work"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_out_that_is_not_writable(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    assert cli.main(["run", "strip-10", "--out", f"{tmp_path}/locked"]) == 2
    assert "not writable" in capsys.readouterr().err
    assert cli.main(["run", "strip-10", "--out", f"{tmp_path}/locked/new"]) == 2
    assert "cannot be made" in capsys.readouterr().err


def test_a_bug_is_one_line_and_debug_shows_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(name: str) -> str:
        raise ZeroDivisionError("by accident")

    monkeypatch.setattr(examples, "text", broken)
    assert cli.main(["check", "gripper"]) == 1
    shown = capsys.readouterr().err
    assert len(shown.splitlines()) == 1
    for words in ("bug in magshell", "ZeroDivisionError", "by accident", "--debug"):
        assert words in shown
    with pytest.raises(ZeroDivisionError):
        cli.main(["check", "gripper", "--debug"])


def test_a_reader_that_goes_away_is_no_error() -> None:
    shown = subprocess.run(
        [f"{sys.executable} -m magshell check pump | head -n 1"],
        shell=True,
        capture_output=True,
        text=True,
        check=True,
    )
    assert shown.stdout == "Problem\n"
    assert shown.stderr == ""
