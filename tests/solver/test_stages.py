"""Stages in sequence and histories: what acts when, and that the same loading is the same state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import magshell as ms
from magshell import InputError, Model, Path, Stage, Step, solve
from magshell.shell import rotation
from magshell.shell.state import State
from solver.models import LENGTH, THICKNESS, WIDTH, Record, rubber

AGAIN = 1e-8
FIELD = (0.0, 0.0, 5e-3)
PULL = 300.0


def strip(
    stages: Sequence[Stage] = (),
    gravity: Sequence[float] | None = None,
    supports: Sequence[Any] = (),
    weight: float = PULL,
    **field: Any,
) -> Model:
    """A strip clamped on the left that bends down by its weight and up in a field; the field's options are its own."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 1))
    shell = ms.Shell(mesh, THICKNESS, rubber(), ms.remanence.constant([0.143, 0, 0]), density=1500.0)
    loads = [ms.Gravity((0, 0, -weight), history=gravity)] if weight else []
    flux_density = field.pop("flux_density", FIELD)
    return Model(
        shell, [ms.Clamp("left"), *supports], ms.UniformField(flux_density, **field),
        probes={"tip": (LENGTH, 0, 0)}, loads=loads, stages=stages,
    )  # fmt: skip


def end_of(path: Path, stage: int) -> Step:
    """The last step of a stage."""
    return [step for step in path.steps if step.stage == stage][-1]


def apart(one: State, other: State) -> float:
    """Largest difference of displacements and micro-rotations, over the largest value."""
    u = np.abs(one.u - other.u).max() / np.abs(other.u).max()
    turned = np.abs(rotation.matrix(one.q) - rotation.matrix(other.q)).max()
    return max(u, turned)


@pytest.fixture(scope="module")
def weighed() -> Path:
    """First gravity, then the field."""
    return solve(strip(gravity=(1, 1), history=(0, 1)))


def test_first_gravity_then_the_field(weighed: Path) -> None:
    """What acts grows straight in its own stage; a later stage starts from the last state."""
    assert {step.stage for step in weighed.steps} == {0, 1}
    for step in weighed.steps:
        gravity, field = (step.load_factor, 0.0) if step.stage == 0 else (1.0, step.load_factor)
        assert step.loads == pytest.approx([gravity], rel=1e-15)
        assert step.flux_density == pytest.approx(field * np.array(FIELD), rel=1e-15)
        loading = weighed.loading(step)
        assert np.array_equal(loading.flux_density, step.flux_density)
        assert np.array_equal(loading.loads, step.loads)
    assert np.all(np.diff([step.arc_length for step in weighed.steps]) > 0.0)
    assert weighed.probe("tip").u3[-1] > end_of(weighed, 0).state.u[weighed.model.probe_nodes["tip"], 2]
    assert np.array_equal(weighed.probe("tip").flux_density, [step.flux_density for step in weighed.steps])


def test_ends_of_stages_are_those_of_the_same_loads_at_once(weighed: Path) -> None:
    """Only the weight at the end of the first; weight and field, whichever comes first, at that of the second."""
    alone = solve(strip(flux_density=(0, 0, 0)))
    together = solve(strip())
    swapped = solve(strip(gravity=(0, 1), history=(1, 1)))
    differences = {
        "gravity": apart(end_of(weighed, 0).state, alone.steps[-1].state),
        "both": apart(weighed.steps[-1].state, together.steps[-1].state),
        "swapped": apart(swapped.steps[-1].state, together.steps[-1].state),
    }
    assert max(differences.values()) < AGAIN, differences


def test_stages_that_are_named_and_driven_otherwise_end_in_the_same_state(weighed: Path) -> None:
    tip = end_of(weighed, 0).state.u[weighed.model.probe_nodes["tip"], 2]
    stages = [
        Stage("weight", "displacement", probe="tip", component=3, target=tip),
        Stage("field", "arc-length", stops=(0.5,)),
    ]
    path = solve(strip(stages, gravity=(1, 1), history=(0, 1)))
    assert end_of(path, 0).load_factor == pytest.approx(1.0, abs=1e-9)
    assert apart(path.steps[-1].state, weighed.steps[-1].state) < AGAIN
    assert 0.5 in [step.load_factor for step in path.steps if step.stage == 1]


