"""The built-in problems of several regions and layers, against elasticas and hand statics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from examples.problems import read
from magshell import solve
from magshell.evaluation.converged import converged
from magshell.model.loads import Gravity
from magshell.problem.building import build

MU0 = 4e-7 * math.pi
ALLOWED = 3e-3
"""Of the length: what the rods leave out, and the meshes of the files."""

# Tip deflection over length of the uniform elastica by q, and the tip (X1, X3) over the length of the stepped one with
# q = 1 at the root; from independent calculations.
UNIFORM = {1.0: 0.30172, 2.0: 0.49346, 5.0: 0.71379, 10.0: 0.81061}
STEPPED = (0.926940, 0.310596)


class Piece(NamedTuple):
    """A part of a rod: its length, couple per length and bending stiffness, all over those of the whole."""

    length: float
    couple: float
    stiffness: float


def tip_of(pieces: Sequence[Piece]) -> np.ndarray:
    """Tip (X1, X3) of an inextensible rod: EI θ' = M, M' = -c cos θ; from the tip, where M is 0, to the root."""

    def root(angle: float) -> np.ndarray:
        y = np.array([angle, 0.0, 0.0, 0.0])
        for piece in reversed(pieces):

            def slope(_: float, y: np.ndarray, piece: Piece = piece) -> list[float]:
                return [-y[1] / piece.stiffness, piece.couple * math.cos(y[0]), math.cos(y[0]), math.sin(y[0])]

            y = solve_ivp(slope, (0.0, piece.length), y, rtol=1e-11, atol=1e-13).y[:, -1]
        return y

    angles = np.linspace(1e-3, 0.5 * math.pi - 1e-3, 40)
    ends = [root(angle)[0] for angle in angles]
    first = next(k for k in range(len(ends) - 1) if ends[k] * ends[k + 1] <= 0.0)
    return root(brentq(lambda angle: root(angle)[0], angles[first], angles[first + 1], xtol=1e-13))[2:]


@pytest.mark.parametrize(("q", "deflection"), UNIFORM.items())
def test_the_rod_of_these_tests_is_the_uniform_elastica(q: float, deflection: float) -> None:
    assert tip_of([Piece(1.0, q, 1.0)])[1] == pytest.approx(deflection, abs=2e-5)


def test_the_rod_of_these_tests_is_the_stepped_elastica() -> None:
    assert tip_of([Piece(0.5, 1.0, 1.0), Piece(0.5, 0.5, 0.125)]) == pytest.approx(STEPPED, abs=2e-6)


@pytest.mark.parametrize("q", UNIFORM)
def test_bilayer_strip(q: float, solved) -> None:
    """The neutral line of the transformed section is the elastica."""
    path = solved("bilayer-strip")
    bottom, top = path.model.shell.parts[0].layers
    modulus, height = (
        np.array(pair)
        for pair in zip(*((2 * one.material.shear_modulus, one.thickness) for one in (bottom, top)), strict=True)
    )
    middle = np.array([-0.5e-3 + 0.5 * height[0], 0.5e-3 - 0.5 * height[1]])
    neutral = modulus * height @ middle / (modulus @ height)
    stiffness = modulus @ (height**3 / 12.0 + height * (middle - neutral) ** 2)
    assert stiffness == pytest.approx(1.34e-5, rel=1e-12)
    length = np.ptp(path.model.shell.mesh.points[:, 0])
    flux_density = q * MU0 * stiffness / (0.1 * height[1] * length**2)
    step = min(path.steps, key=lambda step: abs(step.flux_density[2] - flux_density))
    assert step.flux_density[2] == pytest.approx(flux_density, rel=1e-5)
    reached, node = converged(path.discretisation, step), path.model.probe_nodes["tip"]
    x = path.model.shell.mesh.points[node] + reached.displacement[node] + neutral * reached.director()[node]
    found, expected = x[[0, 2]] / length - [0.0, neutral / length], tip_of([Piece(1.0, q, 1.0)])
    assert np.abs(found - expected).max() < ALLOWED, f"q = {q}: {found}, the elastica has {expected}"


def test_stepped_strip(solved) -> None:
    path = solved("stepped-strip")
    shell, node = path.model.shell, path.model.probe_nodes["tip"]
    length = np.ptp(shell.mesh.points[:, 0])
    q = 12.0 * 0.1 * path.steps[-1].flux_density[2] / (MU0 * 300e3) * (length / 1e-3) ** 2
    assert q == pytest.approx(1.0, rel=1e-6)
    found = ((shell.mesh.points + path.steps[-1].state.displacement(len(shell.mesh.points)))[node] / length)[[0, 2]]
    assert np.abs(found - STEPPED).max() < ALLOWED, f"{found}, the elastica has {STEPPED}"


def test_where_the_mesh_lies_moves_the_stepped_strip_as_a_whole(solved) -> None:
    """Couples bend each half as before; flush at the bottom its mid-plane has a step, which turns with the strip."""
    middle, source = solved("stepped-strip"), read("stepped-strip")[1]
    shell = source.shell.model_copy(update={"offset": "bottom"})
    built = build(source.model_copy(update={"shell": shell}), "flush")
    flush, nodes = solve(built.model, built.settings), middle.model.probe_nodes
    x, d = {}, {}
    for name, path in (("middle", middle), ("flush", flush)):
        reached = converged(path.discretisation, path.steps[-1])
        x[name], d[name] = path.model.shell.mesh.points + reached.displacement, reached.director()
    tip, step = nodes["tip"], nodes["step"]
    found = x["flush"][tip] + 0.25e-3 * d["flush"][tip]
    expected = x["middle"][tip] - 0.25e-3 * d["middle"][step] + [0.0, 0.0, 0.5e-3]
    assert np.linalg.norm(found - expected) < 2e-4 * 40e-3, f"{1e3 * found} mm, expected {1e3 * expected} mm"


def test_starfish(solved) -> None:
    """Its post carries the weight, which is that of the two materials; a field along the axis turns nothing."""
    path = solved("starfish")
    shell = path.model.shell
    corners = shell.mesh.points[shell.mesh.elements[:, :4]]
    diagonals = corners[:, 2:] - corners[:, :2]
    areas = 0.5 * np.linalg.norm(np.cross(diagonals[:, 0], diagonals[:, 1]), axis=1)
    mass = sum(areas[part.elements].sum() * part.layers[0].thickness * part.layers[0].density for part in shell.parts)
    (gravity,) = path.model.loads
    assert isinstance(gravity, Gravity)
    for step in (path.steps[len(path.steps) // 2], path.steps[-1]):
        reaction = step.balance.reaction_force
        assert np.abs(reaction + mass * np.array(gravity.acceleration)).max() < 1e-7 * mass * 9.81
    hanging = next(step for step in path.steps if step.load_factor == 1.0)
    u = hanging.state.displacement(len(shell.mesh.points))
    tips = [
        np.flatnonzero(np.abs(shell.mesh.points - place).max(axis=1) < 1e-5) for place in path.model.probes.values()
    ]
    sag = [u[tip, 2].item() for tip in tips]
    assert sag[0] == pytest.approx(sag[1], rel=1e-6), "both arms hang alike"
    assert sag[0] < 0.0
    last = path.steps[-1].state.displacement(len(shell.mesh.points))
    assert last[tips[1], 2] > last[tips[0], 2] > 5e-3, "the field lifts them, most where it is across the arm"
