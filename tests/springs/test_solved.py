"""Solved shells on springs: closed forms, reactions, balance, work; springs as the only supports."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell import Settings, solve

LENGTH, WIDTH, HEIGHT, MU = 200.0, 10.0, 1.0, 0.5
E = 2.0 * MU
EI = E * WIDTH * HEIGHT**3 / 12.0
SMALL = 1e-5 * LENGTH


def strip(elements: tuple[int, int] = (20, 1), length: float = LENGTH) -> ms.Shell:
    """Without Poisson effect; its elements are the group 'all'."""
    mesh = ms.mesh.rectangle(length, WIDTH, elements).select_elements("all", x1=(0.0, length))
    return ms.Shell(mesh, HEIGHT, ms.MicropolarNeoHookean(MU, 0.0, 0.1 * MU, 1e-3 * HEIGHT))


@pytest.mark.parametrize("by", ["per_area", "stiffness"])
def test_a_beam_on_an_elastic_foundation(by: str) -> None:
    """A free beam with a force at its end, by Hetényi: with 4 EI λ⁴ = k b,

        u3 = 2 P λ / (k b) (sinh λL cos λx cosh λx' - sin λL cosh λx cos λx') / (sinh² λL - sin² λL),   x' = L - x.

    Nothing else holds it. The error falls with the elements; shear adds (λ h)²/20.
    """
    λ = 4.0 / LENGTH
    k = 4.0 * EI * λ**4 / WIDTH
    force = SMALL * k * WIDTH / (2.0 * λ)
    spring = ms.Spring("all", **{by: k if by == "per_area" else k * WIDTH * LENGTH})
    places = {f"{x:g}": (x, 0.5 * WIDTH, 0.0) for x in (0.0, 50.0, 100.0, 200.0)}
    errors = []
    for number in (20, 40):
        model = ms.Model(
            strip((number, 1)), [], loads=[ms.Force("left", (0, 0, force))], springs=[spring], probes=places
        )
        path = solve(model)
        found = np.array([path.probe(name).u3[-1] for name in places])
        near, sine, sinh = λ * np.array([0.0, 50.0, 100.0, 200.0]), np.sin(λ * LENGTH), np.sinh(λ * LENGTH)
        far = λ * LENGTH - near
        expected = sinh * np.cos(near) * np.cosh(far) - sine * np.cosh(near) * np.cos(far)
        errors.append(np.abs(found / SMALL - expected / (sinh**2 - sine**2)).max())
        assert path.summary["reactions"]["all"]["force"][2] == pytest.approx(-force, rel=1e-6)
    assert errors[0] < 2e-3, errors
    assert errors[1] < 0.5 * errors[0], errors


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_a_spring_at_the_tip_of_a_cantilever(ratio: float) -> None:
    """Side by side: k = 3 EI/L³ and the spring's share the force, as its reaction says."""
    length = 20.0
    beam = 1.0 / (length**3 / (3.0 * EI) + length / (MU * WIDTH * HEIGHT))
    force = 1e-5 * beam * length
    spring = ms.Spring("right", stiffness=ratio * beam, direction=(0, 0, -2.0), name="tip spring")
    model = ms.Model(
        strip((10, 1), length),
        [ms.Clamp("left")],
        loads=[ms.Force("right", (0, 0, force))],
        springs=[spring],
        probes={"tip": (length, 0.0, 0.0)},
    )
    path = solve(model)
    assert path.probe("tip").u3[-1] == pytest.approx(force / ((1.0 + ratio) * beam), rel=1e-4)
    taken = path.summary["reactions"]["tip spring"]["force"]
    assert taken == pytest.approx([0.0, 0.0, -force * ratio / (1.0 + ratio)], rel=1e-4, abs=1e-12 * force)
    held = path.summary["reactions"]["left"]["force"]
    assert np.add(taken, held) == pytest.approx([0.0, 0.0, -force], abs=1e-6 * force)