def test_field_that_turns_keeps_its_magnitude() -> None:
    """A turn by 1.2 rad about X2 in two stages; the end is that of a field which always pointed there."""
    path = solve(strip(weight=0.0, history=(1, 1, 1), rotation_axis=(0, 2, 0), rotation=(0, 0.5, 1.2)))
    angles = [0.0, 0.0, 0.5, 1.2]
    for step in path.steps:
        angle = angles[step.stage] + step.load_factor * (angles[step.stage + 1] - angles[step.stage])
        magnitude = FIELD[2] * (step.load_factor if step.stage == 0 else 1.0)
        expected = magnitude * np.array([np.sin(angle), 0.0, np.cos(angle)])
        assert np.abs(step.flux_density - expected).max() < 1e-15 * FIELD[2] * 10, f"step {step.number}"
    there = solve(strip(weight=0.0, flux_density=end_of(path, 2).flux_density))
    assert apart(path.steps[-1].state, there.steps[-1].state) < AGAIN


def test_up_and_down_and_up_again() -> None:
    """At the same multiplier the same state; at none, the undeformed one; reversed, the mirror image."""
    half = (0.5,)
    stages = [
        Stage("up", stops=half),
        Stage("down", stops=half),
        Stage("back", stops=half),
        Stage("up again", stops=half),
    ]
    path = solve(strip(stages, weight=0.0, history=(1, 0, -1, 1)))
    at = {(step.stage, step.load_factor): step for step in path.steps}
    up, down, reversed_half, nothing = (at[number, 0.5].state for number in range(4))
    assert apart(down, up) < AGAIN
    assert apart(end_of(path, 3).state, end_of(path, 0).state) < AGAIN
    size = np.abs(end_of(path, 0).state.u).max()
    for rest in (end_of(path, 1).state, nothing):
        assert np.abs(rest.u).max() < AGAIN * size
        assert np.abs(rotation.logarithm(rest.q)).max() < AGAIN
    mirrored = reversed_half._replace(u=reversed_half.u * [1, 1, -1], q=reversed_half.q * [1, -1, -1, 1])
    assert apart(mirrored, up) < AGAIN
    assert at[1, 0.5].flux_density == pytest.approx([0, 0, 2.5e-3])
    assert at[2, 0.5].flux_density == pytest.approx([0, 0, -2.5e-3])


def test_field_stops_are_hit_on_every_way() -> None:
    """Wherever the multiplier passes a magnitude: at 2 and 4 mT up, down through zero, and on."""
    path = solve(strip(weight=0.0, history=(1, -0.5), stops=(2e-3, 4e-3)))
    found = {stage: [1e3 * step.flux_density[2] for step in path.steps if step.stage == stage] for stage in (0, 1)}
    for stage, wanted in ((0, (2.0, 4.0, 5.0)), (1, (4.0, 2.0, -2.0, -2.5))):
        for field in wanted:
            assert min(abs(one - field) for one in found[stage]) < 1e-12, f"{field} mT in stage {stage}: {found[stage]}"


def test_supports_move_by_their_history() -> None:
    """The end is turned, held while the field comes, and turned back."""
    turn = ms.Prescribe("right", "omega", value=(0, 0.3, 0), history=(1, 1, 0))
    path = solve(strip(weight=0.0, supports=[turn], history=(0, 1, 1)))
    right = path.model.shell.mesh.nodes_of("right")
    right = right[path.discretisation.carried[right, 7]]
    for step in path.steps:
        angle = 0.3 * (step.load_factor, 1.0, 1.0 - step.load_factor)[step.stage]
        off = np.abs(rotation.logarithm(step.state.q[right]) - [0.0, angle, 0.0]).max()
        assert off < 1e-14, f"step {step.number}: {off:.1e}"
    held = ms.Prescribe("right", "omega", value=(0, 0, 0))
    assert apart(path.steps[-1].state, solve(strip(weight=0.0, supports=[held])).steps[-1].state) < AGAIN


