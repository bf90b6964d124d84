"""Limit points and the count of negative pivots, against dense linear algebra and an independent search."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from magshell import Path, Settings, Stage, solve
from magshell.solver.critical import LIMIT_POINT, zero_between
from solver.arches import arch, dense_tangent, sink, to_the_crown_at
from solver.models import Record, strip


def scaled(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A symmetric matrix with a diagonal of ±1, and the factors of its rows and columns."""
    scale = 1.0 / np.sqrt(np.abs(matrix.diagonal()))
    return scale[:, None] * matrix * scale, scale


def test_two_limit_points_are_reported(snapped: Path) -> None:
    """The first where the arch loses its stability, the second where it has it again."""
    first, second = snapped.critical_points
    assert [point.kind for point in (first, second)] == [LIMIT_POINT] * 2
    assert [point.number for point in (first, second)] == [1, 2]
    assert [point.negative_pivots for point in (first, second)] == [(0, 1), (1, 0)]
    loads = np.array([step.load_factor for step in snapped.steps])
    arcs = np.array([step.arc_length for step in snapped.steps])
    after = np.searchsorted(arcs, first.arc_length)
    assert loads[: after + 1].max() <= first.load_factor
    after = np.searchsorted(arcs, second.arc_length)
    assert loads[after - 1 :].min() >= second.load_factor


def test_observers_hear_of_critical_points_after_the_step_beyond() -> None:
    class Critical(Record):
        def critical(self, point):
            self.calls.append(f"critical {point.number}")

    record = Critical()
    path = solve(arch(), observers=[record])
    for point in path.critical_points:
        at = record.calls.index(f"critical {point.number}")
        told = record.calls[:at].count("converged")
        assert path.steps[told - 2].arc_length < point.arc_length < path.steps[told - 1].arc_length


@pytest.mark.parametrize("number", [0, 1])
def test_load_at_a_limit_point(number: int, snapped: Path) -> None:
    """The vertex of the parabola through three states beside it, found by holding the crown at their depths.

    Its error is of the fourth order in their distance, which is half a percent of the depth.
    """
    point = snapped.critical_points[number]
    depth = -point.state.u[snapped.model.probe_nodes["crown"], 2]
    depths = depth * np.array([0.995, 1.0, 1.005])
    path = solve(arch([to_the_crown_at(at) for at in depths]))
    ends = [[step for step in path.steps if step.stage == stage][-1] for stage in range(3)]
    loads = [path.loading(step).loads[0] for step in ends]
    a, b, c = np.polyfit(depths - depth, loads, 2)
    vertex = c - b**2 / (4.0 * a)
    assert abs(vertex - point.load_factor) < 1e-9, f"parabola {vertex:.12f}, located {point.load_factor:.12f}"
    assert abs(b / (2.0 * a)) < 1e-4 * depth, f"the crown is off by {-b / (2.0 * a):.1e}"


@pytest.mark.parametrize("number", [0, 1])
def test_mode_is_the_direction_without_stiffness(number: int, snapped: Path) -> None:
    """Against the eigenvector of the dense tangent; its eigenvalue is zero beside the next."""
    point, discretisation = snapped.critical_points[number], snapped.discretisation
    matrix, scale = scaled(dense_tangent(snapped, point.state, snapped.courses[0].at(point.load_factor)))
    values, vectors = np.linalg.eigh(matrix)
    order = np.argsort(np.abs(values))
    least, following = values[order[:2]]
    assert abs(least) < 1e-5 * abs(following), f"eigenvalues {least:.2e} and {following:.2e}"
    expected = discretisation.direction(scale * vectors[:, order[0]]).nodal
    cosine = np.vdot(expected, point.mode) / (np.linalg.norm(expected) * np.linalg.norm(point.mode))
    assert abs(cosine) > 1.0 - 1e-8, f"1 - cosine {1.0 - abs(cosine):.1e}"
    assert np.linalg.norm(point.mode[:, :3], axis=1).max() == pytest.approx(1.0, rel=1e-12)
    assert np.abs(discretisation.to_frames(point.mode)[snapped.model.constraints.fixed]).max() == 0.0


def test_negative_pivots_are_negative_eigenvalues(snapped: Path) -> None:
    """Along the whole snap-through, by Sylvester's law; also of dense eigenvalues of another scaling."""
    found = []
    for step in snapped.steps:
        tangent = dense_tangent(snapped, step.state, snapped.loading(step))
        found.append(np.count_nonzero(np.linalg.eigvalsh(scaled(tangent)[0]) < 0.0))
    assert [step.negative_pivots for step in snapped.steps] == found
    assert set(found) == {0, 1}


def test_odd_pivots_are_a_negative_determinant() -> None:
    """Without a potential the tangent is not symmetric, but the product of the pivots still is its determinant."""
    path = solve(strip((4, 1), field=(-50e-3, 0, 0)), Settings(largest_step=0.2))
    counts = [step.negative_pivots for step in path.steps]
    assert {0, 1} <= set(counts), counts
    for step in path.steps:
        tangent, _ = scaled(dense_tangent(path, step.state, path.loading(step)))
        assert np.abs(tangent - tangent.T).max() > 1e-6 or step.number == 0
        assert np.linalg.slogdet(tangent)[0] == (-1.0) ** step.negative_pivots, f"step {step.number}"


def test_pivots_count_while_the_load_is_taken_off() -> None:
    """Between the limit points the arch stays unstable, whichever way the load goes."""
    stages = [to_the_crown_at(0.25), Stage(control="displacement", probe="crown", component=3, target=-0.05)]
    path = solve(arch(stages))
    assert [point.negative_pivots for point in path.critical_points] == [(0, 1), (1, 0)]
    ours, theirs = (point.load_factor for point in path.critical_points)
    assert path.steps[-1].negative_pivots == 0
    assert sink(path)[-1] == pytest.approx(0.05, rel=1e-12)
    first, second = path.courses
    there = first.at(ours).loads[0], second.at(theirs).loads[0]
    assert there[0] == pytest.approx(there[1], rel=1e-8), "the same limit point, met from both sides"


@given(
    values=st.lists(st.sampled_from([0.0, 0.5, 1.0]) | st.floats(0.0, 1e-3), min_size=2, max_size=6),
    crossing=st.integers(1, 5),
)
def test_the_root_of_any_values_lies_between_the_ends(values: list[float], crossing: int) -> None:
    """Where two are equal, as those of an element that has a mode without energy may be, as where all differ."""
    crossing = min(crossing, len(values) - 1)
    signed = values[:crossing] + [-value for value in values[crossing:]]
    root = zero_between(dict(zip(np.arange(6.0).tolist(), signed, strict=False)), crossing - 1.0, float(crossing))
    assert crossing - 1.0 <= root <= crossing, root


def test_the_root_of_a_smooth_function() -> None:
    """Inverse interpolation by four values is exact for a function whose inverse is cubic."""
    at = np.array([-1.0, -0.4, 0.3, 1.1])
    distances = 2.0 + 3.0 * at + 0.5 * at**2 + 0.7 * at**3
    root = zero_between(dict(zip(distances.tolist(), at.tolist(), strict=True)), distances[1], distances[2])
    assert root == pytest.approx(2.0, rel=1e-12)
