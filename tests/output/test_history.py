"""history.csv and summary.json."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

import magshell as ms
from magshell.output.history import HistoryWriter, history_text
from magshell.output.summary import write_summary


def read(file):
    with open(file, newline="", encoding="utf-8") as lines:
        heading, *rows = csv.reader(lines)
    return heading, np.array([[number or "nan" for number in row] for row in rows], dtype=float)


def test_history_holds_field_and_probes_exactly(path, tmp_path):
    writer = HistoryWriter(tmp_path)
    writer.started(path.discretisation, None)
    for step in path.steps:
        writer.converged(step)
    heading, rows = read(tmp_path / "history.csv")
    probes = [f"{name}.u{i}" for name in ("tip", 'edge, "low"') for i in (1, 2, 3)]
    series = ["elastic", "magnetic", "work", "work_field", "torque1", "torque2", "torque3"]
    names = ("von_mises", "principal_stress", "principal_strain")
    series += [f"max_{name}" for name in names]
    series += [f"max_{name}.{what}" for name in names for what in ("node", "element", "face")]
    assert heading == ["load_factor", "B1", "B2", "B3", *probes, "stage", "arc_length", "negative_pivots", *series]
    loads = np.array([step.load_factor for step in path.steps])
    expected = [loads, *np.outer([0.0, 0.0, 20e-3], loads)]
    for node in path.model.probe_nodes.values():
        expected += list(np.array([step.state.u[node] for step in path.steps]).T)
    expected += [np.ones(len(loads)), 2.0 * loads, [0, 0, 0, 1, 0]]
    u = np.array([step.state.u[path.discretisation.mesh.elements] for step in path.steps])
    number = np.arange(len(loads))
    expected += [1e-6 * np.abs(u).sum(axis=(1, 2, 3)), np.full(len(loads), np.nan), 1e-6 * number, 2e-6 * number]
    expected += list(np.outer([0.0, 0.0, 1e-6], np.ones(len(loads))))
    sizes = np.array([np.linalg.norm(step.state.u, axis=1) for step in path.steps])
    node = sizes.argmax(axis=1)
    element = [int(np.argmax((path.discretisation.mesh.elements == one).any(axis=1))) for one in node]
    expected += 3 * [2e3 * sizes.max(axis=1)] + 3 * [node, element, np.ones(len(loads))]
    np.testing.assert_array_equal(rows[:, :13], np.transpose(expected[:13]))
    np.testing.assert_allclose(rows[:, 13:], np.transpose(expected[13:]), rtol=1e-14)


def test_history_is_on_disk_after_every_step(path, tmp_path):
    writer = HistoryWriter(tmp_path / "new")
    writer.started(path.discretisation, None)
    for number, step in enumerate(path.steps, start=1):
        writer.converged(step)
        assert len(read(tmp_path / "new" / "history.csv")[1]) == number


def test_history_of_a_later_stage_whose_pivots_nobody_can_count(path, tmp_path):
    writer = HistoryWriter(tmp_path)
    writer.started(path.discretisation, None)
    step = path.steps[0]
    step.stage, step.negative_pivots = 2, None
    writer.converged(step)
    heading, rows = read(tmp_path / "history.csv")
    row = dict(zip(heading, rows[0], strict=True))
    assert (row["stage"], row["arc_length"]) == (3, 0.0)
    assert np.isnan(row["negative_pivots"])


def test_old_history_stays_until_the_run_starts(path, tmp_path):
    file = tmp_path / "history.csv"
    file.write_text("old\n")
    writer = HistoryWriter(tmp_path)
    assert file.read_text() == "old\n"
    writer.started(path.discretisation, None)
    heading, rows = read(file)
    assert heading[0] == "load_factor"
    assert len(rows) == 0


def test_folder_lost_while_solving_is_an_error_with_the_file(path, tmp_path):
    writer = HistoryWriter(tmp_path / "results")
    writer.started(path.discretisation, None)
    (tmp_path / "results").rename(tmp_path / "moved")
    with pytest.raises(OSError, match=r"history\.csv"):
        writer.converged(path.steps[0])


def reject(constant):
    raise AssertionError(f"{constant} is not JSON")


def test_summary(path, tmp_path):
    file = write_summary(path, tmp_path)
    summary = json.loads(file.read_text(encoding="utf-8"), parse_constant=reject)
    assert file == tmp_path / "summary.json"
    assert summary == {"converged": True, "reason": "", "linear_solves": 21, "cpu_seconds": 0.125}


def test_summary_of_a_broken_off_path(path, tmp_path):
    path.summary = {
        "reason": "the step became too small",
        "residual": np.float64("nan"),
        "balance": {"work": float("inf")},
        "sizes": np.arange(2),
    }
    summary = json.loads(write_summary(path, tmp_path).read_text(), parse_constant=reject)
    assert summary["reason"] == "the step became too small"
    assert (summary["residual"], summary["balance"], summary["sizes"]) == (None, {"work": None}, [0, 1])
    interrupted = json.loads(write_summary(path, tmp_path, reason="interrupted").read_text())
    assert interrupted["reason"] == "interrupted"


def test_a_uniform_field_that_turns_has_its_angle() -> None:
    """As the last column, so that all others are where they were; a field that does not turn has none."""
    mesh = ms.mesh.rectangle(10e-3, 4e-3, (2, 1))
    shell = ms.Shell(mesh, 1e-3, ms.MicropolarNeoHookean(1e6, 1e7), ms.remanence.constant([0.1, 0, 0]))
    fields = [
        ms.UniformField((0, 0, 1e-3), history=[1, 1]),
        ms.UniformField((0, 0, 1e-3), history=[1, 1], rotation_axis=(0, 1, 0), rotation=[0.0, 0.5]),
    ]
    still, turned = (ms.solve(ms.Model(shell, [ms.Clamp("left")], field)) for field in fields)
    assert turned.history.columns == [*still.history.columns, "field.angle"]
    angles = [row.split(",")[-1] for row in history_text(turned).split()[1:]]
    expected = [0.5 * step.load_factor if step.stage else 0.0 for step in turned.steps]
    np.testing.assert_allclose(np.array(angles, dtype=float), expected, rtol=1e-12)
    assert angles[-1] == "0.5"
