"""Results folders that a disk or a hand has damaged: what can be read is read, the rest is refused with its file."""

from __future__ import annotations

import re
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from problem_files import STRIP

import magshell as ms
from faults.damage import damaged
from faults.limits import MUTATIONS, bounded, located, share
from magshell import results
from magshell.cli import main
from magshell.errors import InputError
from magshell.output.archive import digest

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


def changed(file: Path, **values: object) -> None:
    """Some arrays exchanged as anybody can, without the digest, as in a file of magshell 0.1.0."""
    with np.load(file) as arrays:
        others = {name: array for name, array in arrays.items() if name != "digest"}
    with file.open("wb") as opened:
        np.savez(opened, **{**others, **values})


def floats(file: Path) -> dict[str, np.ndarray]:
    with np.load(file) as arrays:
        return {name: array for name, array in arrays.items() if array.dtype.kind == "f"}


def test_an_old_folder_keeps_working(out: Path) -> None:
    for file in sorted((out / "checkpoint").iterdir()):
        changed(file)
    assert results.read(out).path.converged


@share(0.15)
@given(data=st.data())
def test_changed_numbers(data: st.DataObject, whole: Path) -> None:
    """Of any array: refused by name, or a path of finite numbers that its problem could have."""
    number = data.draw(st.integers(0, len(list((whole / "checkpoint").iterdir())) - 1))
    file = whole / f"checkpoint/step-{number:04d}.npz"
    content = file.read_bytes()
    with np.load(file) as arrays:
        name = data.draw(st.sampled_from(sorted(arrays)))
        array = arrays[name].copy()
    values = {"f": st.floats(), "i": st.integers(-(2**63), 2**63 - 1), "b": st.booleans(), "U": st.text(max_size=9)}
    value = data.draw(values[array.dtype.kind])
    if array.size and data.draw(st.booleans()):
        array.flat[data.draw(st.integers(0, array.size - 1))] = value
    else:
        array = np.full(data.draw(st.sampled_from([(), (0,), (1,), (3,), (*array.shape, 1), array.shape])), value)
    changed(file, **{name: array})
    try:
        refused_or_a_path(whole)
    finally:
        file.write_bytes(content)


WRONG = [np.nan, np.inf, -1e200]


@pytest.mark.parametrize("wrong", WRONG)
def test_no_number_that_is_none_gets_in(wrong: float, whole: Path) -> None:
    """One of every array of floating-point numbers; with the digest made anew, as who wants to deceive can."""
    file = whole / FILE
    content = file.read_bytes()
    try:
        for name, array in floats(file).items():
            if not array.size:
                continue
            bad = array.copy()
            bad.flat[array.size // 2] = wrong
            changed(file, **{name: bad})
            with np.load(file) as arrays:
                anew = digest({other: each for other, each in arrays.items() if other != "cpu_seconds"})
            changed(file, **{name: bad, "digest": anew})
            words = rf"step-0002\.npz: is damaged or was changed: .*{name}"
            with pytest.raises(InputError, match=words):
                results.read(whole)
            file.write_bytes(content)
    finally:
        file.write_bytes(content)


LIES = {
    "another field": ({"flux_density": np.array([0.0, 0.0, 0.5])}, "flux_density is .*0.5.*but the problem has"),
    "a field of two components": ({"flux_density": np.zeros(2)}, "flux_density and loads have the shapes"),
    "another load factor": ({"load_factor": 0.25}, "flux_density is "),
    "a load": ({"loads": np.ones(1)}, "flux_density and loads have the shapes"),
    "a stage": ({"stage": 3}, "stage is 4, of 1"),
    "no stage": ({"stage": -1}, "stage is 0, of 1"),
    "a goal": ({"goal": 99}, "goal is 99"),
    "a count": ({"taken": -1}, "a count, radius, residual or time is negative"),
    "a step back": ({"arc_length": -0.5}, "arc_length is -0.5, after"),
    "a long rotation": ({"q": None}, "q of node 0 is not a unit quaternion"),
    "a body far away": ({"u": None}, "u of node 0 is"),
    "another mesh": ({"phi": np.zeros(3)}, r"phi has the shape \(3,\), not"),
    "a mode": ({"slope_increment": np.zeros((2, 11))}, "slope_increment has the shape"),
    "whole numbers": ({"w": None}, "w has the shape"),
    "critical points": ({"critical_points": 10**6}, "KeyError"),
    "settings": ({"settings": "[" * 10_000}, "RecursionError"),
}


@pytest.mark.parametrize("lie", LIES)
def test_changed_numbers_are_refused_by_name(lie: str, out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    values, words = LIES[lie]
    last = sorted((out / "checkpoint").iterdir())[-1]
    arrays = floats(last)
    made = {"q": 2.0 * arrays["q"], "u": arrays["u"] + 1e9, "w": arrays["w"].astype(np.int64)}
    changed(last, **{name: made[name] if value is None else value for name, value in values.items()})
    for command in (["view"], ["run", "--resume"]):
        with bounded():
            assert main([*command, str(out)]) == 2
        said = capsys.readouterr().err
        assert said.startswith(f"error: {last}: is damaged")
        assert re.search(words, said), said
        assert "Delete it and the steps after it" in said


def test_a_first_step_that_is_deformed(out: Path) -> None:
    first = out / "checkpoint/step-0000.npz"
    changed(first, u=floats(first)["u"] + 1e-3)
    with pytest.raises(InputError, match="the first step is not the undeformed state"):
        results.read(out)


@pytest.mark.parametrize("content", ["[" * 200_000, "[1]", "1", "{", '{"converged": ' + "9" * 5000 + "}", "\0"])
def test_a_summary_that_is_none(content: str, out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is written anew."""
    monkeypatch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
    (out / "summary.json").write_text(content)
    with bounded():
        assert main(["run", "--resume", str(out)]) == 0
    assert '"converged": true' in (out / "summary.json").read_text()


def test_a_table_of_one_endless_line(tmp_path: Path) -> None:
    (tmp_path / "b.csv").write_text("b1,b2,b3," + "x" * (1 << 21))
    with pytest.raises(InputError, match=r"b\.csv, line 1: has more than 1048576 characters"):
        ms.remanence.from_file(tmp_path / "b.csv")


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