def test_balance_reactions_and_work_at_large_rotations() -> None:
    """A strip on springs alone, pulled up at its end by four thicknesses: forces, moments and energies add up."""
    springs = [
        ms.Spring("all", per_area=2e-6, name="bed"),
        ms.Spring("left", per_length=1e-3, point=(1.0, 2.0, 3.0)),
        ms.Spring("bottom", stiffness=2e-3, direction=(1.0, 2.0, 2.0)),
    ]
    loads = [ms.Force("right", (1e-4, 0, 4e-3)), ms.Moment("right", (1e-3, 2e-3, 0))]
    material = ms.MicropolarNeoHookean(MU, 0.0, MU, 0.1 * HEIGHT)
    shell = ms.Shell(strip((8, 2), 40.0).mesh, HEIGHT, material)
    model = ms.Model(shell, [], loads=loads, springs=springs, probes={"tip": (40.0, 0.0, 0.0)})
    path = solve(model, Settings(largest_step=0.05, tolerance=1e-10))
    assert path.probe("tip").u3[-1] > 4.0 * HEIGHT
    state, table = path.steps[-1].state, path.history
    path.history.rows(path.steps)
    last = dict(zip(table.columns, table.row(path.steps[-1]), strict=True))
    stored = last["elastic"] + last["springs"]
    assert last["springs"] > 0.05 * stored
    assert last["work"] == pytest.approx(stored, rel=1e-3), f"{last['work'] / stored - 1.0:.1e}"
    x = shell.mesh.points + state.u
    for spring, elastic in zip(springs, model.elastic, strict=True):
        forces, name = elastic.forces(state)[:, :3], spring.name or spring.group
        assert [last[f"{name}.R{i}"] for i in (1, 2, 3)] == pytest.approx(forces.sum(axis=0), rel=1e-12)
        if spring.point is not None:
            moment = np.cross(x - np.array(spring.point), forces).sum(axis=0)
            assert [last[f"{name}.M{i}"] for i in (1, 2, 3)] == pytest.approx(moment, rel=1e-12)
    for step in path.steps[1:]:
        assert step.balance.force_imbalance < 1e-8, f"{step.load_factor}: {step.balance.force_imbalance:.1e}"
        assert step.balance.moment_imbalance < 1e-8, f"{step.load_factor}: {step.balance.moment_imbalance:.1e}"
    total = np.array(loads[0].total)
    assert path.steps[-1].balance.reaction_force == pytest.approx(-total, abs=1e-8 * np.linalg.norm(total))


def test_no_load_factor_scales_them() -> None:
    """Half a force makes half a small deflection, and a force that goes leaves nothing."""
    force = ms.Force("left", (0, 0, 1e-7), history=(0.5, 1.0, 0.0))
    springs = [ms.Spring("all", per_area=1e-6)]
    path = solve(ms.Model(strip(), [], loads=[force], springs=springs, probes={"end": (0.0, 0.0, 0.0)}))
    ends = [[step.state.u[0, 2] for step in path.steps if step.stage == stage][-1] for stage in range(3)]
    assert ends[0] == pytest.approx(0.5 * ends[1], rel=1e-4)
    assert abs(ends[2]) < 1e-8 * ends[1]


def test_a_moved_support_drags_the_springs_along() -> None:
    """Nodes that are displaced work against their springs: the work is the energy stored."""
    shell = strip((8, 1), 40.0)
    supports = [ms.Clamp("left"), ms.Prescribe("right", "u", 3, 2.0)]
    springs = [ms.Spring("all", per_area=1e-6), ms.Spring("right", stiffness=1e-4, name="end")]
    path = solve(ms.Model(shell, supports, springs=springs), Settings(largest_step=0.05, tolerance=1e-10))
    last = path.summary
    assert last["work"] == pytest.approx(last["elastic"] + last["springs"], rel=1e-3)
    assert last["reactions"]["end"]["force"][2] == pytest.approx(-2e-4, rel=1e-12)


HELD_BY = {
    "an area in all directions": ([ms.Spring("all", per_area=1.0)], None),
    "an area along its normal": (
        [ms.Spring("all", per_area=1.0, direction=(0, 0, 1))],
        "translation along X2 and translation along X1 and rotation about X3",
    ),
    "an edge": ([ms.Spring("left", per_length=1.0)], "rotation about X2"),
    "a node": ([ms.Spring("one", stiffness=1.0)], "rotation about"),
    "a node and an edge": ([ms.Spring("one", stiffness=1e9), ms.Spring("left", stiffness=1e-9)], None),
}


@pytest.mark.parametrize(("springs", "free"), HELD_BY.values(), ids=HELD_BY)
def test_what_springs_hold(springs: list[ms.Spring], free: str | None) -> None:
    shell = strip((4, 1), 40.0)
    mesh = shell.mesh.select_nodes("one", 40.0, 0.0, 0.0)
    shell = ms.Shell(mesh, HEIGHT, shell.material)
    loads = [ms.Force("right", (0, 0, 1e-3))]
    if free is None:
        ms.Model(shell, [], loads=loads, springs=springs)
        return
    with pytest.raises(ms.InputError, match=f"can still move as a rigid body: {free}"):
        ms.Model(shell, [], loads=loads, springs=springs)
