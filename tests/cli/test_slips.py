"""Slips in commands: files of one's own in the way, names that say another format, a run in which nothing moves."""

from __future__ import annotations

from pathlib import Path

import pytest
from problem_files import STRIP, changed

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError
from magshell.output.setup import draw_setup

OWN = b"my own work, of years"
SWEEP = ["sweep", "strip.toml", "--set", "shell.thickness=1 mm", "--workers", "1", "--out", "out"]
USES = {
    "run": (["run", "strip.toml", "--out", "out"], [
        "history.csv", "summary.json", "shell.pvd", "critical.csv", "curve.png", "shape.png", "problem.toml",
        "steps/step-0001.vtu", "critical/point-01.vtu", "checkpoint/step-0007.npz",
    ]),
    "buckling": (["buckling", "strip.toml", "--out", "out"], ["buckling.csv", "buckling/mode-01.vtu"]),
    "sweep": (SWEEP, [
        "sweep.csv", "sweep-history.csv", "sweep.png", "sweep.toml", "problem.toml", "cells/0001/summary.json",
    ]),
    "reproduce": (["reproduce", "strips", "--out", "out"], ["index.html", "reproduction.csv", "strips-curves.png"]),
}  # fmt: skip


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
    (tmp_path / "strip.toml").write_text(STRIP)
    return tmp_path


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    (folder / "strip.toml").write_text(STRIP)
    assert main(["run", str(folder / "strip.toml"), "--out", str(folder / "out")]) == 0
    return folder / "out"


@pytest.mark.parametrize(("use", "name"), [(use, name) for use, (_, names) in USES.items() for name in names])
def test_a_folder_with_files_of_ones_own(use: str, name: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = here / "out" / name
    own.parent.mkdir(parents=True)
    own.write_bytes(OWN)
    before = sorted((here / "out").rglob("*"))
    assert main(USES[use][0]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert name.split("/0001/")[0] in said or "out: holds the results of a run" in said
    assert own.read_bytes() == OWN
    assert [file for file in sorted((here / "out").rglob("*")) if file.name != ".lock"] == before


def test_files_that_are_in_nobodys_way(here: Path) -> None:
    """Also temporary files of other programs, and folders with the names of those here."""
    for name in ("notes.txt", ".mine.12.tmp", "below/.other.3.tmp", "steps/readme.txt", "data/history.csv"):
        own = here / "out" / name
        own.parent.mkdir(parents=True, exist_ok=True)
        own.write_bytes(OWN)
    for _ in range(2):
        assert main(["run", "strip.toml", "--out", "out"]) == 0
        assert all((here / "out" / name).read_bytes() == OWN for name in ("notes.txt", "steps/readme.txt"))
    assert (here / "out/.mine.12.tmp").exists() or (here / "out/problem.toml").exists()
    assert main(["run", "--resume", "out"]) == 0


def test_temporary_files_of_a_strange_folder_stay(here: Path) -> None:
    (here / "out").mkdir()
    (here / "out/.mine.12.tmp").write_bytes(OWN)
    assert main(["run", "strip.toml", "--out", "out"]) == 0
    assert (here / "out/.mine.12.tmp").read_bytes() == OWN


def test_inputs_of_ones_own(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A copy that the run makes of the mesh would take the place of another file."""
    ms.mesh.write(ms.mesh.rectangle(20e-3, 5e-3, (4, 1)), here / "part.msh", "mm")
    text = '[mesh]\nfile = "part.msh"\n\n' + STRIP[STRIP.index("[shell]") :]
    (here / "file.toml").write_text(text)
    (here / "out/inputs").mkdir(parents=True)
    (here / "out/inputs/part.msh").write_bytes(OWN)
    assert main(["run", "file.toml", "--out", "out"]) == 2
    assert "inputs/part.msh" in capsys.readouterr().err
    assert (here / "out/inputs/part.msh").read_bytes() == OWN


def test_pictures_of_ones_own(here: Path, results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Into another folder; those of an earlier plot are replaced, and in the results all are."""
    (here / "pictures").mkdir()
    own = here / "pictures/curve.png"
    own.write_bytes(OWN)
    plot = ["plot", str(results), "--steps", "1", "--out", "pictures"]
    assert main(plot) == 2
    assert "curve.png would be lost" in capsys.readouterr().err
    assert own.read_bytes() == OWN
    own.unlink()
    assert main(plot) == main(plot) == 0
    assert sorted(file.name for file in (here / "pictures").iterdir()) == ["curve.png", "shape-0001.png"]
    (here / "pictures/shape-0001.png").write_bytes(OWN)
    assert main(plot) == 2
    assert main(["plot", str(results), "--steps", "1"]) == 0


def test_the_picture_of_a_problem(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "strip-show.png").write_bytes(OWN)
    assert main(["show", "strip.toml"]) == 2
    assert "say --out strip-show.png to replace it" in capsys.readouterr().err
    assert (here / "strip-show.png").read_bytes() == OWN
    assert main(["show", "strip.toml", "--out", "strip-show.png"]) == main(["show", "strip.toml"]) == 0


def test_names_that_say_another_format(here: Path, results: Path) -> None:
    mesh, path = ms.mesh.rectangle(20e-3, 5e-3, (4, 1)), ms.results.read(results).path
    for call, right in (
        (lambda: ms.mesh.write(mesh, "a.stl"), "a.msh"),
        (lambda: ms.mesh.write(mesh, "a"), "a.msh"),
        (lambda: path.save("a.csv"), "a.pvd"),
        (lambda: path.save("a.vtu"), "a.pvd"),
        (lambda: path.view("a.pdf"), "a.html"),
        (lambda: path.animate("a.avi"), ".gif"),
        (lambda: draw_setup(path.model, "a.svg"), "a.png"),
        (lambda: ms.output.pictures.draw_curve(path, "a.jpg"), "a.png"),
        (lambda: ms.output.pictures.draw_shape(path, "a.jpg"), "a.png"),
    ):
        with pytest.raises(InputError, match=rf"^a\..*{right}|^a: .*{right}"):
            call()
    assert [file.name for file in here.iterdir()] == ["strip.toml"]


def test_saving_a_path(here: Path, results: Path) -> None:
    path = ms.results.read(results).path
    path.save("a")
    path.save("a.pvd")
    assert len(list((here / "a").iterdir())) == len(path.steps)
    (here / "mine").mkdir()
    (here / "mine/step-0009.vtu").write_bytes(OWN)
    (here / "b.pvd").write_bytes(OWN)
    for name in ("mine.pvd", "b.pvd"):
        with pytest.raises(InputError, match="would be lost"):
            path.save(name)
    assert (here / "mine/step-0009.vtu").read_bytes() == OWN


def test_a_run_in_which_nothing_moves(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Held at every node; and one that moves, of which it is not said."""
    far, clamp = 'far = { x1 = "20 mm" }\n', 'kind = "clamp"\ngroup = "left"'
    everywhere = (far, far + "[mesh.node_groups]\nall = { x3 = 0 }\n"), (clamp, clamp.replace("left", "all"))
    (here / "held.toml").write_text(changed(STRIP, *everywhere))
    assert main(["run", "held.toml", "--out", "held"]) == 0
    said = capsys.readouterr().out
    assert "warning: the supports hold every node" in said
    assert "warning: nothing moved: the largest displacement of all steps is 0. Check the supports" in said
    assert main(["run", "strip.toml", "--out", "out"]) == 0
    assert "warning" not in capsys.readouterr().out
