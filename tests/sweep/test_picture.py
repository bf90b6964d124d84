"""What the picture of a sweep shows."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from magshell.problem.alternatives import Setting, read_settings
from magshell.problem.reading import Source
from magshell.sweep.grid import Cell
from magshell.sweep.outcomes import Outcome
from magshell.sweep.picture import draw_sweep

Drawn = Callable[..., Figure]


def moved(*numbers: float) -> float:
    """A displacement, m."""
    return 1e-3 * math.prod(number + 1.0 for number in numbers)


def cells(*texts: str, probes: tuple[str, ...] = ("tip",)) -> tuple[list[Setting], list[Cell], dict[int, Outcome]]:
    settings = read_settings(texts)
    combinations = itertools.product(*(setting.values for setting in settings))
    made = [
        Cell(number, values, "", Source("", "", Path()), probes) for number, values in enumerate(combinations, start=1)
    ]
    outcomes = {}
    for cell in made:
        numbers = [len(value.text) if value.number is None else value.number for value in cell.values]
        ends = {probe: [1e-9, -0.5 * moved(*numbers), scale * moved(*numbers)] for scale, probe in enumerate(probes, 1)}
        outcomes[cell.number] = Outcome(True, "", {"probes": ends})
    return settings, made, outcomes


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Drawn:
    def draw(*arguments: Any) -> Figure:
        figures: list[Figure] = []
        monkeypatch.setattr("magshell.sweep.picture.deliver", lambda figure, file: figures.append(figure))
        assert draw_sweep(*arguments, "sweep.png") == ""
        return figures[0]

    return draw


def curves(figure: Figure) -> dict[str, tuple[list[float], list[float]]]:
    lines = [line for line in figure.axes[0].lines if not line.get_label().startswith("_")]
    return {line.get_label(): (line.get_xdata().tolist(), line.get_ydata().tolist()) for line in lines}


def test_one_number_every_component_that_matters(drawn: Drawn) -> None:
    settings, made, outcomes = cells("shell.thickness=1.2,0.8,1 mm", probes=("tip", "mid"))
    figure = drawn(settings, made, outcomes)
    assert figure.axes[0].get_xlabel() == "shell.thickness (mm)"
    assert figure.axes[0].get_ylabel() == "displacement (mm)"
    found = curves(figure)
    assert list(found) == ["mid  $u_3$", "tip  $u_3$", "tip  $u_2$", "mid  $u_2$"]
    x, y = found["mid  $u_3$"]
    assert x == pytest.approx([0.8, 1.0, 1.2])
    assert y == pytest.approx([2e3 * moved(1e-3 * h) for h in (0.8, 1.0, 1.2)])


def test_a_cell_that_failed_is_a_gap(drawn: Drawn) -> None:
    settings, made, outcomes = cells("shell.thickness=0.8,1,1.2 mm")
    outcomes[2] = Outcome(False, "no", {"probes": {"tip": [1.0, 1.0, 1.0]}})
    _, y = curves(drawn(settings, made, outcomes))["tip  $u_3$"]
    assert np.isnan(y).tolist() == [False, True, False]


def test_a_family_of_curves(drawn: Drawn) -> None:
    """Against the number with most values, a curve for each combination of the others; constants are left out."""
    settings, made, outcomes = cells(
        "shell.element=paper,quadratic", "field.flux_density=0 mT:50 mT:3", "shell.thickness=0.4,0.8 mm", "solver.x=3"
    )
    figure = drawn(settings, made, outcomes)
    assert figure.axes[0].get_xlabel() == "field.flux_density (mT)"
    assert figure.axes[0].get_ylabel() == "tip  $u_3$  (mm)"
    found = curves(figure)
    assert list(found) == ["paper, 0.4 mm", "paper, 0.8 mm", "quadratic, 0.4 mm", "quadratic, 0.8 mm"]
    x, y = found["quadratic, 0.8 mm"]
    assert x == pytest.approx([0.0, 25.0, 50.0])
    assert y == pytest.approx([1e3 * moved(9, b, 0.8e-3, 3) for b in (0.0, 25e-3, 50e-3)])


def test_many_values_of_two_numbers_are_a_map(drawn: Drawn) -> None:
    settings, made, outcomes = cells("shell.thickness=1 mm:2 mm:9", "field.flux_density=0 mT:50 mT:11")
    del outcomes[1]
    figure = drawn(settings, made, outcomes)
    axes = figure.axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("field.flux_density (mT)", "shell.thickness (mm)")
    values = axes.collections[0].get_array().reshape(9, 11)
    assert values[8, 10] == pytest.approx(1e3 * moved(2e-3, 50e-3))
    assert values[8, 0] == pytest.approx(1e3 * moved(2e-3, 0.0))
    assert np.ma.getmaskarray(np.ma.masked_invalid(values)).sum() == 1, "the cell that is missing"


@pytest.mark.parametrize(
    ("texts", "probes", "words"),
    [
        (["shell.element=paper,quadratic"], ("tip",), "no setting has several numbers"),
        (["shell.thickness=1 mm"], ("tip",), "no setting has several numbers"),
        (["shell.thickness=1,2 mm"], (), "no probes"),
        (["a=1:9:9", "b=1:9:9", "c=1:9:9"], ("tip",), "too many combinations"),
    ],
)
def test_no_picture(texts: list[str], probes: tuple[str, ...], words: str, tmp_path: Path) -> None:
    assert words in draw_sweep(*cells(*texts, probes=probes), tmp_path / "sweep.png")
    assert not (tmp_path / "sweep.png").exists()


def test_nothing_solved(tmp_path: Path) -> None:
    settings, made, _ = cells("shell.thickness=1,2 mm")
    assert draw_sweep(settings, made, {}, tmp_path / "sweep.png") == "no probe has moved"


def test_the_file(tmp_path: Path) -> None:
    """Also with names that matplotlib could take for mathematics."""
    assert draw_sweep(*cells("mesh.edge_groups.a$b.x1=1,2 mm", probes=("A",)), tmp_path / "sweep.png") == ""
    assert (tmp_path / "sweep.png").read_bytes()[:4] == b"\x89PNG"
