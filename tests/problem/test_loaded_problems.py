"""Problem files whose loads are mechanical: what becomes of them, and the example of the documentation."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from problem_files import LOADED, changed

import magshell as ms
from magshell import problem
from magshell.cli import main
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe
from magshell.shell.state import State
from problem.loaded import EVERY_LOAD

BEFORE_GRAVITY = EVERY_LOAD[EVERY_LOAD.index("[[loads]]") : EVERY_LOAD.rindex("[[loads]]")]
PAGE = Path(__file__).parents[2] / "docs" / "problem-file.md"


def at_rest(model: ms.Model) -> np.ndarray:
    """Sum of all loads on the undeformed shell, (nodes, 11)."""
    mesh = model.shell.mesh
    state = State.undeformed(len(mesh.points), len(mesh.elements), model.shell.element.vectors)
    return np.sum([applied.forces(state) for applied in model.applied], axis=0)


def built(text: str) -> problem.building.Problem:
    return build(check(parse(text, "test.toml"), "test.toml"), "test.toml")


def test_loads_reach_the_model_in_si() -> None:
    loads = built(LOADED).model.loads
    assert [(load.kind, load.group, load.total) for load in loads] == [
        ("force", "far", (0.0, 0.0, 2e-3)),
        ("moment", "right", (0.0, 1e-5, 0.0)),
    ]


def test_loads_beside_a_field() -> None:
    field = '[field]\nflux_density = [0, 0, "2 mT"]\n\n[[supports]]'
    model = built(changed(LOADED, ("[[supports]]", field))).model
    assert model.field.magnitude == 2e-3
    assert at_rest(model).sum(axis=0)[2] == pytest.approx(2e-3, rel=1e-14)


def test_loads_on_areas_act_on_the_whole_shell_by_default() -> None:
    loads = '[[loads]]\nkind = "{}"\n{} = {}\n\n'
    areas = loads.format("pressure", "pressure", '"4 Pa"') + loads.format("traction", "traction", '[0, 0, "2 Pa"]')
    found = built(changed(LOADED, (LOADED[LOADED.index("[[loads]]") : LOADED.index("[[supports]]")], areas)))
    assert [load.group for load in found.model.loads] == [None, None]
    assert at_rest(found.model).sum(axis=0)[2] == pytest.approx(6.0 * 20e-3 * 5e-3, rel=1e-12)
    lines = dict(describe(found).sections["Loads"])
    assert lines["whole shell"].startswith("traction (0, 0, 2 Pa), 4 elements")


def test_every_key_reaches_the_model() -> None:
    model = built(EVERY_LOAD).model
    assert model.shell.density == 1200.0
    force, moment, traction, pressure, gravity = model.loads
    assert (force.group, force.total, force.follower, force.history) == ("far", (0, 0, 2e-3), True, (0, 1))
    assert (moment.group, moment.total, moment.follower, moment.history) == ("left", (0, 1e-5, 0), True, (0.5, 1))
    assert (traction.group, traction.traction, traction.history) == ("two", (0, 0, 5), (0, -1))
    assert (pressure.group, pressure.pressure, pressure.history) == ("one", -8, (0, 1))
    assert (gravity.group, gravity.acceleration, gravity.history) == ("two", (0, 0, -9.81), (1, 1))


def test_keys_left_out() -> None:
    force, moment = built(LOADED).model.loads
    assert (force.follower, moment.follower, force.history, moment.history) == (False, False, None, None)
    (gravity,) = built(changed(EVERY_LOAD, (BEFORE_GRAVITY, ""), ('group = "two"\nhistory = [1, 1]\n', ""))).model.loads
    assert (gravity.group, gravity.history) == (None, None)


def test_the_example_of_the_page() -> None:
    section = PAGE.read_text(encoding="utf-8").split("## `[[loads]]`")[1]
    found = re.search(r"```toml\n(.*?)```", section, re.DOTALL)
    assert found
    loads = LOADED[LOADED.index("[[loads]]") : LOADED.index("[[supports]]")]
    nodal = at_rest(built(changed(LOADED, (loads, found[1]))).model)
    assert nodal.sum(axis=0) == pytest.approx([0, 0, 2e-3, 1e-5, 0, 0, 0, 0, 0, 0, 0], rel=1e-14)


def test_history_without_a_field_holds_zeros(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "loaded.toml").write_text(LOADED)
    assert main(["run", str(tmp_path / "loaded.toml"), "--out", str(tmp_path / "out")]) == 0
    assert "solved at 100 %:" in capsys.readouterr().out
    with (tmp_path / "out" / "history.csv").open(newline="") as file:
        heading, *rows = csv.reader(file)
    assert heading[:4] == ["load_factor", "B1", "B2", "B3"]
    values = np.array([[number or "nan" for number in row] for row in rows], dtype=float)
    assert not np.any(values[:, 1:4])
    assert values[-1, 0] == 1.0
    assert values[-1, heading.index("tip.u3")] > 1e-3


def test_a_file_with_every_load_is_solved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "every.toml").write_text(EVERY_LOAD)
    assert main(["run", str(tmp_path / "every.toml"), "--out", str(tmp_path / "out")]) == 0, capsys.readouterr().err
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["converged"]
    assert max(summary["force_imbalance"], summary["moment_imbalance"]) < 1e-8
