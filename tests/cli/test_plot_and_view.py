"""`magshell plot`, `view` and `export` of results folders: whole ones, interrupted ones, and what is none."""

from __future__ import annotations

import pathlib
import shutil

import numpy as np
import pytest

import magshell as ms
from magshell import cli, results
from magshell.output import rendering
from magshell.output.checkpoint import step_files
from magshell.output.page import steps as page_steps


@pytest.fixture(scope="session")
def solved(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The folder of a strip, without pictures."""
    folder = tmp_path_factory.mktemp("results")
    problem = ms.problem.load("strip-10")
    results.make(problem, folder)
    ms.solve(problem.model, problem.settings, results.writers(problem, folder))
    return folder


@pytest.fixture
def folder(solved: pathlib.Path, tmp_path: pathlib.Path) -> pathlib.Path:
    """A copy to write into, with a blank and a letter that is not ASCII in its name."""
    return pathlib.Path(shutil.copytree(solved, tmp_path / "Ergebnis größer"))


@pytest.fixture
def can_draw() -> None:
    """Skip the test, saying why, where nothing three-dimensional can be drawn."""
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))


def test_view_writes_one_page(folder, capsys):
    before = {file.name for file in folder.iterdir()}
    assert cli.main(["view", str(folder)]) == 0
    assert {file.name for file in folder.iterdir()} - before == {"view.html"}
    page = (folder / "view.html").read_text(encoding="utf-8")
    assert "<h1>Strip of aspect ratio 10</h1>" in page
    assert "ends at step" not in page
    assert "10 steps" in capsys.readouterr().out


def test_view_says_which_steps_are_left_out(folder, monkeypatch, capsys):
    monkeypatch.setattr(page_steps, "MOST_BYTES", 1)
    assert cli.main(["view", str(folder)]) == 0
    assert "shows 2 of the steps 0 to 10" in " ".join(capsys.readouterr().out.split())
    assert "2 of 11 are shown" in (folder / "view.html").read_text(encoding="utf-8")


def test_view_of_an_interrupted_run_ends_where_it_came_to(folder, tmp_path):
    for file in step_files(folder)[4:]:
        file.unlink()
    assert cli.main(["view", str(folder), "--out", str(tmp_path / "page.html"), "--color", "energy"]) == 0
    assert "ends at step 3" in (tmp_path / "page.html").read_text(encoding="utf-8")


def test_plot_draws_curve_shapes_and_animation(folder, tmp_path, can_draw, capsys):
    out, film = tmp_path / "pictures", tmp_path / "film.gif"
    arguments = ["plot", str(folder), "--steps", "3,-1", "--out", str(out), "--animate", str(film), "--color", "W"]
    assert cli.main(arguments) == 0
    assert sorted(file.name for file in out.iterdir()) == ["curve.png", "shape-0003.png", "shape-0010.png"]
    assert film.read_bytes().startswith(b"GIF89a")
    said = capsys.readouterr().out
    assert all(str(file) in said for file in (*out.iterdir(), film))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["plot", "--steps", "1,99"], "there is no step 99; the path has steps 0 to 10"),
        (["plot", "--steps", "last"], "'last' is not a number of a step"),
        (["plot", "--color", "u4"], "There is no output 'u4'"),
        (["view", "--color", "enrgy"], "Did you mean 'energy'?"),
        (["plot", "--curves", ""], "There is no curve ''"),
        (["plot", "--curves", "left.R4"], "Did you mean 'left.R"),
        (
            ["plot", "--curves", "left.R3,left.M2"],
            "'left.R3' is in N and 'left.M2' is in N m; the curves",
        ),
        (["plot", "--curves", "elastic,magnetic"], "'magnetic' is empty for this problem"),
        (
            ["plot", "--over", "load-factor"],
            "There is no 'load-factor' to draw curves over. Did you mean 'load_factor'?",
        ),
        (["export", "--out", "body.obj"], "name it body.stl"),
        (["export", "--out", "body.stl", "--step", "11"], "the path has steps 0 to 10"),
        (["export", "--out", "body.stl", "--step", "last"], "is not a number of a step"),
        (["plot", "--animate", "shape.avi"], "ends in .gif"),
    ],
)
def test_wrong_wishes_are_bad_input_and_write_nothing(solved, arguments, words, capsys):
    before = sorted(solved.rglob("*"))
    assert cli.main([arguments[0], str(solved), *arguments[1:]]) == 2
    assert words in " ".join(capsys.readouterr().err.split())
    assert sorted(solved.rglob("*")) == before


@pytest.mark.parametrize("command", ["plot", "view"])
def test_folder_that_is_none_is_bad_input(command, tmp_path, capsys):
    assert cli.main([command, str(tmp_path)]) == 2
    assert "is not a results folder" in " ".join(capsys.readouterr().err.split())


def test_plot_without_a_way_to_draw_leaves_the_curve(folder, monkeypatch, capsys):
    monkeypatch.setattr(rendering, "_trial_failure", lambda: "it died of signal 11")
    assert cli.main(["plot", str(folder)]) == 1
    assert (folder / "curve.png").exists()
    assert not list(folder.glob("shape-*.png"))
    assert "libegl1" in capsys.readouterr().err


def test_plot_draws_the_curves_that_are_named(folder, monkeypatch, capsys):
    from magshell.output import curve

    drawn = []
    monkeypatch.setattr(curve, "deliver", lambda figure, file: drawn.append((figure, file)))
    monkeypatch.setattr("magshell.output.animation.draw_steps", lambda *given: [])
    assert cli.main(["plot", str(folder), "--curves", "left.M2, left.M1", "--over", "load_factor"]) == 0
    ((figure, file),) = drawn
    assert file == folder / "curve.png"
    (axes,) = figure.axes[:1]
    assert axes.get_ylabel() == "reaction moment (mN mm)"
    assert axes.get_xlabel() == "load factor"
    assert axes.lines[0].get_label() == "left  $M_2$"
    moment = results.read(folder).path.table()["left.M2"]
    assert np.abs(axes.lines[0].get_ydata() - 1e6 * moment).max() == 0.0


@pytest.mark.parametrize("name", ["body.stl", "body.vtu"])
def test_export_writes_the_solid(folder, tmp_path, capsys, name):
    assert cli.main(["export", str(folder), "--out", str(tmp_path / "new" / name), "--step", "3"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "step 3" in said
    assert "mm^3" in said
    assert (tmp_path / "new" / name).stat().st_size > 1000
