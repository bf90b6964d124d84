"""Bifurcations of perfect shells: found on the straight path, and both branches followed from there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import magshell as ms
from magshell import DeformationGradientEnergy, InputError, Model, Path, SolveError, Stage, solve
from magshell.solver.critical import BIFURCATION
from solver.arches import dense_tangent, relative
from solver.models import LENGTH, strip

MIRROR = np.array([1.0, 1.0, -1.0])
PARTS = tuple(2.0**-10 * 4.0 ** np.arange(4))


def buckling(stages: Sequence[Stage] = (), coupling: object = None) -> Model:
    """A strip clamped on the left in a field against its remanence, which grows in the first stage and then stays."""
    straight = strip(field=(-20e-3, 0, 0), coupling=coupling)
    return Model(straight.shell, straight.supports, straight.field, coupling, {"tip": (LENGTH, 0, 0)}, stages=stages)


def along(side: int, stops: Sequence[float] = ()) -> Stage:
    """The branch on a side."""
    return Stage(control="arc-length", branch=1, side=side, stops=stops)


@pytest.fixture(scope="module", params=[None, DeformationGradientEnergy()], ids=["couple", "energy"])
def both(request: pytest.FixtureRequest) -> Path:
    """The straight path, then one branch with stops near its start, then the other."""
    return solve(buckling([Stage(), along(1, PARTS), along(-1, PARTS)], request.param))


def of_stage(path: Path, number: int) -> list[ms.Step]:
    """The steps of a stage."""
    return [step for step in path.steps if step.stage == number]


def test_bifurcation_of_the_straight_strip(both: Path) -> None:
    """The path stays straight; the mode is bending, in which the tangent has no stiffness."""
    (point,) = both.critical_points
    assert point.kind == BIFURCATION
    assert point.negative_pivots == (0, 1)
    straight = of_stage(both, 0)
    assert max(np.abs(step.state.u[:, 2]).max() for step in straight) < 1e-12 * LENGTH
    assert [step.negative_pivots for step in straight] == [int(s.load_factor > point.load_factor) for s in straight]
    assert np.abs(point.mode[:, :2]).max() < 1e-8, "out of the plane"
    assert np.abs(point.flux_density - [-20e-3 * point.load_factor, 0, 0]).max() < 1e-15
    tangent = dense_tangent(both, point.state, both.courses[0].at(point.load_factor))
    scale = 1.0 / np.sqrt(tangent.diagonal())
    least = np.linalg.svd(scale[:, None] * tangent * scale, compute_uv=False)[-2:]
    assert least[1] < 1e-7 * least[0], f"singular values {least}"
    mode = point.mode[both.discretisation.free]
    equations = both.discretisation.numbering.number[both.discretisation.free]
    force = tangent[:, equations] @ mode
    stiff = np.abs(tangent[:, equations]) @ np.abs(mode)
    assert np.abs(force).max() < 1e-9 * stiff.max(), f"{np.abs(force).max() / stiff.max():.1e}"


def test_both_sides_are_mirror_images(both: Path) -> None:
    """Where both paths stop they have the same states, up and down."""
    pairs = 0
    for load_factor in (*PARTS, 1.0):
        one, other = (
            next(step for step in of_stage(both, number) if step.load_factor == load_factor) for number in (1, 2)
        )
        apart = relative(other.state.u * MIRROR, one.state.u)
        assert apart < 1e-8, f"load factor {load_factor}: {apart:.1e}"
        assert np.abs(other.state.phi + one.state.phi).max() < 1e-6 * np.abs(one.state.phi).max()
        pairs += 1
    assert pairs == len(PARTS) + 1


def test_the_sides_are_those_of_the_mode(both: Path) -> None:
    (point,) = both.critical_points
    tip = both.model.probe_nodes["tip"]
    for number, side in ((1, 1), (2, -1)):
        ends = np.array([step.state.u[tip, 2] for step in of_stage(both, number)])
        assert np.all(ends * side * point.mode[tip, 2] > 0.0)
        assert np.all(np.diff(np.abs(ends)) > 0.0), "it bends on and on"


def test_branches_start_at_the_critical_point(both: Path) -> None:
    """Their load factors run from the loading there to the end of the histories; their arc lengths go on."""
    (point,) = both.critical_points
    for number in (1, 2):
        course, steps = both.courses[number], of_stage(both, number)
        assert np.abs(course.at(0.0).flux_density - point.flux_density).max() < 1e-15
        assert np.abs(course.at(1.0).flux_density - [-20e-3, 0, 0]).max() < 1e-15
        assert steps[0].arc_length > point.arc_length
        assert np.all(np.diff([step.arc_length for step in steps]) > 0.0)
        assert all(step.negative_pivots == 0 for step in steps), "they are stable"


def test_amplitude_grows_like_the_square_root(both: Path) -> None:
    """At loads four times as far beyond the bifurcation it is twice as large; what is left falls fourfold."""
    tip = both.model.probe_nodes["tip"]
    steps = {step.load_factor: step for step in of_stage(both, 1)}
    amplitudes = np.array([abs(steps[part].state.u[tip, 2]) for part in PARTS])
    off = amplitudes[1:] / amplitudes[:-1] - 2.0
    assert np.abs(off[0]) < 0.01, f"ratios {amplitudes[1:] / amplitudes[:-1]}"
    falls = off[1:] / off[:-1]
    assert falls == pytest.approx(4.0, abs=0.4), f"ratios less 2: {off}, falling by {falls}"


def test_branch_of_a_point_that_is_not_there() -> None:
    weak = strip(field=(-1e-3, 0, 0))
    stages = [Stage(), along(1)]
    model = Model(weak.shell, weak.supports, weak.field, stages=stages)
    with pytest.raises(SolveError, match="branch off at critical point 1, but the path before it has none") as caught:
        solve(model)
    path = caught.value.path
    assert path.steps[-1].load_factor == 1.0
    assert {step.stage for step in path.steps} == {0}


def test_the_first_stage_has_nothing_to_branch_from() -> None:
    with pytest.raises((InputError, SolveError), match="critical point 1"):
        solve(buckling([along(1)]))


def test_several_bifurcations_in_one_step() -> None:
    """A strip squeezed between its ends has them close together: in one large step as many as in short ones."""

    def squeezed(largest_step: float) -> Path:
        held = [ms.Clamp("left"), ms.Prescribe("right", "u", 1, -0.06 * LENGTH), ms.Prescribe("right", "u", 3, 0.0)]
        model = strip((4, 1), held, field=(0, 0, 0))
        return solve(model, ms.Settings(first_step=largest_step, largest_step=largest_step))

    coarse, fine = squeezed(1.0), squeezed(0.1)
    ours, theirs = ([point.load_factor for point in path.critical_points] for path in (coarse, fine))
    assert len(coarse.steps) < len(fine.steps)
    assert len(theirs) > 1
    assert ours == pytest.approx(theirs, abs=1e-8)
    assert [point.negative_pivots for point in fine.critical_points] == [(n, n + 1) for n in range(len(theirs))]
