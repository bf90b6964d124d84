"""A path with limit points, followed by load factor, arc length and displacement: one curve."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from magshell import InputError, Path, Settings, SolveError, Stage, solve
from magshell.solver import follower, step_control
from magshell.solver.constraints import LOAD_WEIGHT
from magshell.solver.newton import newton
from solver.arches import arch, loads, relative, sink, to_the_crown_at
from solver.models import Record

BY_ARC = Stage(control="arc-length")


@pytest.fixture(scope="module")
def by_arc() -> Path:
    return solve(arch([BY_ARC]))


def turns(values: np.ndarray) -> np.ndarray:
    """Numbers of the points where a sequence changes from rising to falling or back."""
    return np.flatnonzero(np.diff(np.sign(np.diff(values)))) + 1


@pytest.mark.parametrize("control", ["load", "arc-length"])
def test_the_path_falls_and_rises_again(control: str, snapped: Path, by_arc: Path) -> None:
    path = snapped if control == "load" else by_arc
    found = loads(path)
    first, second = turns(found)
    assert path.converged
    assert found[-1] == 1.0
    assert found[second] < 0.0 < found[first], f"load factors {found}"
    assert turns(sink(path)).size == 0, f"the crown always sinks: {sink(path)}"


def test_every_state_is_in_balance(snapped: Path) -> None:
    worst = max(step.balance.force_imbalance for step in snapped.steps[1:])
    assert worst < 1e-8, f"{worst:.1e}"


def test_load_factor_and_arc_length_lead_to_the_same_end(snapped: Path, by_arc: Path) -> None:
    apart = relative(by_arc.steps[-1].state.u, snapped.steps[-1].state.u)
    assert apart < 1e-8, f"{apart:.1e}"


def test_arc_length_is_that_of_the_curve(snapped: Path) -> None:
    """Of a path in short steps the chords add up to it."""
    fine = solve(arch([BY_ARC]), Settings(target_iterations=3, largest_step=0.01))
    mesh = fine.model.shell.mesh
    size = mesh.size * np.sqrt(len(mesh.points))
    points = [np.append(step.state.u.ravel() / size, LOAD_WEIGHT * step.load_factor) for step in fine.steps]
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    arcs = np.diff([step.arc_length for step in fine.steps])
    assert np.all(arcs >= chords * (1.0 - 1e-12))
    assert arcs.sum() == pytest.approx(chords.sum(), rel=1e-3), f"{len(chords)} steps"
    assert snapped.steps[-1].arc_length == pytest.approx(arcs.sum(), rel=1e-3), f"{len(snapped.steps) - 1} steps"


def test_stops_are_hit_by_arc_length_too() -> None:
    """The second one lies beyond the snap."""
    found = loads(solve(arch([Stage(control="arc-length", stops=(0.25, 0.75))])))
    at = [list(found).index(stop) for stop in (0.25, 0.75, 1.0)]
    assert at == sorted(at)
    assert turns(found[: at[0] + 1]).size == 0, "0.25 is met on the way up"
    assert turns(found[: at[1]]).size == 2


@pytest.mark.parametrize("part", [0.1, 0.4, 0.6, 0.9])
def test_displacement_control_meets_the_same_states(part: float, snapped: Path) -> None:
    """Also those between the limit points, where the load that holds the crown falls, and is negative in the end."""
    step = snapped.steps[int(part * len(snapped.steps))]
    node = snapped.model.probe_nodes["crown"]
    path = solve(arch([to_the_crown_at(-step.state.u[node, 2])]))
    last = path.steps[-1]
    assert path.converged
    assert last.state.u[node, 2] == pytest.approx(step.state.u[node, 2], rel=1e-12)
    assert turns(sink(path)).size == 0
    assert last.load_factor == pytest.approx(step.load_factor, abs=1e-8)
    apart = relative(last.state.u, step.state.u)
    assert apart < 1e-8, f"{apart:.1e} at load factor {step.load_factor:.4f}"


def test_displacement_control_pulls_where_the_load_would_push() -> None:
    """A target against the load's direction: the load factor becomes negative."""
    path = solve(arch([to_the_crown_at(-0.02)]))
    assert np.all(np.diff(loads(path)) < 0.0), loads(path)
    assert path.probe("crown").u3[-1] == pytest.approx(0.02, rel=1e-12)


