"""Solved shells under loads: linear beam theory, reactions, global balance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import magshell as ms
from loads.bodies import RADIUS, arm, loads_of_every_kind, mixed_loads
from magshell import Settings, solve
from magshell.shell.elements import ELEMENTS

LENGTH, WIDTH, THICKNESS = 20e-3, 2e-3, 1e-3
MU = 303e3
SMALL = 1e-4  # the deflection's size in lengths; large rotations change it by its square
each_element = pytest.mark.parametrize("element", ELEMENTS)


def cantilever(element: str, number: int, length_scale: float, load: Callable[[float], object]) -> ms.Path:
    """A strip of so many elements without Poisson effect under a load that is given the stiffness 2 mu h³ b / 12.

    The length scale is in thicknesses. The couple stress adds mu l² h b to the stiffness.
    """
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (number, 1))
    material = ms.MicropolarNeoHookean(MU, 0.0, 0.1 * MU, length_scale * THICKNESS)
    shell = ms.Shell(mesh, THICKNESS, material, element=element)
    loads = [load(2.0 * MU * WIDTH * THICKNESS**3 / 12.0)]
    probes = {"tip": (LENGTH, 0, 0), "middle": (0.5 * LENGTH, 0, 0)}
    return solve(ms.Model(shell, [ms.Clamp("left")], loads=loads, probes=probes), Settings(first_step=1.0))


@each_element
def test_cantilever_bent_by_an_end_moment(element: str) -> None:
    """Constant curvature M / (EI + mu l² A), which every element holds: u3 = κ x²/2.

    At the loaded end the moment passes from the micro-rotation, where it acts, to the section. That layer is as long as
    the length scale, of which an element has five: it moves the tip by 3e-4, and the middle by nothing.
    """
    couple, curvature = 6.0 * 0.1**2, SMALL / LENGTH
    path = cantilever(element, 40, 0.1, lambda stiffness: ms.Moment("right", (0, -curvature * stiffness, 0)))
    found = path.probe("middle").u3[-1] / (0.5 * curvature * (0.5 * LENGTH) ** 2)
    assert found == pytest.approx(1.0 / (1.0 + couple), abs=SMALL**2), f"{found * (1.0 + couple) - 1.0:.2e}"


@each_element
def test_cantilever_bent_by_an_end_force(element: str) -> None:
    """Timoshenko's beam with the shear stiffness mu A: u3 = P L³/3EI + P L/(mu A), without couple stress.

    Where rotations are linear along an element, it holds the mean of the curvature P (L - x)/EI only, which loses
    1/(4 n²) of the work. What is neglected are products of small terms and the couple stress, 6 (l/h)².
    """
    number, length_scale = 10, 1e-3
    lost = 0.25 / number**2 if ELEMENTS[element].rest_nodes == 4 else 0.0
    shear = 0.5 * (THICKNESS / LENGTH) ** 2
    force = 3.0 * SMALL / LENGTH**2
    path = cantilever(element, number, length_scale, lambda stiffness: ms.Force("right", (0, 0, force * stiffness)))
    found = path.probe("tip").u3[-1] / (SMALL * LENGTH)
    tolerance = 6.0 * length_scale**2 + shear**2 + shear * lost
    assert found == pytest.approx(1.0 + shear - lost, abs=2.0 * tolerance), f"{found - 1.0 - shear + lost:.2e}"


@each_element
def test_cantilever_bent_by_its_weight(element: str) -> None:
    """Timoshenko's beam, u3 = q L⁴/8EI + q L²/2 mu A, with an error of the second order, and next to none beyond it."""
    stiffness, area, density = 2.0 * MU * WIDTH * THICKNESS**3 / 12.0, WIDTH * THICKNESS, 1100.0
    load = SMALL * 8.0 * stiffness / LENGTH**3
    expected = SMALL * LENGTH + 0.5 * load * LENGTH**2 / (MU * area)
    gravity = ms.Gravity((0, 0, load / (density * area)))
    errors = []
    for number in (5, 10):
        mesh = ms.mesh.rectangle(LENGTH, WIDTH, (number, number // 5))
        material = ms.MicropolarNeoHookean(MU, 0.0, 0.1 * MU, 1e-3 * THICKNESS)
        shell = ms.Shell(mesh, THICKNESS, material, element=element, density=density)
        model = ms.Model(shell, [ms.Clamp("left")], loads=[gravity], probes={"tip": (LENGTH, 0, 0)})
        errors.append(solve(model, Settings(first_step=1.0)).probe("tip").u3[-1] / expected - 1.0)
    assert abs(errors[1]) < 0.3 * abs(errors[0]), errors
    assert abs(4.0 * errors[1] - errors[0]) / 3.0 < 0.5 * abs(errors[1]), errors


@pytest.fixture(scope="module", params=["loads", "loads and field"])
def bent(request: pytest.FixtureRequest) -> ms.Path:
    return solve(arm(mixed_loads(), field=0.0 if request.param == "loads" else 3e-3))


def test_the_arm_bends(bent: ms.Path) -> None:
    moved = np.abs(bent.steps[-1].state.u).max()
    assert moved > 5e-3, f"{moved:.1e} m"


def test_global_balance(bent: ms.Path) -> None:
    for step in bent.steps[1:]:
        assert step.balance.force_imbalance < 1e-8, f"{step.load_factor}: {step.balance.force_imbalance:.1e}"
        assert step.balance.moment_imbalance < 1e-8, f"{step.load_factor}: {step.balance.moment_imbalance:.1e}"
    sums = [np.linalg.norm(step.balance.reaction_force + step.balance.load_force) for step in bent.steps[1:]]
    scale = max(step.balance.force_scale for step in bent.steps[1:])
    assert bent.summary["force_imbalance"] == pytest.approx(max(sums) / scale, rel=1e-12)


def test_reaction_is_minus_the_load(bent: ms.Path) -> None:
    """Forces against the totals as given; moments at the deformed nodes, from each load's own part."""
    total = np.sum([load.total for load in bent.model.loads if isinstance(load, ms.Force)], axis=0)
    couple = np.sum([load.total for load in bent.model.loads if isinstance(load, ms.Moment)], axis=0)
    for step in bent.steps[1:]:
        λ, found = step.load_factor, step.balance
        assert found.load_force == pytest.approx(λ * total, abs=1e-14 * np.linalg.norm(total))
        assert found.reaction_force == pytest.approx(-λ * total, abs=1e-8 * λ * np.linalg.norm(total))
        position = bent.discretisation.mesh.points + step.state.u
        forces = np.sum([load.forces(step.state)[:, :3] for load in bent.model.applied], axis=0)
        moment = λ * (np.cross(position, forces).sum(axis=0) + couple)
        size = float(np.linalg.norm(moment))
        assert found.load_moment == pytest.approx(moment, abs=1e-13 * size)
        expected = -moment - found.magnetic_torque
        assert found.reaction_moment == pytest.approx(expected, abs=1e-7 * size)


def test_force_that_only_a_moment_exerts_is_measured_against_it() -> None:
    """Pure bending leaves no force but round-off: over the couple on the body's size it is none."""
    path = solve(arm([ms.Moment("bottom", (0, -1e-5, 0))]))
    assert path.summary["force_imbalance"] < 1e-8, path.summary["force_imbalance"]


@pytest.mark.parametrize("micro_rotation", [True, False], ids=["ten parameters", "seven"])
def test_loads_of_every_kind_balance(micro_rotation: bool) -> None:
    """Reactions against the loads at the deformed nodes, with the couples of forces on directors; they bend the arm."""
    path = solve(arm(loads_of_every_kind(micro_rotation), micro_rotation=micro_rotation))
    assert np.abs(path.steps[-1].state.u).max() > 0.5 * RADIUS
    for step in path.steps[1:]:
        assert step.balance.force_imbalance < 1e-8, f"{step.load_factor}: {step.balance.force_imbalance:.1e}"
        assert step.balance.moment_imbalance < 1e-8, f"{step.load_factor}: {step.balance.moment_imbalance:.1e}"
        total = step.load_factor * np.sum([load.forces(step.state) for load in path.model.applied], axis=0)
        assert step.balance.load_force == pytest.approx(total[:, :3].sum(axis=0), rel=1e-12)


def test_histories_scale_each_load_by_itself() -> None:
    """First gravity, then a pressure on it while gravity goes: the last state is that of the pressure alone."""
    weight, pressure = ms.Gravity((-0.5, 0.3, 1.0), history=(1.0, 0.0)), ms.Pressure("half", 1.0, history=(0.0, 1.0))
    path = solve(arm([weight, pressure]), Settings(tolerance=1e-12))
    for load, stage in ((weight, 0), (pressure, 1)):
        alone = solve(arm([replace(load, history=None)]), Settings(tolerance=1e-12)).steps[-1].state
        found = [step.state for step in path.steps if step.stage == stage][-1]
        error = np.abs(found.u - alone.u).max() / np.abs(alone.u).max()
        assert error < 1e-9, f"{load.kind}: {error:.1e}"
