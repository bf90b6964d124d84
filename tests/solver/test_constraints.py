"""Metric and constraints: distance, sphere, displacement."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from magshell.shell.state import State
from magshell.solver.constraints import LOAD_WEIGHT, Metric, NoRoot, ProbeValue, Sphere

NODES = 4
METRIC = Metric(1.0 / (NODES * 2.0**2))


def random_directions(seed: int) -> tuple[State, np.ndarray, np.ndarray, np.ndarray]:
    """An undeformed state, a chord (nodes, 3) and two increments (nodes, 11)."""
    rng = np.random.default_rng(seed)
    first, second = rng.normal(size=(2, NODES, 3))
    return State.undeformed(NODES, 1, 0), rng.normal(size=(NODES, 3)), first, second


def test_metric() -> None:
    """Root mean square of the displacements over the body's size, and a share of the load factor."""
    u = np.full((NODES, 3), [3.0, 0.0, 4.0])
    assert METRIC.norm(u, 0.0) == pytest.approx(5.0 / 2.0, rel=1e-15)
    assert METRIC.norm(0.0 * u, -2.0) == pytest.approx(2.0 * LOAD_WEIGHT, rel=1e-15)
    assert METRIC.product((u, 1.0), (-u, 1.0)) == pytest.approx(LOAD_WEIGHT**2 - 6.25, rel=1e-14)


@settings(deadline=None)
@given(seed=some.integers(0, 1000), size=some.floats(1e-6, 0.3), load=some.floats(-2.0, 2.0))
def test_sphere_is_met_on_the_side_of_the_trial(seed: int, size: float, load: float) -> None:
    """From a trial state on it: as far away as that, and ahead."""
    start, ahead, increment, per_load = random_directions(seed)
    # the load moves the body along the path, but not only
    per_load += 2.0 * ahead * np.sign(load or 1.0)
    radius = METRIC.norm(ahead, load)
    increment *= size * radius / METRIC.norm(increment, 0.0)
    sphere = Sphere(METRIC, start.u, 0.25, ahead, load, radius)
    trial = start._replace(u=start.u + ahead)
    d_load = sphere.d_load(trial, 0.25 + load, increment, per_load)
    moved = ahead + increment + d_load * per_load
    slope = per_load, 1.0
    # where the increment alone would miss, the closest value is taken: there the two are normal to each other
    away = ahead + increment, load
    closest = METRIC.norm(*away) ** 2 - METRIC.product(away, slope) ** 2 / METRIC.product(slope, slope)
    if closest < radius**2 * (1.0 - 1e-9):
        assert METRIC.norm(moved, load + d_load) == pytest.approx(radius, rel=1e-9)
        forwards = METRIC.product(slope, (moved, load + d_load)) * METRIC.product(slope, (ahead, load))
        assert forwards > 0.0
    elif closest > radius**2 * (1.0 + 1e-9):
        assert METRIC.product(slope, (moved, load + d_load)) == pytest.approx(0.0, abs=1e-9)


def test_sphere_that_is_missed_is_met_as_closely_as_can_be() -> None:
    start, ahead, _, per_load = random_directions(3)
    sphere = Sphere(METRIC, start.u, 0.0, ahead, 1.0, METRIC.norm(ahead, 1.0))
    trial = start._replace(u=start.u + ahead)
    far = np.full((NODES, 3), 100.0)
    best = sphere.d_load(trial, 1.0, far, per_load)

    def distance(d_load: float) -> float:
        return METRIC.norm(ahead + far + d_load * per_load, 1.0 + d_load)

    assert distance(best) > sphere.radius
    for other in (best - 0.1, best + 0.1):
        assert distance(other) > distance(best)


@settings(deadline=None)
@given(seed=some.integers(0, 1000), wanted=some.floats(-3.0, 3.0))
def test_displacement_is_met(seed: int, wanted: float) -> None:
    start, ahead, increment, per_load = random_directions(seed)
    per_load[2, 1] = np.copysign(max(abs(per_load[2, 1]), 0.1), per_load[2, 1])
    trial = start._replace(u=start.u + ahead)
    d_load = ProbeValue(2, 1, wanted).d_load(trial, 0.3, increment, per_load)
    assert (trial.u + increment + d_load * per_load)[2, 1] == pytest.approx(wanted, abs=1e-12)


def test_displacement_that_the_load_leaves_alone() -> None:
    start, _, increment, per_load = random_directions(1)
    per_load[2, 1] = 0.0
    with pytest.raises(NoRoot, match="the load does not move the probe"):
        ProbeValue(2, 1, 0.1).d_load(start, 0.3, increment, per_load)
