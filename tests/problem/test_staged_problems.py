"""Problem files with stages: what becomes of them, and messages that say where and what would be right."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from problem_files import STRIP, changed

import magshell as ms
from magshell.cli import main
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe

FIELD = STRIP[STRIP.index("[field]") : STRIP.index("[[supports]]")]
STAGED = changed(
    STRIP,
    (
        FIELD,
        """[field]
flux_density = [0, 0, "2 mT"]
history = [0, 1, 1]
rotation_axis = [0, 1, 0]
rotation = [0, 0, "90 deg"]

[[loads]]
kind = "force"
group = "far"
total = [0, 0, "0.1 mN"]

[[stages]]
name = "weight"
control = "displacement"
probe = "tip"
component = 3
target = "0.1 mm"

[[stages]]
name = "field"
stops = [0.5]

[[stages]]
name = "turn"
control = "arc-length"

""",
    ),
)


def built(text):
    return build(check(parse(text, "test.toml"), "test.toml"), "test.toml")


def test_keys_reach_the_model():
    model = built(STAGED).model
    assert [stage.name for stage in model.stages] == ["weight", "field", "turn"]
    assert model.stages[0] == ms.Stage("weight", "displacement", probe="tip", component=3, target=1e-4)
    assert model.stages[1].stops == (0.5,)
    assert model.course(1).at(0.5).flux_density == pytest.approx([0, 0, 1e-3], abs=1e-18)
    assert model.course(2).at(1.0).flux_density == pytest.approx([2e-3, 0, 0], abs=1e-18)


def test_stops_that_are_evenly_spaced():
    """A whole number of them: of a field in its magnitude, of a stage in the load factor; each is a step."""
    text = changed(STAGED, ("stops = [0.5]", "stops = 4"))
    assert built(text).model.stages[1].stops == (0.25, 0.5, 0.75, 1.0)
    problem = built(changed(STRIP, ('stops = ["1 mT", "2 mT"]', "stops = 5")))
    assert problem.model.field.stops == pytest.approx([0.4e-3, 0.8e-3, 1.2e-3, 1.6e-3, 2e-3], rel=1e-15)
    assert dict(describe(problem).sections["Field"])["stops"] == "5 stops, 0.4 mT apart"
    sizes = [float(step.flux_density[2]) for step in ms.solve(problem.model).steps]
    for stop in problem.model.field.stops:
        assert min(abs(size - stop) for size in sizes) < 1e-15
    assert ms.UniformField([0, 0, 1e-3], stops=2, history=[-2]).stops == pytest.approx([1e-3, 2e-3], rel=1e-15)
    for wrong in (0, -3, 10**9):
        with pytest.raises(ms.InputError, match="stops is"):
            ms.Stage(stops=wrong)


def test_stages_are_described():
    lines = dict(describe(built(STAGED)).sections["Stages"])
    assert "until u3 of tip is 0.1 mm" in lines["1 weight"]
    assert "(2 mT, 0, " in lines["3 turn"]


def test_the_file_is_solved(tmp_path):
    file = tmp_path / "staged.toml"
    file.write_text(STAGED, encoding="utf-8")
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 0
    with open(tmp_path / "out" / "history.csv", encoding="utf-8", newline="") as history:
        rows = list(csv.DictReader(history))
    assert {row["stage"] for row in rows} == {"1", "2", "3"}
    first = [row for row in rows if row["stage"] == "1"][-1]
    assert float(first["tip.u3"]) == pytest.approx(1e-4, rel=1e-7)
    sizes = [np.linalg.norm([float(row[f"B{i}"]) for i in (1, 2, 3)]) for row in rows if row["stage"] == "3"]
    assert sizes == pytest.approx([2e-3] * len(sizes), rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('control = "arc-length"', 'control = "arclength"', r"stages\[2\].control"),
        ("stops = [0.5]", "stops = [0.5, 0.2]", r"stages\[1\].*must rise"),
        ("stops = [0.5]", "stops = [1.5]", r"stages\[1\].*at most 1"),
        ("component = 3\n", "", r"stages\[0\].*component is missing"),
        ('probe = "tip"', 'probe = "tp"', r"stage 'weight': probe 'tp' is unknown.*tip"),
        ("history = [0, 1, 1]", "history = [0, 1]", r"field: history has 2 entries.*3 stages"),
        ("rotation_axis = [0, 1, 0]\n", "", r"field.rotation_axis: is missing"),
        ("rotation_axis = [0, 1, 0]", "rotation_axis = [0, 0, 0]", r"field.rotation_axis.*zero vector"),
        ('rotation = [0, 0, "90 deg"]', 'rotation = [0, 0, "90 mm"]', r"field.rotation\[2\]"),
        ('rotation = [0, 0, "90 deg"]', 'rotation = "90 deg"', r"field.rotation: is not a list.*one angle"),
        ('name = "turn"', 'nam = "turn"', r"stages\[2\].nam: is an unknown key.*name"),
        ('control = "arc-length"', "branch = 1", r"stages\[2\].*needs arc-length"),
        ('control = "arc-length"', 'control = "arc-length"\nside = 2', r"stages\[2\].side"),
    ],
)
def test_faults_are_located(old, new, message):
    with pytest.raises(ms.InputError, match=message):
        built(changed(STAGED, (old, new)))
