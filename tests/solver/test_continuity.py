"""Which points are neighbours on one path."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from magshell.equations.instant import Increment
from magshell.shell.state import State
from magshell.solver import critical
from magshell.solver.constraints import LOAD_WEIGHT, Metric
from magshell.solver.continuity import length_along
from magshell.solver.newton import StepFailure
from magshell.solver.track import Point, Slope

METRIC = Metric(1.0)


def point(
    u: tuple[float, float], load_factor: float, slope: tuple[float, float, float], metric: Metric = METRIC
) -> Point:
    """Of one node in a plane."""
    state = State.undeformed(1, 1, 1)
    increment = np.zeros((1, 11))
    increment[0, :2] = slope[:2]
    length = METRIC.norm(increment[:, :3], slope[2])
    return Point(
        arc_length=0.0,
        load_factor=load_factor,
        state=state._replace(u=np.array([[*u, 0.0]])),
        slope=Slope(Increment(increment / length, np.zeros_like(state.alpha)), slope[2] / length),
        prediction=None,
        negative_pivots=0,
    )


@settings(deadline=None)
@given(angle=some.floats(0.01, 0.9))
def test_the_length_is_that_of_an_arc(angle: float) -> None:
    """A circle of radius 3 in the plane of u1 and ψ t."""
    ends = [
        point((3.0 * np.sin(one), 0.0), 3.0 * np.cos(one) / LOAD_WEIGHT, (np.cos(one), 0.0, -np.sin(one) / LOAD_WEIGHT))
        for one in (0.1, 0.1 + angle)
    ]
    assert length_along(METRIC, *ends) == pytest.approx(3.0 * angle, rel=1e-9)


def test_a_fold_that_is_jumped_over() -> None:
    """The load rises, or falls, at both ends, and hardly changes from one to the other."""
    for way in (1.0, -1.0):
        first, second = (point((x, 0.0), 0.0, (1.0, 0.0, 5.0 * way)) for x in (0.0, 1.0))
        with pytest.raises(StepFailure, match="jumps over a part of the path where the load factor"):
            length_along(METRIC, first, second)


def test_a_step_that_turns_back() -> None:
    first, second = point((0.0, 0.0), 0.0, (1.0, 0.0, 1.0)), point((1.0, 0.0), 1.0, (-1.0, 0.0, 1.0))
    with pytest.raises(StepFailure, match="turns back on it"):
        length_along(METRIC, first, second)


@pytest.mark.parametrize(("gap", "jumps"), [(0.0, False), (1e-3, True)])
def test_points_on_either_side_of_a_critical_point_are_neighbours(gap: float, jumps: bool) -> None:
    """Where two paths come close to each other a count of pivots may change between them without any critical point."""
    search = object.__new__(critical._Search)
    search.metric = METRIC
    sides = [point((x, y), x, (1.0, 0.0, 1.0)) for x, y in ((0.5, 0.0), (0.5001, gap))]
    search.known = {0.5: sides[0], 0.5001: sides[1]}
    if not jumps:
        search.check_gap(0.5, 0.5001)
        return
    with pytest.raises(StepFailure, match="from one path to another"):
        search.check_gap(0.5, 0.5001)
