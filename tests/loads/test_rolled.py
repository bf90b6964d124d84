r"""Strips rolled to circles by a moment at their end, and bent in their plane, with seven and with ten parameters.

Without Poisson effect a strip of the St Venant–Kirchhoff law is a circle under an end moment. With the stretch a of its
middle, the length d of its director and its curvature κ per undeformed length, the energy per length and width is

    W = ∫ mu/4 ((a + z κ d)² - 1)² dz + mu h/4 (d² - 1)² + mu l² h/2 κ².

It is stationary in a, a² = 1 - (κ d h)²/4, and in d, and the moment is ∂W/∂κ: for small curvature D κ with the bending
stiffness D = E h³/12 + mu l² h, of which the last part is the couple stress's.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import magshell as ms

WIDTH, MU = 1.0, 0.5
TURN = 2.0 * np.pi


def bent(curvature: float, height: float, length_scale: float) -> tuple[float, float]:
    """Moment per width, and stretch a of the middle."""

    def square(d: float) -> float:
        return 1.0 - 0.25 * (curvature * d * height) ** 2

    def bending(d: float) -> float:
        """∫ mu z λ (λ² - 1) dz for the stretch λ = a + z κ d."""
        k = curvature * d
        return MU * ((3.0 * square(d) - 1.0) * k * height**3 / 12.0 + k**3 * height**5 / 80.0)

    d = brentq(lambda d: curvature * bending(d) + MU * height * d * (d**2 - 1.0), 0.9, 1.0, xtol=1e-15)
    return d * bending(d) + MU * length_scale**2 * height * curvature, np.sqrt(square(d))


def strip(length: float, width: float, elements: tuple[int, int], length_scale: float | None) -> ms.Shell:
    """A strip of thickness 1; the length scale None: seven parameters."""
    couple = (0.0, 0.0) if length_scale is None else (MU, length_scale)
    material = ms.MicropolarStVenantKirchhoff(MU, 0.0, *couple)
    mesh = ms.mesh.rectangle(length, width, elements)
    return ms.Shell(mesh, 1.0, material, micro_rotation=length_scale is not None)


def under_moment(shell: ms.Shell, total: tuple[float, float, float], follower: bool = False) -> ms.Path:
    length, width, _ = shell.mesh.points.max(axis=0)
    probes = {"tip": (length, 0.5 * width, 0.0), "middle": (0.5 * length, 0.5 * width, 0.0)}
    loads = [ms.Moment("right", total, follower)]
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], loads=loads, probes=probes))


CASES = {"seven": (None, False), "h/10": (0.1, False), "h/100": (0.01, False), "h/10, turning": (0.1, True)}
each_case = pytest.mark.parametrize(("length_scale", "follower"), CASES.values(), ids=CASES)


@pytest.mark.parametrize(
    ("slenderness", "turns", "number"),
    [(100.0, 1.0, 16), pytest.param(120.0, 2.0, 32, marks=pytest.mark.verify)],
    ids=["once", "twice"],
)
@each_case
def test_rolled_up(slenderness: float, turns: float, number: int, length_scale: float | None, follower: bool) -> None:
    """The middle of the strip is the circle, its tip on the clamp, with elements of 22.5°."""
    moment, stretch = bent(TURN * turns / slenderness, 1.0, length_scale or 0.0)
    path = under_moment(strip(slenderness, 1.0, (number, 1), length_scale), (0.0, -moment, 0.0), follower)
    mesh, state = path.model.shell.mesh, path.steps[-1].state
    x, radius = mesh.points + state.u, stretch * slenderness / (TURN * turns)
    away = np.hypot(*x[path.model.probe_nodes["tip"], [0, 2]]) / slenderness
    assert away < 1e-3, f"tip: {away:.2e} of the length"
    out = np.abs(np.hypot(x[:, 0], x[:, 2] - radius) / radius - 1.0).max()
    assert out < 1e-3, f"radius: {out:.2e}"
    assert np.abs(state.u[:, 1]).max() < 1e-9 * slenderness
    for step in path.steps[1:]:
        expected = np.array([0.0, -moment, 0.0]) * step.load_factor
        assert step.balance.load_moment == pytest.approx(expected, abs=1e-9 * moment)
        assert step.balance.moment_imbalance < 1e-8, step.balance.moment_imbalance


@pytest.mark.parametrize("length_scale", [0.1, 0.01], ids=["h/10", "h/100"])
def test_bent_in_its_plane(length_scale: float) -> None:
    """By a moment about the normal: u2 = κ x²/2 with M = (E b³/12 + mu l² b) κ.

    The moment is uniform along the edge, the bending stress at it is linear: that changes over a width, and moves the
    tip. So the middle is more exact.
    """
    length, width, angle = 40.0, 4.0, 0.01
    moment = (2.0 * MU * width**3 / 12.0 + MU * length_scale**2 * width) * angle / length
    path = under_moment(strip(length, width, (20, 2), length_scale), (0.0, 0.0, moment))
    for name, x, tolerance in (("tip", length, 2e-3), ("middle", 0.5 * length, 1e-3)):
        error = path.probe(name).u2[-1] / (0.5 * angle / length * x**2) - 1.0
        assert abs(error) < tolerance, f"{name}: {error:.1e}"
    assert path.steps[-1].balance.load_moment == pytest.approx([0.0, 0.0, moment], rel=1e-12)
    assert path.steps[-1].balance.moment_imbalance < 1e-8


def test_an_axis_fixed_in_space_and_one_that_turns_with_the_end_are_one_in_the_plane() -> None:
    shell, moment = strip(40.0, 1.0, (8, 1), 0.1), bent(TURN / 40.0, 1.0, 0.1)[0]
    dead, turning = (under_moment(shell, (0.0, -moment, 0.0), follower).steps[-1].state.u for follower in (False, True))
    assert np.abs(dead - turning).max() < 1e-9 * 40.0
