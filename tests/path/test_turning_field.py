"""A thin strip on three points in a field that turns once around: past buckling, and back to where it started."""

from __future__ import annotations

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from path_study.turning import held

import magshell as ms

HOLD = "at both corners of one end and the middle of the other"


@pytest.fixture(scope="module")
def around() -> ms.Path:
    return ms.solve(held(HOLD, (8, 1)))


def test_the_path_does_not_go_over_to_another(around: ms.Path) -> None:
    """Two paths come close near 0.6 and near 0.4; a step across made this one run back to -0.49 of the turn."""
    turned = np.array([step.load_factor for step in around.steps if step.stage == 1])
    assert around.converged
    assert turned.min() > 0.0
    assert np.maximum(-np.diff(turned), 0.0).sum() < 0.2, "it runs back between its two limit points alone"
    largest = max(float(np.abs(step.state.u).max()) for step in around.steps)
    assert largest > 3e-3
    assert np.abs(around.steps[-1].state.u).max() < 1e-8 * largest


def test_critical_points_come_in_mirrored_pairs(around: ms.Path) -> None:
    """The field turned the other way is the mirror image, so that the path is its own with t and 1 - t exchanged."""
    kinds = [point.kind for point in around.critical_points]
    assert kinds == ["bifurcation", "bifurcation", "limit point", "limit point", "bifurcation", "bifurcation"]
    factors = np.array([point.load_factor for point in around.critical_points])
    assert factors + factors[::-1] == pytest.approx(1.0, abs=1e-8)
    assert [point.negative_pivots for point in around.critical_points] == [(0, 1), (1, 0)] * 3
