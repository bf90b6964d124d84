"""Sizes of steps, told by their outcomes alone."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as some

from magshell.solver.step_control import StepControl, StepRules, stagnant

RULES = StepRules(target_solves=4, smallest=1e-6)
SIZES = some.floats(1e-5, 1.0)


@given(size=SIZES, solves=some.integers(0, 30))
def test_steps_grow_and_shrink_by_their_solves(size: float, solves: int) -> None:
    after = StepControl(RULES, 0.5, failures=3).succeeded(size, solves)
    assert after.failures == 0
    assert after.size == pytest.approx(size * min(max(4 / max(solves, 1), 0.4), 2.5), rel=1e-12)


@given(size=SIZES, next_size=SIZES, solves=some.integers(0, 30))
def test_a_step_shortened_to_meet_a_goal_does_not_shorten_the_next(size: float, next_size: float, solves: int) -> None:
    control = StepControl(RULES, next_size)
    assert control.succeeded(size, solves, shortened=True).size >= next_size


@given(size=SIZES, ratio=some.floats(0.1, 10.0))
def test_failures_in_a_row_have_an_end(size: float, ratio: float) -> None:
    """Whatever a step's own size is, the next is intended at most half as long."""
    control, count = StepControl(RULES, size), 0
    while not control.exhausted:
        before = control.size
        control, count = control.failed(ratio * before, before), count + 1
        assert control.size <= 0.5 * before
        assert control.failures == count
    assert count <= 1 + math.log2(size / RULES.smallest)


def test_a_size_that_is_no_number_is_exhausted() -> None:
    assert StepControl(RULES, math.nan).exhausted


def test_progress_of_a_hundredth_in_a_hundred_steps_is_enough() -> None:
    """On the way back, too, as long as it comes nearer than it was before."""
    slow = [0.5 + 1.1e-4 * number for number in range(150)]
    slower = [0.5 + 4.9e-5 * number for number in range(150)]
    assert not stagnant(slow, 1.0, 1.0)
    assert list(stagnant(slower, 1.0, 1.0)) == slower[-100:]
    assert not stagnant(slower[:100], 1.0, 1.0)
    fallen = [0.5, *[0.1] * 100]
    assert stagnant(fallen, 1.0, 1.0)
    assert not stagnant([*fallen, 0.6], 1.0, 1.0)