def test_arc_length_to_a_displacement(snapped: Path) -> None:
    """The end of an arc-length stage may be a displacement in place of load factor 1."""
    depth = sink(snapped)[-1]
    path = solve(arch([Stage(control="arc-length", probe="crown", component=3, target=-depth)]))
    assert path.steps[-1].load_factor == pytest.approx(1.0, abs=1e-8)
    assert sink(path)[-1] == pytest.approx(depth, rel=1e-12)


@settings(max_examples=5, deadline=None, derandomize=True)
@given(
    first_step=some.floats(1e-4, 1.0),
    target_iterations=some.integers(3, 7),
    largest_step=some.floats(0.05, 1.0),
    control=some.sampled_from(["load", "arc-length"]),
)
def test_any_steps_lead_along_the_same_curve(
    snapped: Path, first_step: float, target_iterations: int, largest_step: float, control: str
) -> None:
    """To both limit points, which no two paths approach alike, and to the end."""
    chosen = Settings(
        first_step=min(first_step, largest_step), target_iterations=target_iterations, largest_step=largest_step
    )
    path = solve(arch([Stage(control=control)]), chosen)
    ours, theirs = ([point.load_factor for point in one.critical_points] for one in (path, snapped))
    assert ours == pytest.approx(theirs, abs=1e-7)
    apart = relative(path.steps[-1].state.u, snapped.steps[-1].state.u)
    assert apart < 1e-8, f"{apart:.1e} after {len(path.steps) - 1} steps"


@pytest.mark.parametrize("control", ["load", "arc-length"])
def test_a_run_that_turns_back_is_noticed(monkeypatch: pytest.MonkeyPatch, snapped: Path, control: str) -> None:
    """A step that converges to a state of the path before the last one is cut, and the path goes on as before."""
    solved, turned = [], []

    def turning(system, trial, constraint, report):
        if len(solved) == 5 and not turned:
            turned.append(solved[2])
            return newton(system, solved[2], None, report)
        solution = newton(system, trial, constraint, report)
        solved.append(solution.trial)
        return solution

    monkeypatch.setattr(follower, "newton", turning)
    record = Record()
    path = solve(arch([Stage(control=control)]), observers=[record])
    assert len(turned) == 1
    assert any(
        said in reason for _, reason in record.cuts for said in ("turns back", "not where the path was expected")
    )
    assert turns(sink(path)).size == 0
    assert relative(path.steps[-1].state.u, snapped.steps[-1].state.u) < 1e-8


def test_probe_that_a_support_holds() -> None:
    with pytest.raises(InputError, match="u1 of probe 'crown' is held by a support"):
        arch([Stage(control="displacement", probe="crown", component=1, target=0.01)])


@pytest.mark.parametrize("stage", [Stage(), BY_ARC], ids=["load", "arc-length"])
def test_a_path_that_wanders_ends_with_a_reason(monkeypatch: pytest.MonkeyPatch, stage: Stage) -> None:
    monkeypatch.setattr(step_control, "MOST_STEPS", 8)
    record = Record()
    with pytest.raises(
        SolveError, match=r"load factor .*: the last 8 steps came no nearer to the next stop, load factor 1"
    ) as caught:
        solve(arch([stage]), observers=[record])
    path = caught.value.path
    factors = loads(path)
    assert factors[-8:].max() - factors[-9] < 0.01 < factors[-9] - factors[-10]
    assert f"to and fro between {factors[-8:].min():.4g} and {factors[-8:].max():.4g}" in caught.value.reason
    assert path.steps == record.steps
    assert len(path.steps) > 8
    assert len(path.critical_points) == 1


def test_a_path_that_goes_back_far_behind_its_start_ends_under_load_control(monkeypatch: pytest.MonkeyPatch) -> None:
    """By arc length it goes on."""
    monkeypatch.setattr(follower, "BACK", 0.01)
    with pytest.raises(SolveError, match="went back behind the start of the stage") as caught:
        solve(arch([Stage()]))
    path = caught.value.path
    assert loads(path)[-1] < -0.01 <= loads(path)[-2]
    turn = path.critical_points[0]
    assert f"The load factor turned at {turn.load_factor:.6g} (critical point 1)" in caught.value.reason
    assert solve(arch([BY_ARC])).converged