def test_a_stage_after_a_target_starts_from_the_load_that_was_found() -> None:
    """Half-way the tip is held by displacement control; the next stage leads on to the loads of the histories."""
    stages = [Stage(control="displacement", probe="tip", component=3, target=-2e-3), Stage()]
    path = solve(strip(stages, gravity=(1, 1), history=(0, 1)))
    found = end_of(path, 0).load_factor
    assert 0.0 < found < 1.0
    course = path.courses[1]
    assert course.at(0.0).loads == pytest.approx([found], rel=1e-15)
    assert course.at(1.0).loads == pytest.approx([1.0], rel=1e-15)
    first = next(step for step in path.steps if step.stage == 1)
    assert first.loads[0] == pytest.approx(found + first.load_factor * (1.0 - found), rel=1e-14)
    assert apart(path.steps[-1].state, solve(strip()).steps[-1].state) < AGAIN


def test_a_stage_in_which_nothing_changes() -> None:
    path = solve(strip(gravity=(1, 1), history=(1, 1)))
    last, before = end_of(path, 1), end_of(path, 0)
    assert last.load_factor == 1.0
    assert apart(last.state, before.state) < AGAIN


def test_progress_counts_steps_through_all_stages() -> None:
    record = Record()
    path = solve(strip(gravity=(1, 1), history=(0, 1)), observers=[record])
    assert [step.number for step in path.steps] == list(range(len(path.steps)))
    assert {(one.stage, one.step) for one in record.iterations if one.iteration == 0} >= {
        (step.stage, step.number) for step in path.steps[1:]
    }


def test_as_many_stages_as_the_longest_history() -> None:
    assert len(strip().stages) == 1
    assert len(strip(gravity=(1, 1, 0), history=(0, 1, 1)).stages) == 3
    assert len(strip(weight=0.0, rotation_axis=(0, 1, 0), rotation=(0, 1), history=(1, 1)).stages) == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"gravity": (1, 1, 1)}, "gravity.*history has 3 entries; it needs one for each of the 2 stages"),
        ({"history": (1,)}, "field: history has 1 entries; it needs one for each of the 2 stages"),
        ({"rotation_axis": (0, 1, 0), "rotation": (1, 2, 3)}, "field: rotation: history has 3 entries"),
        (
            {"supports": [ms.Prescribe("right", "omega", 2, 0.1, history=(1, 0, 1))]},
            "support on 'right': history has 3 entries; it needs one for each of the 2 stages",
        ),
    ],
)
def test_history_of_another_length(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        strip([Stage(), Stage()], **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"control": "loads"}, "control is 'loads'. Did you mean 'load'"),
        ({"stops": (0.5, 0.5)}, r"stops are \[0.5, 0.5\]; they must rise"),
        ({"stops": (0.0,)}, "from above 0 to at most 1"),
        ({"stops": (1.5,)}, "from above 0 to at most 1"),
        ({"control": "displacement"}, "probe is missing"),
        ({"control": "displacement", "probe": "tip", "component": 3}, "target is missing"),
        ({"probe": "tip", "component": 3, "target": 1.0}, "probe makes no sense under load control"),
        ({"control": "arc-length", "probe": "tip"}, "component is missing"),
        (
            {"control": "displacement", "probe": "tip", "component": 4, "target": 1.0},
            "component is 4; allowed are 1, 2, 3",
        ),
        (
            {"control": "displacement", "probe": "tip", "component": 3, "target": np.nan},
            "target is nan; it must be finite",
        ),
        (
            {"control": "displacement", "probe": "tip", "component": 3, "target": 1.0, "stops": (0.5,)},
            "with a target there are none to hit",
        ),
        ({"branch": 1}, "branch is 1; .* needs arc-length control"),
        ({"control": "arc-length", "branch": 0}, "branch is 0; it is the number of a critical point, from 1"),
        ({"control": "arc-length", "branch": 1, "side": 0}, "side is 0; allowed are 1 and -1"),
    ],
)
def test_stage_that_cannot_be_meant(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"stage 'push': .*{message}"):
        Stage("push", **options)


def test_stage_with_an_unknown_probe() -> None:
    with pytest.raises(InputError, match=r"stage 'push': probe 'tipp' is unknown\. Did you mean 'tip'"):
        strip([Stage("push", "displacement", probe="tipp", component=3, target=1e-3)])
