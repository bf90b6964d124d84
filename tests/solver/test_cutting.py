"""A step that fails is cut: nothing of it is left, and the result is the same."""

from __future__ import annotations

from itertools import dropwhile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

import magshell as ms
from magshell import Path, Settings, solve
from solver.models import LENGTH, Record, arm, contents, last_correction, strip


def same_end(one: Path, other: Path) -> tuple[float, float]:
    """Largest distance of the final displacements, and how far it may be by what each path left unsolved, m.

    To first order a state is off by its last Newton correction; corrections near round-off are known to a factor.
    """
    distance = np.abs(one.steps[-1].state.u - other.steps[-1].state.u).max()
    return float(distance), 2.0 * (last_correction(one) + last_correction(other)) + 1e-13 * LENGTH


def test_cut_step_leaves_nothing_behind() -> None:
    """The path after failed first steps is bit for bit that of a solve that starts with the step that succeeds."""
    hasty, prudent = Record(), Record()
    cut = solve(strip(), Settings(first_step=1.0), [hasty])
    direct = solve(strip(), Settings(first_step=cut.steps[1].load_factor), [prudent])
    assert hasty.cuts[0][0] == 1.0, f"the whole field in one step should be too much: {hasty.cuts}"
    first = cut.steps[1].load_factor
    assert prudent.cuts == list(dropwhile(lambda one: one[0] > first, hasty.cuts))
    assert [step.load_factor for step in direct.steps] == [step.load_factor for step in cut.steps]
    for ours, theirs in zip(cut.steps, direct.steps, strict=True):
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
