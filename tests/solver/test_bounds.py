"""Every loop of the solver ends, with a reason: cuts, steps to a goal, the search for critical points."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

import magshell as ms
from magshell import Settings, SolveError, solve
from magshell.solver import critical, step_control
from magshell.solver.follower import Follower
from magshell.solver.newton import StepFailure
from magshell.solver.step_control import stagnant
from solver.models import Record, strip


def turning(stops: int) -> ms.Model:
    """A strip in a field that turns once around, with dense stops."""
    mesh = ms.mesh.rectangle(17.2e-3, 5e-3, (8, 1))
    material = ms.MicropolarNeoHookean(303e3, 7300e3, 30.3e3, 0.84e-4)
    shell = ms.Shell(mesh, 0.84e-3, material, ms.remanence.constant((0.143, 0, 0)))
    field = ms.UniformField((3e-3, 0, 0), history=[1, 1], rotation_axis=(0, 1, 0), rotation=[0, 2 * math.pi])
    stages = [ms.Stage(), ms.Stage(stops=[number / stops for number in range(1, stops)])]
    return ms.Model(shell, [ms.Clamp("left")], field, stages=stages)


def test_dense_stops_do_not_hold_up_a_path() -> None:
    """With 144 stops one step, to where the load had turned round, used to fail for ever."""
    path = solve(turning(144))
    first = next(step for step in reversed(path.steps) if step.stage == 0)
    largest = max(float(np.abs(step.state.u).max()) for step in path.steps)
    assert np.abs(path.steps[-1].state.u - first.state.u).max() < 1e-9 * largest
    assert largest > 5e-3
    assert len(path.steps) - 1 <= 170, f"{len(path.steps) - 1} steps"


def test_stops_may_lie_as_close_as_round_off() -> None:
    """The path through the last points is not carried on from the round-off of two that are 4e-12 apart."""
    plain = solve(strip())
    close = solve(strip(stops=[10e-3, 10e-3 + 8e-14]))
    assert close.cuts == plain.cuts == 0
    assert np.abs(close.steps[-1].state.u - plain.steps[-1].state.u).max() < 1e-10


@settings(max_examples=6, deadline=None, derandomize=True)
@given(last=some.integers(1, 60), smallest=some.sampled_from([1e-6, 1e-4]))
def test_failures_in_a_row_have_an_end(last: int, smallest: float) -> None:
    """Whatever was solved before, a step that always fails is at most halved and a third longer, and given up."""
    lengths: list[float] = []
    solved = 0

    class Failing(Follower):
        def _solved(self, attempt, goal):
            nonlocal solved
            if solved < last:
                found = super()._solved(attempt, goal)
                solved += found is not None
                return found
            lengths.append(attempt.intended)
            self.failure = StepFailure("meant to")
            return None

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.solver.stepping.Follower", Failing)
        with pytest.raises(SolveError, match="still fails: meant to"):
            solve(turning(96), Settings(smallest_step=smallest))
    assert all(after <= 0.66 * before for before, after in pairwise(lengths)), lengths
    assert len(lengths) <= 2 + math.log(lengths[0] / smallest) / math.log(1.0 / 0.65), len(lengths)


def test_a_trial_that_is_not_finite_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step_control, "CUT", math.nan)
    record = Record()
    with pytest.raises(SolveError, match="after 1 cut the step"):
        solve(strip(field=(0, 0, 1e3)), Settings(), [record])
    assert len(record.cuts) == 1


@pytest.mark.parametrize(("largest", "strays"), [(1.0, True), (5e-5, False)])
def test_small_steps_that_were_asked_for_are_progress(largest: float, strays: bool) -> None:
    """Half a hundredth of the way in a hundred steps: little, and all that such a largest step allows."""
    values = [5e-5 * number for number in range(1, 200)]
    assert list(stagnant(values, 1.0, largest)) == (values[-100:] if strays else [])


def test_bifurcations_without_end_cut_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """A count of negative pivots that never settles is no reason to search for ever."""
    search = object.__new__(critical._Search)
    counts = iter(range(1000))

    class Point:
        def __init__(self) -> None:
            self.negative_pivots = next(counts)

    monkeypatch.setattr(critical._Search, "seen", lambda self, distance: Point())
    monkeypatch.setattr(critical._Search, "singular", lambda self, low, high: (low, 0.5 * (low + high), low))
    monkeypatch.setattr(critical._Search, "check_gap", lambda self, below, above: None)
    monkeypatch.setattr(critical._Search, "between", lambda self, below, above, at: at)
    with pytest.raises(StepFailure, match="more than 10 bifurcations lie within one step"):
        list(search.bifurcations(0.0, 1.0))


def test_newton_ends_after_its_iterations() -> None:
    """Whatever the trial is."""
    record = Record()
    with pytest.raises(SolveError):
        solve(strip(field=(0, 0, 1e3)), Settings(max_iterations=3, smallest_step=5e-3), [record])
    assert max(iteration.iteration for iteration in record.iterations) <= 3
