"""The path as a polynomial in the arc length: exact for cubics, also of rotations, and where it meets a value."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as some

import magshell as ms
from magshell import Path, solve
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Increment, Instant, Prediction, difference
from magshell.shell import rotation
from magshell.shell.state import State
from magshell.solver.constraints import Metric
from magshell.solver.track import Point, Slope, arc, crossing, trial_at, value_at
from solver.models import strip

COEFFICIENTS = some.lists(some.floats(-2.0, 2.0), min_size=4, max_size=4)
# Of numbers that are zero: no strip has stretches of directors.
SMALL = 1e-9
GAPS = some.tuples(some.floats(0.1, 3.0), some.floats(0.1, 3.0))


def at(*arc_lengths: float) -> list[SimpleNamespace]:
    """Points that are nothing but arc lengths."""
    return [SimpleNamespace(arc_length=arc_length) for arc_length in arc_lengths]


def sampled(
    coefficients: list[float], gaps: tuple[float, float], points: int
) -> tuple[list[SimpleNamespace], list[float], float]:
    """The last points of a track up to arc length 1, a polynomial's values there and its slope at the last.

    Of the degree that so many points and one slope determine.
    """
    arc_lengths = [1.0 - gaps[0] - gaps[1], 1.0 - gaps[1], 1.0][-points:]
    polynomial = coefficients[3 - points :]
    slope = float(np.polyval(np.polyder(polynomial), 1.0))
    return at(*arc_lengths), [float(np.polyval(polynomial, s)) for s in arc_lengths], slope


@settings(deadline=None)
@given(coefficients=COEFFICIENTS, gaps=GAPS, distance=some.floats(0.0, 3.0), points=some.integers(1, 3))
def test_polynomials_are_continued_exactly(
    coefficients: list[float], gaps: tuple[float, float], distance: float, points: int
) -> None:
    """Straight from one point on, square from two, cubic from three."""
    track, values, slope = sampled(coefficients, gaps, points)
    exact = np.polyval(coefficients[3 - points :], 1.0 + distance)
    found = value_at(track, values, slope, distance)
    # Lagrange's weights grow with the distance over the least gap
    scale = 10.0 * (1.0 + distance / min(gaps)) ** 3 * (1.0 + max(abs(value) for value in values))
    assert found == pytest.approx(exact, abs=1e-14 * scale)


@settings(deadline=None)
@given(coefficients=COEFFICIENTS, gaps=GAPS, wanted=some.floats(-3.0, 3.0), longest=some.floats(0.1, 4.0))
def test_crossing_is_the_first_root(
    coefficients: list[float], gaps: tuple[float, float], wanted: float, longest: float
) -> None:
    track, values, slope = sampled(coefficients, gaps, 3)
    fine = np.linspace(0.0, longest, 4001)[1:]
    above = np.polyval(coefficients, 1.0 + fine) - wanted
    # where a root is double, at the start or at the end, round-off decides
    assume(np.abs(above).min() > 1e-4 or np.count_nonzero(np.diff(np.sign(above))))
    assume(abs(values[-1] - wanted) > 1e-3 and abs(above[-1]) > 1e-3)
    found = crossing(track, values, slope, wanted, longest)
    changes = np.flatnonzero(np.sign(above) != np.sign(values[-1] - wanted))
    if changes.size == 0:
        if found is not None:  # a pair of roots between two points of the fine grid
            assert np.polyval(coefficients, 1.0 + found) == pytest.approx(wanted, abs=1e-6)
        return
    assert found is not None
    assert np.polyval(coefficients, 1.0 + found) == pytest.approx(wanted, abs=1e-8)
    assert found <= fine[changes[0]] + 1e-6


def test_crossing_on_a_straight_line() -> None:
    track = at(0.0)
    assert crossing(track, [1.0], 2.0, 2.0, 4.0) == pytest.approx(0.5, rel=1e-12)
    assert crossing(track, [1.0], 2.0, 2.0, 0.4) is None
    assert crossing(track, [1.0], -2.0, 2.0, 4.0) is None
    assert crossing(track, [1.0], 0.0, 1.5, 4.0) is None


@pytest.fixture(scope="module")
def path() -> Path:
    """Of a strip whose end is turned and pushed, to have supports that move."""
    supports = [ms.Clamp("left"), ms.Prescribe("right", "omega", 2, 0.4), ms.Prescribe("right", "u", 2, 1e-4)]
    return solve(strip((2, 1), supports, field=(0, 0, 0)))


def own_stresses(discretisation: Discretisation, state: State) -> Prediction:
    """Those of a state; without layers they do not depend on the loading."""
    return discretisation.predicted(Instant(state, discretisation.model.loading(0.0)))


def cubic_track(path: Path) -> tuple[list[Point], object]:
    """Three points on a cubic path of states, rotations about an axis of each node's own; and the states as a function.

    Supports hold their nodes where the load factor, which is cubic too, wants them.
    """
    discretisation, course = path.discretisation, path.courses[0]
    rng = np.random.default_rng(11)
    start = path.steps[-1].state
    held = path.model.constraints.fixed
    size = np.array([1e-4] * 6 + [1.0] + [0.1] * 3 + [1e-2])
    axis = np.where(held[:, 7:10].any(axis=1)[:, None], [0.0, 1.0, 0.0], rng.normal(size=(len(start.u), 3)))
    load = np.array([0.02, -0.05, 0.3, 0.2])
    coefficients = rng.normal(size=(4, len(start.u), 11)) * size * discretisation.carried
    coefficients[:, :, 7:10] = axis * coefficients[:, :, 7:8] * discretisation.carried[:, 7:10]
    coefficients = np.where(held, load[:, None, None] * course.end.held, coefficients)
    for_alpha = 1e-3 * rng.normal(size=(4, *start.alpha.shape))

    def state_at(s: float) -> State:
        nodal = np.polynomial.polynomial.polyval(s, coefficients[::-1])
        return discretisation.undeformed().moved(nodal, np.polynomial.polynomial.polyval(s, for_alpha[::-1]))

    def point(s: float) -> Point:
        increment = np.polynomial.polynomial.polyval(s, np.polynomial.polynomial.polyder(coefficients[::-1]))
        d_alpha = np.polynomial.polynomial.polyval(s, np.polynomial.polynomial.polyder(for_alpha[::-1]))
        state = state_at(s)
        slope = Slope(Increment(increment, d_alpha), float(np.polyval(np.polyder(load), s)))
        return Point(s, float(np.polyval(load, s)), state, slope, own_stresses(discretisation, state), 0)

    return [point(s) for s in (0.3, 0.8, 1.0)], lambda s: (state_at(s), float(np.polyval(load, s)))


@pytest.mark.parametrize("distance", [0.05, 0.4, 1.0])
def test_states_are_continued_exactly(path: Path, distance: float) -> None:
    """Rotations about fixed axes included, and supports are where the load factor wants them."""
    track, exact = cubic_track(path)
    trial = trial_at(path.discretisation, path.courses[0], track, distance)
    state, load_factor = exact(1.0 + distance)
    assert trial.load_factor == pytest.approx(load_factor, rel=1e-12)
    for name, ours, theirs in zip(State._fields, trial.state, state, strict=True):
        if name == "q":
            ours, theirs = rotation.matrix(ours), rotation.matrix(theirs)
        apart = np.abs(ours - theirs).max() / max(np.abs(theirs).max(), SMALL)
        assert apart < 1e-11, f"{name}: {apart:.1e}"


def test_supports_follow_a_load_factor_that_is_given(path: Path) -> None:
    track, _ = cubic_track(path)
    load_factor = track[-1].load_factor + 0.123
    trial = trial_at(path.discretisation, path.courses[0], track, 0.4, load_factor)
    mesh = path.model.shell.mesh
    right, left = mesh.nodes_of("right"), mesh.nodes_of("left")
    turning = right[path.discretisation.carried[right, 7]]
    assert np.abs(trial.state.u[right, 1] - load_factor * 1e-4).max() < 1e-15
    spin = rotation.logarithm(trial.state.q[turning])
    assert np.abs(spin - [0.0, load_factor * 0.4, 0.0]).max() < 1e-15
    assert np.abs(trial.state.u[left]).max() == 0.0
    assert trial.load_factor == load_factor


def test_stresses_ahead_are_no_farther_off_than_third_order(path: Path) -> None:
    """Of a path that the polynomial of the states meets exactly: halving all distances divides the error by 8."""
    discretisation, course = path.discretisation, path.courses[0]
    _, exact = cubic_track(path)

    def error(size: float) -> float:
        """With points at 1 - 2 size, 1 - size and 1, a step of the size ahead."""
        points = []
        for s in (1.0 - 2.0 * size, 1.0 - size, 1.0):
            state, load_factor = exact(s)
            ahead, behind = exact(s + 1e-4)[0], exact(s - 1e-4)[0]
            slope = Slope((difference(ahead, state) + -difference(behind, state)) * (1.0 / 2e-4), 1.0)
            points.append(Point(s, load_factor, state, slope, own_stresses(discretisation, state), 0))
        trial = trial_at(discretisation, course, points, size)
        own = own_stresses(discretisation, exact(1.0 + size)[0])
        return float(np.abs(trial.prediction.S - own.S).max())

    coarse, fine = error(0.2), error(0.1)
    assert coarse / fine > 2.0**2.8, f"{coarse:.2e} and {fine:.2e} Pa"


def test_arc_of_a_circle() -> None:
    """A quarter of a circle of radius 2, in displacements of one node of a body of size 1."""
    metric = Metric(1.0)
    tangent = [np.array([[0.0, 1.0, 0.0]]), np.array([[-1.0, 0.0, 0.0]])]
    slopes = [Slope(Increment(np.hstack([one, np.zeros((1, 7))]), np.zeros((1, 0, 3))), 0.0) for one in tangent]
    chord = np.array([[-2.0, 2.0, 0.0]]), 0.0
    assert arc(metric, chord, *slopes) == pytest.approx(np.pi, rel=1e-14)
    assert arc(metric, chord, slopes[0], slopes[0]) == pytest.approx(np.sqrt(8.0), rel=1e-14)
