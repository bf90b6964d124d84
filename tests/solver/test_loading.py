"""The loading of a stage: rates are derivatives, stages join, stops lie where the field has their magnitudes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from magshell import Stage, UniformField
from magshell.model.course import Amounts, Course, Loading

NUMBER = some.floats(-2.0, 2.0)
VECTOR = some.tuples(NUMBER, NUMBER, NUMBER)


def amounts(field: float, angle: float, load: float) -> Amounts:
    return Amounts(np.array([field, angle]), np.array([load, -2.0 * load]), np.full((3, 11), 0.1 * load))


def course(start: Amounts, end: Amounts) -> Course:
    """A stage in a field that turns about the axis (1, 2, 2)/3."""
    field = UniformField((0.3, -0.4, 1.2), rotation_axis=(1, 2, 2), rotation=(0.0,))
    return Course(Stage(), field, start, end, np.zeros(3))


AMOUNTS = some.builds(amounts, NUMBER, some.floats(-4.0, 4.0), NUMBER)


@settings(deadline=None)
@given(start=AMOUNTS, end=AMOUNTS, at=some.floats(-0.5, 1.5))
def test_rate_is_the_derivative(start: Amounts, end: Amounts, at: float) -> None:
    one = course(start, end)
    step = 1e-4
    ahead, behind, rate = one.at(at + step), one.at(at - step), one.rate(at)
    for name, plus, minus, found in zip(Loading._fields, ahead, behind, rate, strict=True):
        # third derivatives of the field are at most (angle² × multiplier + 3 angle × change) × angle < 10³
        assert np.abs((plus - minus) / (2.0 * step) - found).max() < 1e-5, name


@settings(deadline=None)
@given(start=AMOUNTS, end=AMOUNTS)
def test_start_and_end(start: Amounts, end: Amounts) -> None:
    """A stage begins and ends with its amounts, and half-way it has their mean."""
    one = course(start, end)
    multiplier, angle = end.drives
    assert np.abs(one.at(1.0).flux_density - multiplier * one.field.turned(angle)).max() < 1e-14
    for ours, theirs in zip(one.at(0.0), Course(one.stage, one.field, end, start, np.zeros(3)).at(1.0), strict=True):
        assert np.abs(ours - theirs).max() < 1e-14
    assert np.abs(one.at(0.5).held - 0.5 * (start.held + end.held)).max() < 1e-15
    assert np.abs(one.at(0.5).loads - 0.5 * (start.loads + end.loads)).max() < 1e-15


@settings(deadline=None)
@given(field=some.floats(0.1, 2.0), start=some.floats(-4.0, 4.0), end=some.floats(-4.0, 4.0), at=some.floats(0.0, 1.0))
def test_a_turning_field_keeps_magnitude_and_share_of_the_axis(
    field: float, start: float, end: float, at: float
) -> None:
    one = course(amounts(field, start, 0.0), amounts(field, end, 0.0))
    found, axis = one.at(at).flux_density, np.array([1, 2, 2]) / 3.0
    assert np.linalg.norm(found) == pytest.approx(1.3 * field, rel=1e-13)
    assert found @ axis == pytest.approx(field * (one.field.vector @ axis), abs=1e-13)
    assert one.rate(at).flux_density @ found == pytest.approx(0.0, abs=1e-12)


@settings(deadline=None)
@given(start=NUMBER, end=NUMBER, stops=some.lists(some.floats(0.05, 2.4), max_size=3, unique=True))
def test_stops_are_where_the_field_has_their_magnitudes(start: float, end: float, stops: list[float]) -> None:
    """Every crossing of a magnitude by |B| in the stage is one, in rising order, and the end."""
    field = UniformField((0.3, -0.4, 1.2), sorted(stops), history=(2.0,))
    one = Course(Stage(stops=(0.3,)), field, amounts(start, 0.0, 0.0), amounts(end, 0.0, 0.0), np.zeros(3))
    found = one.stops()
    assert found == sorted(found)
    assert found[-1] == 1.0
    assert 0.3 in found or min(abs(stop - 0.3) for stop in found) < 1e-9
    for factor in set(found) - {1.0, 0.3}:
        magnitude = np.linalg.norm(one.at(factor).flux_density)
        assert min(abs(magnitude - stop) for stop in stops) < 1e-9, f"{magnitude} at {factor}"
    fine = np.linspace(0.0, 1.0, 2001)
    magnitudes = 1.3 * np.abs(start + fine * (end - start))
    for stop in stops:
        for at in np.flatnonzero(np.diff(np.sign(magnitudes - stop)) != 0):
            near = min(abs(factor - 0.5 * (fine[at] + fine[at + 1])) for factor in [0.0, *found])
            assert near < 1e-3, f"{stop} T is passed near {fine[at]}, stops {found}"


def test_stops_that_fall_together_are_one() -> None:
    one = Course(
        Stage(stops=(0.25, 0.5)), UniformField((0, 0, 1.0), (0.25, 0.75), history=(1.0,)),
        amounts(0.0, 0.0, 0.0), amounts(1.0, 0.0, 0.0), np.zeros(3),
    )  # fmt: skip
    assert one.stops() == [0.25, 0.5, 0.75, 1.0]


def test_sum_of_two_loadings() -> None:
    one = course(amounts(1.0, 0.5, 1.0), amounts(0.0, 0.0, 0.0)).at(0.0)
    other = course(amounts(0.5, 0.0, 2.0), amounts(0.0, 0.0, 0.0)).at(0.0)
    for total, first, second in zip(one.plus(other), one, other, strict=True):
        assert np.array_equal(total, first + second)
