"""When the gripper's arms touch: on motions with a known answer, and on the solved path."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from magshell import Path, solve
from magshell.output.bodies import step_at
from magshell.problem.building import build
from magshell.reproduction.contact import INNER, MIDDLE, OUTER, _side, first_touch, gap
from magshell.reproduction.numbers import rows_of
from magshell.reproduction.table import WORTH_A_NOTE
from magshell.reproduction.variants import OTHER_ELEMENT, paper_file
from magshell.solver import Step

HALF = np.radians(15.0)


class Arm(NamedTuple):
    """An arm of few elements without a solve."""

    path: Path

    def step(self, load: float, u: np.ndarray) -> Step:
        """A state with this displacement of the mid-surface."""
        first = self.path.steps[0]
        return first._replace(load_factor=load, state=first.state._replace(u=u))


@pytest.fixture
def arm(gripper: Path) -> Arm:
    """The gripper, of its steps only the undeformed one."""
    return Arm(replace(gripper, steps=gripper.steps[:1]))


def test_undeformed_arms_have_no_clearance(arm: Arm) -> None:
    """On the faces as far as the normals are those of the sphere: a parabola's slope is off by half an element's a³."""
    off = 0.5 * 0.9e-3 * (HALF / 6.0) ** 3
    for height, allowed in ((MIDDLE, 1e-15), (OUTER, off), (INNER, off)):
        for side in ("right", "left"):
            largest = np.abs(gap(arm.path, arm.path.steps[0], height, side)).max()
            assert largest < allowed, f"{side}, {height}: {largest:.1e} m, allowed {allowed:.1e}"


def test_gap_of_an_arm_moved_outwards(arm: Arm) -> None:
    """A shift t along the arm's own radius opens both sides by t sin 15°, over what the undeformed gap is."""
    shift = np.zeros_like(arm.path.discretisation.mesh.points)
    shift[:, 0] = 1e-3
    for height in (OUTER, MIDDLE, INNER):
        for side in ("right", "left"):
            opened = gap(arm.path, arm.step(1.0, shift), height, side) - gap(arm.path, arm.path.steps[0], height, side)
            np.testing.assert_allclose(opened, 1e-3 * np.sin(HALF), rtol=1e-12)


def test_touch_of_a_motion_with_a_known_zero(arm: Arm) -> None:
    """Outwards and back in, t = λ (0.6 - λ): a cubic spline follows it exactly, the gap closes at λ = 0.6."""
    points = arm.path.discretisation.mesh.points
    loads = (0.0, 0.1, 0.25, 0.45, 0.7, 1.0)
    for load in loads[1:]:
        u = np.zeros_like(points)
        u[:, 0] = 1e-2 * load * (0.6 - load)
        arm.path.steps.append(arm.step(load, u))
    touch = first_touch(arm.path, MIDDLE)
    assert touch is not None
    field = arm.path.model.field.magnitude
    assert touch.field == pytest.approx(0.6 * field, rel=1e-9)


def test_touch_of_arms_that_only_open_or_only_close(arm: Arm) -> None:
    points = arm.path.discretisation.mesh.points
    steps = arm.path.steps
    for sign in (1.0, -1.0):
        arm.path.steps = steps[:1]
        for load in (0.2, 0.5, 1.0):
            u = np.zeros_like(points)
            u[:, 0] = sign * 1e-3 * load
            arm.path.steps.append(arm.step(load, u))
        touch = first_touch(arm.path, MIDDLE)
        assert touch is None if sign > 0.0 else touch is not None and touch.field == 0.0, f"{sign}: {touch}"


def test_arms_meet_at_the_interpolated_field(gripper: Path) -> None:
    """Solved to just that field, the gap is zero as far as the interpolation was good.

    How good it was is what leaving out every second step changes.
    """
    touch = first_touch(gripper, MIDDLE)
    coarser = first_touch(replace(gripper, steps=gripper.steps[::2]), MIDDLE)
    assert touch is not None
    assert coarser is not None
    file = paper_file("gripper")
    field = file.field.model_copy(update={"flux_density": (0.0, 0.0, touch.field), "stops": ()})
    built = build(file.model_copy(update={"field": field}), "gripper")
    found = _clearance(solve(built.model, built.settings), -1)
    before, after = (
        (1e3 * gripper.model.field.magnitude * step.load_factor, _clearance(gripper, step.number))
        for step in (step_at(gripper, 4e-3), step_at(gripper, 6.8e-3))
    )
    rate = (after[1] - before[1]) / (after[0] - before[0])
    bound = abs(rate * 1e3 * (coarser.field - touch.field))
    assert abs(found) < bound, f"{found:.1e} m at {1e3 * touch.field:.4f} mT, allowed {bound:.1e} m"


def _clearance(path: Path, step: int) -> float:
    """Smallest gap of the mid-surfaces below the clamp, m."""
    polar = _side(path, "right").polar
    return float(gap(path, path.steps[step], MIDDLE)[polar > polar.min() + 1e-6].min())


FINE = 4.03
"""Field, mT, at which the mid-surfaces meet with the same element on 60 × 12 elements, twice as fine."""
MESH_ERROR = 5.09 - 4.29
"""Change of that field, mT, from 15 × 4 to 30 × 6 elements: from there on the field converges at least as a halving
series, so the next change is less than half of this."""


def test_arms_touch_earlier_than_the_paper_says(gripper: Path) -> None:
    """Mid-surfaces, then the whole thickness; outer faces at once. The paper has 6.8 mT."""
    fields = {height: first_touch(gripper, height) for height in (OUTER, MIDDLE, INNER)}
    assert all(fields.values()), fields
    outer, middle, inner = (1e3 * fields[height].field for height in (OUTER, MIDDLE, INNER))
    assert outer == 0.0, f"{outer} mT"
    assert abs(middle - FINE) < 0.5 * MESH_ERROR, f"{middle:.3f} mT"
    assert middle < inner < 6.8, f"{middle:.3f}, {inner:.3f} mT"
    assert _clearance(gripper, step_at(gripper, 6.8e-3).number) < 0.0


def test_every_large_difference_has_a_note_with_a_number(gripper: Path) -> None:
    rows = rows_of("gripper", {"gripper": gripper, OTHER_ELEMENT: gripper})
    assert {row.quantity for row in rows if row.paper is not None} >= {"arms touch: mid-surfaces"}
    for row in rows:
        if row.difference_percent is not None and abs(row.difference_percent) > WORTH_A_NOTE:
            assert any(character.isdigit() for character in row.note), row
