"""Paths of Python that are saved as folders: the files of a run, read back, gone on with."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from problem_files import STRIP

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError
from magshell.solver.events import Observer

LENGTH = 11e-3
pytestmark = pytest.mark.usefixtures("small_pictures")


def model(remanence: Any = None) -> ms.Model:
    mesh = ms.mesh.rectangle(LENGTH, 5e-3, (4, 1))
    remanence = remanence or ms.remanence.constant([0.1, 0, 0])
    shell = ms.Shell(mesh, 1.1e-3, ms.MicropolarNeoHookean(303e3, 7.3e6), remanence)
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 10e-3], [5e-3]), probes={"tip": (LENGTH, 0, 0)})


@pytest.fixture(scope="module")
def path() -> ms.Path:
    return ms.solve(model())


@pytest.fixture(scope="module")
def folder(path: ms.Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("saved") / "run"
    path.save(f"{folder}/")
    return folder


def test_it_is_read_back(path: ms.Path, folder: Path) -> None:
    found = ms.results.read(folder, own=True)
    assert found.problem is None
    assert found.notes == []
    assert found.path.converged
    np.testing.assert_array_equal(found.path.probe("tip").u, path.probe("tip").u)
    assert found.path.summary == path.summary
    assert repr(found) == f"Results('', {path!r})"


def test_the_files_are_those_of_a_run(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Of the same problem, byte for byte, but for the time and what only one of them has."""
    file, run, saved = tmp_path / "strip.toml", tmp_path / "run", tmp_path / "saved"
    file.write_text(STRIP)
    assert main(["run", str(file), "--out", str(run)]) == 0
    ms.results.read(run).path.save(f"{saved}/")
    for name in ("history.csv", "shell.pvd", *(f"steps/{one.name}" for one in (run / "steps").iterdir())):
        assert (saved / name).read_bytes() == (run / name).read_bytes(), name
    one, other = (json.loads((each / "summary.json").read_text()) for each in (run, saved))
    assert {**one, "cpu_seconds": 0.0} == {**other, "cpu_seconds": 0.0}
    pictures = {one.name for one in run.glob("*.png")}
    assert {one.name for one in saved.iterdir()} == {
        *pictures, "history.csv", "summary.json", "shell.pvd", "steps", "path.pickle",
    }  # fmt: skip


class Stop(Exception):
    pass


class Stopper(Observer):
    """Breaks off after the third step."""

    def __init__(self) -> None:
        self.path: ms.Path | None = None

    def kept(self, path: ms.Path) -> None:
        self.path = path
        if len(path.steps) == 3:
            raise Stop


def test_a_path_that_was_broken_off_goes_on(path: ms.Path, tmp_path: Path) -> None:
    """To the same bits."""
    stopper = Stopper()
    with pytest.raises(Stop):
        ms.solve(model(), observers=[stopper])
    assert stopper.path is not None
    stopper.path.save(f"{tmp_path / 'half'}/")
    assert not json.loads((tmp_path / "half" / "summary.json").read_text())["converged"]
    found = ms.results.read(tmp_path / "half", own=True).path
    assert len(found.steps) == 3
    np.testing.assert_array_equal(ms.resume(found).probe("tip").u, path.probe("tip").u)


def test_a_shorter_path_replaces_it(path: ms.Path, tmp_path: Path) -> None:
    """In a folder that exists, without a slash; nothing of the longer one stays."""
    path.save(f"{tmp_path}/")
    other = ms.solve(model(), ms.Settings(first_step=0.5))
    assert len(other.steps) < len(path.steps)
    other.save(tmp_path)
    assert len([*(tmp_path / "steps").iterdir()]) == len(other.steps)
    assert len((tmp_path / "history.csv").read_text().splitlines()) == len(other.steps) + 1
    assert len(ms.results.read(tmp_path, own=True).path.steps) == len(other.steps)


def test_without_a_slash_it_is_for_paraview(path: ms.Path, tmp_path: Path) -> None:
    path.save(tmp_path / "new")
    assert (tmp_path / "new.pvd").is_file()
    assert not (tmp_path / "new" / "path.pickle").exists()


def test_whose_it_is_must_be_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match=r"may run any program when it is opened.*own=True"):
        ms.results.read(folder)
    for command in (["view", str(folder)], ["run", "--resume", str(folder)]):
        assert main(command) == 2
        assert "path.pickle" in capsys.readouterr().err


def test_files_of_somebody_else(path: ms.Path, tmp_path: Path) -> None:
    (tmp_path / "history.csv").write_text("mine\n")
    with pytest.raises(InputError, match=r"history\.csv would be lost"):
        path.save(tmp_path)
    assert [one.name for one in tmp_path.iterdir()] == ["history.csv"]


def test_a_function_that_cannot_be_pickled(tmp_path: Path) -> None:
    """Nothing is written."""
    made = ms.solve(model(ms.remanence.function(lambda x: np.full((*x.shape[:-1], 3), 0.1))))
    with pytest.raises(InputError, match="must be a function of a module, no lambda"):
        made.save(f"{tmp_path / 'run'}/")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    "damage", [lambda all_of: all_of[:-100], lambda all_of: all_of[:30], lambda _: b"magshell path"]
)
def test_a_damaged_file(folder: Path, tmp_path: Path, damage: Any) -> None:
    (tmp_path / "path.pickle").write_bytes(damage((folder / "path.pickle").read_bytes()))
    with pytest.raises(InputError, match=r"path\.pickle: is damaged"):
        ms.results.read(tmp_path, own=True)


def test_of_another_version(folder: Path, tmp_path: Path) -> None:
    content = (folder / "path.pickle").read_bytes().split(b"\n", 1)[1]
    (tmp_path / "path.pickle").write_bytes(b"magshell path, magshell 0.0.1\n" + content)
    (note,) = ms.results.read(tmp_path, own=True).notes
    assert "saved by magshell 0.0.1" in note


def test_pictures_that_fail_are_said(
    path: ms.Path, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("magshell.output.saved.draw_pictures", lambda *_: ["No picture shape.png: no screen"])
    with caplog.at_level(logging.WARNING):
        path.save(f"{tmp_path / 'run'}/")
    assert "no screen" in caplog.text
    assert ms.results.read(tmp_path / "run", own=True).path.converged
