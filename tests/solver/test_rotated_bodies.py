"""A body turned together with its field deforms the same: the whole path, not just one element."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell import Path, Settings, solve
from magshell.shell import rotation
from magshell.shell.elements import ELEMENTS
from magshell.shell.state import State
from solver.models import arm

SHARP = Settings(tolerance=1e-10)
RADIUS = 10e-3


def turned(model: ms.Model, Q: np.ndarray, supports: list[object]) -> ms.Model:
    """The model with mesh points, remanence and field turned by Q, held by supports that mean the same."""
    shell, old = model.shell, model.shell.mesh
    mesh = ms.mesh.Mesh(old.points @ Q.T, old.elements, old.element_groups, old.edge_groups, old.node_groups)

    def remanence(points: np.ndarray) -> np.ndarray:
        return shell.remanence(old, (points @ Q)[None])[0] @ Q.T

    body = ms.Shell(mesh, shell.thickness, shell.material, ms.remanence.function(remanence), shell.element)
    field = ms.UniformField(Q @ model.field.vector, model.field.stops)
    return ms.Model(body, supports, field, coupling=model.coupling)


def at_stops(path: Path) -> list[State]:
    """States at the stops and at the end."""
    stops = path.model.course(0).stops()
    return [step.state for step in path.steps if step.load_factor in stops]


def largest_difference(path: Path, other: Path, Q: np.ndarray) -> tuple[float, str]:
    """Over all stops and fields: the other path turned back against this one, relative to the field's largest value."""
    worst = (0.0, "")
    for factor, one, two in zip(path.model.course(0).stops(), at_stops(path), at_stops(other), strict=True):
        pairs = {
            "u": (one.u, two.u @ Q),
            "w": (one.w, two.w @ Q),
            "phi": (one.phi, two.phi),
            "rotation": (rotation.matrix(one.q), Q.T @ rotation.matrix(two.q) @ Q),
        }
        if one.alpha.size:
            pairs["alpha"] = (one.alpha, two.alpha @ Q)
        for name, (ours, theirs) in pairs.items():
            worst = max(worst, (np.abs(ours - theirs).max() / np.abs(ours).max(), f"{name} at {factor:.3g}"))
    return worst


@pytest.fixture(scope="module")
def straight_arm() -> Path:
    return solve(arm((8, 2), stops=[2e-3, 5e-3]), SHARP)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_turned_arm(straight_arm: Path, seed: int) -> None:
    Q = Rotation.random(random_state=seed).as_matrix()
    model = straight_arm.model
    path = solve(turned(model, Q, list(model.supports)), SHARP)
    difference, where = largest_difference(straight_arm, path, Q)
    assert difference < 1e-8, f"seed {seed}: {difference:.1e} in {where}"


def pump(element: str) -> ms.Model:
    """An eighth of a short tube, clamped at one end, in a field across it."""
    mesh = ms.mesh.cylinder(RADIUS, 1.5 * RADIUS, (6, 3), angle=(-90, 90), axis=(0, 1, 0), zero=(1, 0, 0))
    material = ms.MicropolarNeoHookean(135e3, 3.25e6, 13.5e3, 9e-5)
    remanence = ms.remanence.circumferential(94e-3, axis=(0, 1, 0), towards=(0, 0, 1))
    shell = ms.Shell(mesh, 0.9e-3, material, remanence, element)
    return ms.Model(shell, planes(np.eye(3)), ms.UniformField([0, 0, 40e-3], [10e-3]))


def planes(Q: np.ndarray) -> list[object]:
    """The tube's supports, turned."""
    return [
        ms.Clamp("end"),
        ms.SymmetryPlane("start", Q @ [0, 1, 0]),
        ms.SymmetryPlane("angle-start", Q @ [1, 0, 0]),
        ms.SymmetryPlane("angle-stop", Q @ [1, 0, 0]),
    ]


@pytest.mark.parametrize("element", ELEMENTS)
def test_turned_tube_between_oblique_mirror_planes(element: str) -> None:
    model = pump(element)
    Q = Rotation.random(random_state=4).as_matrix()
    path, other = solve(model, SHARP), solve(turned(model, Q, planes(Q)), SHARP)
    difference, where = largest_difference(path, other, Q)
    assert difference < 1e-8, f"{difference:.1e} in {where}"
    moved = np.abs(path.steps[-1].state.u).max()
    assert moved > 0.05 * RADIUS, f"the tube should deform: {moved:.2e} m"
