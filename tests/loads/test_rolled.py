"""A cantilever rolled to a full circle by a moment at its end, on shells of seven and of ten parameters."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import magshell as ms

LENGTH, WIDTH, HEIGHT = 10.0, 1.0, 0.1
MU, NUMBER = 0.5, 16
# Over it the moment passes from the micro-rotation to the section.
LENGTH_SCALE = 0.2 * LENGTH / NUMBER
TURN = 2.0 * np.pi
STIFFNESS = 2.0 * MU * WIDTH * HEIGHT**3 / 12.0


@cache
def rolled(micro_rotation: bool, follower: bool) -> ms.Path:
    """No Poisson effect: M = E I κ, and the couple stress adds mu l² A κ."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (NUMBER, 1))
    length_scale = LENGTH_SCALE if micro_rotation else 0.0
    material = ms.MicropolarNeoHookean(MU, 0.0, MU if micro_rotation else 0.0, length_scale)
    stiffness = STIFFNESS + MU * length_scale**2 * WIDTH * HEIGHT
    moment = ms.Moment("right", (0.0, -stiffness * TURN / LENGTH, 0.0), follower)
    shell = ms.Shell(mesh, HEIGHT, material, micro_rotation=micro_rotation)
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], loads=[moment], probes={"tip": (LENGTH, 0.0, 0.0)}))


@pytest.mark.parametrize(
    ("micro_rotation", "follower"),
    [(False, False), (True, False), (True, True)],
    ids=["seven", "ten, axis fixed", "ten, turning"],
)
def test_full_circle(micro_rotation: bool, follower: bool) -> None:
    """The tip returns to the clamp. The law bends linearly to the square of the strain of the faces, hκ/2."""
    path = rolled(micro_rotation, follower)
    tip, strain = path.probe("tip"), 0.5 * HEIGHT * TURN / LENGTH
    away = np.hypot(tip.u1[-1] + LENGTH, tip.u3[-1]) / LENGTH
    assert away < strain**2, f"{away:.2e}"
    assert np.abs(tip.u2).max() < 1e-9 * LENGTH
    director = path.discretisation.normals[0] + path.steps[-1].state.w[path.model.probe_nodes["tip"]]
    assert director[2] > 1.0 - strain, director
    for step in path.steps[1:]:
        moment = np.array(path.model.loads[0].total) * step.load_factor
        assert step.balance.load_moment == pytest.approx(moment, abs=1e-9 * abs(moment[1]))
        assert step.balance.moment_imbalance < 1e-8, step.balance.moment_imbalance


def test_an_axis_fixed_in_space_and_one_that_turns_with_the_end_are_one_in_the_plane() -> None:
    dead, turning = (rolled(True, follower).steps[-1].state.u for follower in (False, True))
    assert np.abs(dead - turning).max() < 1e-9 * LENGTH
