"""A step that fails is cut: nothing of it is left, and the result is the same."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

import magshell as ms
from magshell import Path, Settings, solve
from magshell.solver import follower
from magshell.solver.newton import StepFailure, newton
from solver.models import LENGTH, Record, arm, contents, last_correction, strip


def same_end(one: Path, other: Path) -> tuple[float, float]:
    """Largest distance of the final displacements, and how far it may be by what each path left unsolved, m.

    To first order a state is off by its last Newton correction; corrections near round-off are known to a factor.
    """
    distance = np.abs(one.steps[-1].state.u - other.steps[-1].state.u).max()
    return float(distance), 2.0 * (last_correction(one) + last_correction(other)) + 1e-13 * LENGTH


@pytest.mark.parametrize("failing", [1, 2, 4], ids="attempt {}".format)
def test_cut_step_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch, failing: int) -> None:
    """A step that fails after its work is done, and one that fails before it: the same path to the last bit."""

    def path(work_first: bool) -> Path:
        attempts = itertools.count(1)

        def failing_newton(system, trial, constraint, report):
            fails = next(attempts) == failing
            solution = newton(system, trial, constraint, report) if work_first or not fails else None
            if fails:
                raise StepFailure("meant to")
            return solution

        monkeypatch.setattr(follower, "newton", failing_newton)
        record = Record()
        result = solve(strip(), observers=[record])
        assert (record.cuts[0][1], len(record.steps[:failing])) == ("meant to", failing)
        return result

    late, early = path(work_first=True), path(work_first=False)
    assert late.cuts == early.cuts
    assert [step.load_factor for step in late.steps] == [step.load_factor for step in early.steps]
    for ours, theirs in zip(late.steps, early.steps, strict=True):
        assert contents(ours.state) == contents(theirs.state), f"step {ours.number} differs"


@pytest.mark.parametrize("model", [strip(), arm()], ids=["strip", "arm"])
def test_cuts_on_the_way_change_neither_earlier_states_nor_the_end(model: ms.Model) -> None:
    record = Record()
    hasty = solve(model, Settings(first_step=0.3, target_iterations=11), [record])
    assert any(at > record.steps[1].load_factor for at, _ in record.cuts), f"no cut on the way: {record.cuts}"
    assert [contents(step.state) for step in hasty.steps] == record.bytes, "a converged state was changed later"
    careful = solve(model, Settings(first_step=0.003, largest_step=0.1))
    assert careful.cuts == 0, f"{careful.cuts} cuts"
    distance, allowed = same_end(hasty, careful)
    assert distance <= allowed, f"ends differ by {distance:.1e} m, allowed {allowed:.1e} m"


@pytest.fixture(scope="module")
def plain_end() -> Path:
    return solve(strip())


@settings(max_examples=8, deadline=None, derandomize=True)
@given(first_step=some.floats(1e-6, 1.0), target_iterations=some.integers(3, 11))
def test_end_does_not_depend_on_step_control(plain_end: Path, first_step: float, target_iterations: int) -> None:
    path = solve(strip(), Settings(first_step=first_step, target_iterations=target_iterations))
    distance, allowed = same_end(path, plain_end)
    assert distance <= allowed, f"ends differ by {distance:.1e} m, allowed {allowed:.1e} m ({len(path.steps)} steps)"


def test_plain_tangent_reaches_the_same_states() -> None:
    model = arm(stops=[1e-3, 3e-3, 6e-3])
    sharp = 1e-11
    mixed, plain = (solve(model, Settings(tolerance=sharp, mixed_tangent=kind)) for kind in (True, False))
    assert mixed.solves < plain.solves, f"linear solves: mixed {mixed.solves}, plain {plain.solves}"
    for factor in model.course(0).stops():
        one, other = (next(step.state for step in path.steps if step.load_factor == factor) for path in (mixed, plain))
        for name in ("u", "w", "phi", "q"):
            ours, theirs = getattr(one, name), getattr(other, name)
            apart = np.abs(ours - theirs).max() / np.abs(theirs).max()
            assert apart < 1e-8, f"load factor {factor}, {name}: {apart:.1e}"


def test_same_solve_twice_is_the_same_to_the_last_bit() -> None:
    first, second = solve(strip()), solve(strip())
    assert [contents(step.state) for step in first.steps] == [contents(step.state) for step in second.steps]
