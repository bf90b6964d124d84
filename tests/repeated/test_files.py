"""Repeated parts in problem files, reports, results folders and pictures."""

from __future__ import annotations

import csv
import pickle

import numpy as np
import pytest

import magshell as ms
from magshell import problem
from magshell.cli import main
from magshell.equations.discretisation import Discretisation
from magshell.evaluation.converged import Converged, converged
from magshell.output.copies import between, neighbours
from magshell.problem import examples
from magshell.problem.report import describe


@pytest.fixture(scope="module")
def sheet(tmp_path_factory):
    """The built-in sheet, coarser, run to a folder."""
    folder = tmp_path_factory.mktemp("sheet")
    (folder / "sheet.toml").write_text(examples.text("wavy-sheet").replace("elements = [10, 2]", "elements = [4, 1]"))
    assert main(["run", str(folder / "sheet.toml"), "--out", str(folder / "out")]) == 0
    return folder / "out"


def test_history_has_the_jump(sheet):
    with open(sheet / "history.csv", newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    jumps = [float(row["period.u1"]) for row in rows]
    assert jumps[0] == 0.0
    assert np.all(np.diff(jumps) < 0.0)
    assert jumps[-1] < -5e-3
    assert max(abs(float(row["period.F1"])) for row in rows) < 1e-9
    assert {float(row["period.u3"]) for row in rows} == {0.0}


def test_path_is_read_and_resumed(sheet):
    path = ms.results.read(sheet).path
    copy = pickle.loads(pickle.dumps(path))
    np.testing.assert_array_equal(copy.steps[-1].state.u, path.steps[-1].state.u)
    (jump,) = converged(path.discretisation, path.steps[-1]).jumps
    assert jump[0, 0] < -5e-3


def test_copies_are_the_neighbours(sheet):
    path = ms.results.read(sheet).path
    reached = converged(path.discretisation, path.steps[-1])
    before, after = neighbours(reached)
    mesh = path.model.shell.mesh
    x = mesh.points + reached.displacement
    (left, right), one = path.model.shell.repeated[0].nodes(mesh), path.model.shell.repeated[0]
    assert one.name == "period"
    np.testing.assert_allclose(after.of(x[left]), x[right], atol=1e-15)
    np.testing.assert_allclose(before.of(x[right]), x[left], atol=1e-15)
    half = between([before], [after], 0.5)[0]
    np.testing.assert_allclose(half.shift, 0.0, atol=1e-15)


def test_sectors_close_the_circle():
    built = problem.load("rosette")
    d = Discretisation(built.model, lambda graph: np.arange(graph.shape[0]))
    copies = neighbours(Converged(d, d.undeformed(), built.model.loading(0.0)))
    assert len(copies) == 5
    points, repeated = built.model.shell.mesh.points, built.model.shell.repeated[0]
    group, image = repeated.nodes(built.model.shell.mesh)
    np.testing.assert_allclose(copies[0].of(points[group]), points[image], atol=1e-12)
    np.testing.assert_allclose(copies[-1].of(points[image]), points[group], atol=1e-12)


def test_check_tells_repetitions():
    said = dict(describe(problem.load("rosette")).sections["Repeated"])
    assert said == {"cyclic": "side to other, turned by 60°, 7 pairs"}
    (said,) = describe(problem.load("wavy-sheet")).sections["Repeated"]
    assert "20 mm" in said[1]
    assert "'period'" in said[1]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('image = "other"', 'image = "othr"', "repeated[0].image: There is no group 'othr'"),
        ("sectors = 6", "sectors = 5", "repeated[0]: repeated from 'side' to 'other': node"),
        ("sectors = 6", "", "repeated[0].sectors"),
        ('kind = "cyclic"', 'kind = "cyclik"', "'cyclic'"),
    ],
)
def test_faults_are_located(tmp_path, old, new, words, capsys):
    text = examples.text("rosette")
    assert old in text
    (tmp_path / "rosette.toml").write_text(text.replace(old, new))
    assert main(["check", str(tmp_path / "rosette.toml")]) == 2
    assert words in " ".join(capsys.readouterr().err.split())
