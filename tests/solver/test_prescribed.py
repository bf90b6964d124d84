"""Prescribed displacements and rotations against solutions of scalar equations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

import magshell as ms
from magshell import Path, Settings, solve
from magshell.equations.instant import Instant
from magshell.shell import rotation
from solver.models import LAMBDA, LENGTH, MU, THICKNESS, WIDTH, rubber

SHARP = 1e-10


def stress(stretch: float, J: float) -> float:
    """Principal first Piola–Kirchhoff stress of the neo-Hookean material along a principal stretch, Pa."""
    return MU * stretch - (MU - LAMBDA * np.log(J)) / stretch


def uniaxial(stretch: float) -> tuple[float, float]:
    """Stress (Pa) and lateral stretch where both lateral stresses vanish."""
    lateral = brentq(lambda x: stress(x, stretch * x * x), 0.3, 2.0, xtol=1e-15)
    return stress(stretch, stretch * lateral**2), lateral


def plane(stretch: float) -> tuple[float, float]:
    """Stress (Pa) and thickness stretch where the width is held and the faces are free."""
    thin = brentq(lambda x: stress(x, stretch * x), 0.3, 2.0, xtol=1e-15)
    return stress(stretch, stretch * thin), thin


def pulled(stretch: float, width_held: bool, steps: float) -> Path:
    """A strip pulled along X1 to a stretch, on a mesh of 3 × 2 elements."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (3, 2)).select_nodes("sheet", x3=0).select_nodes("corner", x1=0, x2=0)
    shell = ms.Shell(mesh, THICKNESS, rubber(), ms.remanence.constant([0, 0, 0]))
    supports = [
        ms.Prescribe("left", "u", 1, 0.0),
        ms.Prescribe("right", "u", 1, (stretch - 1.0) * LENGTH),
        ms.Prescribe("sheet" if width_held else "corner", "u", 2, 0.0),
        ms.Prescribe("sheet", "u", 3, 0.0),
    ]
    model = ms.Model(shell, supports, ms.UniformField([0, 0, 0]))
    return solve(model, Settings(tolerance=SHARP, first_step=0.1, largest_step=steps))


def force_on(path: Path, group: str) -> np.ndarray:
    """Sum of the forces (3,), N, that the supports exert on a group's nodes at the end."""
    step = path.steps[-1]
    residual = path.discretisation.assemble(Instant(step.state, path.loading(step)), tangent=False).residual
    nodes = path.model.shell.mesh.nodes_of(group)
    return path.discretisation.to_global(residual)[nodes, :3].sum(axis=0)


@pytest.mark.parametrize("stretch", [0.8, 1.05, 1.5, 2.5])
@pytest.mark.parametrize(("law", "width_held"), [(uniaxial, False), (plane, True)])
def test_pulled_strip(stretch: float, law: Callable[[float], tuple[float, float]], width_held: bool) -> None:
    path = pulled(stretch, width_held, steps=0.25)
    P, lateral = law(stretch)
    exact = P * WIDTH * THICKNESS
    left, right = force_on(path, "left")[0], force_on(path, "right")[0]
    off = abs(right / exact - 1.0)
    assert off < 1e-7, f"force {right:.6e} N, exact {exact:.6e} N: off by {off:.1e}"
    assert abs(left + right) < 1e-7 * abs(exact), f"left {left:.6e} N, right {right:.6e} N"
    state, mesh = path.steps[-1].state, path.model.shell.mesh
    thinning = state.w[mesh.corner_nodes, 2] + 1.0
    assert np.abs(thinning / lateral - 1.0).max() < 1e-7, f"thickness stretches {thinning}, exact {lateral}"
    uniform = np.abs(state.u[:, 0] - (stretch - 1.0) * mesh.points[:, 0]).max()
    assert uniform < 1e-8 * LENGTH, f"u1 is off uniform by {uniform:.1e} m"


def test_values_grow_in_proportion_to_the_load_factor() -> None:
    path = pulled(1.5, False, steps=0.25)
    right = path.model.shell.mesh.nodes_of("right")
    for step in path.steps:
        off = np.abs(step.state.u[right, 0] - step.load_factor * 0.5 * LENGTH).max()
        assert off <= 4 * np.finfo(float).eps * LENGTH, f"step {step.number}: {off:.1e} m"


