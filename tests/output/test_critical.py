"""critical.csv and the modes for ParaView."""

from __future__ import annotations

import csv

import numpy as np
import pytest
import pyvista

import magshell as ms
from magshell.output.critical import CriticalWriter
from magshell.solver.critical import BIFURCATION, LIMIT_POINT, CriticalPoint


@pytest.fixture
def points(path):
    """A limit point of the first stage and a bifurcation of the second, whose pivots nobody can count."""
    step = path.steps[2]
    mode = np.random.default_rng(3).normal(size=(len(step.state.u), 11))
    common = (0.7, np.array([0.0, 1e-3, 2e-3]), 1.25, step.state, mode)
    return [CriticalPoint(1, LIMIT_POINT, 0, *common, (0, 1)), CriticalPoint(2, BIFURCATION, 1, *common, (None, None))]


@pytest.fixture
def written(path, points, tmp_path):
    writer = CriticalWriter(tmp_path)
    writer.started(path.discretisation, None)
    for point in points:
        writer.critical(point)
    return tmp_path


def test_table(written):
    with open(written / "critical.csv", newline="", encoding="utf-8") as lines:
        heading, *rows = csv.reader(lines)
    about = ["number", "kind", "stage", "load_factor", "B1", "B2", "B3", "arc_length"]
    assert heading == [*about, "negative_pivots_before", "negative_pivots_after", "mode"]
    numbers = ["0.7", "0.0", "0.001", "0.002", "1.25"]
    assert rows == [
        ["1", "limit point", "1", *numbers, "0", "1", "critical/point-01.vtu"],
        ["2", "bifurcation", "2", *numbers, "", "", "critical/point-02.vtu"],
    ]


def test_file_holds_state_and_mode(path, points, written):
    grid = pyvista.read(written / "critical" / "point-02.vtu")
    mode, state = points[1].mode, points[1].state
    np.testing.assert_array_equal(grid.point_data["displacement"], state.u)
    np.testing.assert_array_equal(grid.point_data["mode"], mode[:, :3])
    np.testing.assert_array_equal(grid.point_data["mode_director"], mode[:, 3:6])
    np.testing.assert_array_equal(grid.point_data["mode_rotation"], mode[:, 7:10])
    np.testing.assert_allclose(grid.field_data["flux_density"], [[0.0, 1e-3, 2e-3]])
    assert grid.field_data["stage"] == 2


def test_path_without_critical_points_leaves_nothing_of_an_old_run(path, written):
    (written / "critical" / "point-notes.txt").touch()
    CriticalWriter(written).started(path.discretisation, None)
    assert sorted(file.name for file in written.rglob("*") if file.is_file()) == ["point-notes.txt"]


def test_disk_error_names_the_file(path, points, tmp_path):
    (tmp_path / "critical").touch()
    writer = CriticalWriter(tmp_path)
    writer.started(path.discretisation, None)
    with pytest.raises(OSError, match="critical"):
        writer.critical(points[0])


def test_modes_of_shells_with_rigid_bodies(tmp_path):
    """Nodes have their part of a mode; the rows of bodies are in no file of nodes."""
    mesh = ms.mesh.rectangle(0.02, 0.01, (2, 1))
    rubber = ms.MicropolarNeoHookean(1e6, 1e6)
    shell = ms.Shell(mesh, 1e-3, rubber, rigid=[ms.RigidBody("right")])
    path = ms.solve(ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 1e-4))]))
    step = path.steps[-1]
    mode = np.random.default_rng(3).normal(size=(len(step.state.u), 11))
    writer = CriticalWriter(tmp_path)
    writer.started(path.discretisation, None)
    writer.critical(CriticalPoint(1, BIFURCATION, 0, 0.7, step.flux_density, 1.25, step.state, mode, (0, 1)))
    written = pyvista.read(tmp_path / "critical" / "point-01.vtu").point_data["mode"]
    assert np.allclose(written[: len(mesh.points)], mode[: len(mesh.points), :3])
