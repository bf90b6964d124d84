"""Results folders that a disk or a hand has damaged: what can be read is read, the rest is refused with its file."""

from __future__ import annotations

import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from problem_files import STRIP

from faults.damage import damaged
from faults.limits import MUTATIONS, bounded, located, share
from magshell import results
from magshell.cli import main
from magshell.errors import InputError

FILE = "checkpoint/step-0002.npz"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a short run."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "strip.toml").write_text(STRIP)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
        assert main(["run", str(folder / "strip.toml"), "--out", str(folder / "out")]) == 0
    return folder / "out"


@pytest.fixture
def out(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "out"))


def refused_or_a_path(out: Path) -> None:
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            path = results.read(out).path
        except InputError as error:
            located(error, str(error).partition(": ")[0])
            named(str(error), out)
            return
    for step in path.steps:
        assert all(np.isfinite(array).all() for array in step.state)


def named(text: str, out: Path) -> None:
    assert all(line.startswith((str(out), "problem.toml: ")) for line in text.splitlines()), text


@share(0.05)
@given(data=st.data())
def test_a_damaged_step(data: st.DataObject, whole: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    content = (whole / FILE).read_bytes()
    (whole / FILE).write_bytes(data.draw(damaged(content)))
    try:
        refused_or_a_path(whole)
    finally:
        (whole / FILE).write_bytes(content)


def removed(file: Path) -> None:
    file.unlink()


def emptied(file: Path) -> None:
    file.write_bytes(b"")


def foreign(file: Path) -> None:
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(200))


def a_folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


def dangling(file: Path) -> None:
    file.unlink()
    file.symlink_to("nowhere")


def huge(file: Path) -> None:
    with file.open("r+b") as opened:
        opened.truncate(1 << (30 if MUTATIONS else 28))


DAMAGES = [removed, emptied, foreign, a_folder, dangling, huge]


@pytest.mark.parametrize("command", [["view"], ["plot"], ["run", "--resume"]], ids=["view", "plot", "resume"])
@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
@pytest.mark.parametrize("name", [FILE, "problem.toml"])
def test_commands_say_which_file(
    name: str, damage: Callable[[Path], None], command: list[str], out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    damage(out / name)
    with bounded():
        status = main([*command, str(out)])
    shown = capsys.readouterr().err
    assert status in (1, 2), shown
    assert shown.startswith("error: ")
    assert "bug in magshell" not in shown
    assert Path(name).name in shown or str(out) in shown, shown


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
@pytest.mark.parametrize("name", ["summary.json", "history.csv", "shell.pvd", "curve.png", "critical.csv", "steps"])
def test_what_is_made_of_steps_is_made_again(
    name: str, damage: Callable[[Path], None], out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only problem and checkpoint are read: a run that goes on writes the rest anew, or says what is in its way."""
    file = out / name
    if file.is_dir():
        shutil.rmtree(file)
    file.touch()
    damage(file)
    with bounded(), pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
        status = main(["run", "--resume", str(out)])
    shown = capsys.readouterr().err
    assert "bug in magshell" not in shown
    assert status == 0 or str(out) in shown, f"{status}: {shown}"