TURNS = 3
ELEMENTS = 36
ROLL_LENGTH, ROLL_WIDTH, ROLL_THICKNESS = 30e-3, 2e-3, 0.2e-3


@pytest.fixture(scope="module")
def roll() -> Path:
    """A strip clamped on the left whose right end is turned three times about X2, free to move.

    The couple enters through the micro-rotation, so it must be tied firmly to the material: eta = mu, l = h/2.
    """
    mesh = ms.mesh.rectangle(ROLL_LENGTH, ROLL_WIDTH, (ELEMENTS, 1))
    material = rubber(ROLL_THICKNESS, coupling=1.0, length=0.5)
    shell = ms.Shell(mesh, ROLL_THICKNESS, material, ms.remanence.constant([0, 0, 0]))
    supports = [ms.Clamp("left"), ms.Prescribe("right", "omega", value=(0, 2 * np.pi * TURNS, 0))]
    return solve(ms.Model(shell, supports, ms.UniformField([0, 0, 0])))


def across(path: Path) -> np.ndarray:
    """Nodes (3, cross-sections) from left to right: of one edge, of the other, half-way between them."""
    mesh = path.model.shell.mesh
    positions = np.linspace(0, ROLL_LENGTH, ELEMENTS + 1)
    return np.array([[mesh.node_at((x, y, 0)) for x in positions] for y in (0, ROLL_WIDTH, 0.5 * ROLL_WIDTH)])


def turns_between(path: Path) -> np.ndarray:
    """Rotation vectors (elements, 3), rad, from each cross-section's micro-rotation to the next."""
    q = path.steps[-1].state.q[across(path)[:2]].mean(axis=0)
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return rotation.logarithm(rotation.product(q[1:], rotation.conjugate(q[:-1])))


def test_roll_accumulates_three_turns(roll: Path) -> None:
    between = turns_between(roll)
    assert np.abs(between[:, [0, 2]]).max() < 1e-8, f"turned out of the plane by {np.abs(between).max(axis=0)}"
    total = between[:, 1].sum()
    assert abs(total - 2 * np.pi * TURNS) < 1e-9, f"turned by {total / (2 * np.pi)} turns"
    even = 2 * np.pi * TURNS / ELEMENTS
    assert np.all((between[:, 1] > 0.5 * even) & (between[:, 1] < 1.5 * even)), f"uneven: {between[:, 1] / even}"


def test_roll_is_a_circle_in_its_middle(roll: Path) -> None:
    """Away from the ends every element of a strip under a couple is like the next.

    Its edges curl across the width. No force pulls, so that the mean radius, by Simpson's rule, is the bent one. An
    element that spans the angle θ cannot tell an arc from its chord, θ²/24 of its length: so well is it round.
    """
    even = 2 * np.pi * TURNS / ELEMENTS
    allowed = even**2 / 24
    middle = slice(ELEMENTS // 3, 2 * ELEMENTS // 3)
    curvature = turns_between(roll)[middle, 1] / even
    assert np.ptp(curvature) < allowed, f"curvature over mean: {curvature}"
    assert np.abs(curvature - 1.0).max() < allowed, f"curvature over mean: {curvature}"
    x = (roll.model.shell.mesh.points + roll.steps[-1].state.u)[across(roll)]
    x = np.einsum("w,wnx->nx", [1 / 6, 1 / 6, 4 / 6], x)[middle][:, [0, 2]]
    A = np.column_stack([2 * x, np.ones(len(x))])
    (a, b, c), *_ = np.linalg.lstsq(A, (x**2).sum(axis=1), rcond=None)
    radius = np.sqrt(c + a * a + b * b)
    out_of_round = np.ptp(np.hypot(x[:, 0] - a, x[:, 1] - b)) / radius
    assert out_of_round < allowed, f"out of round by {out_of_round:.1e}"
    off = radius / (ROLL_LENGTH / (2 * np.pi * TURNS)) - 1.0
    assert abs(off) < allowed, f"radius off by {off:.1e}"


def test_roll_is_in_balance(roll: Path) -> None:
    """No field: forces and couples of the two ends cancel."""
    for step in roll.steps[1:]:
        assert step.balance is not None
        assert step.balance.force_imbalance < 1e-6, f"step {step.number}: {step.balance.force_imbalance:.1e}"
        assert step.balance.moment_imbalance < 1e-6, f"step {step.number}: {step.balance.moment_imbalance:.1e}"
