"""A shallow arch that snaps through, and the tangent of a state as a dense matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from battery import MATERIAL, example

import magshell as ms
from magshell import Model, Path, Stage
from magshell.equations.instant import Instant
from magshell.mesh import Mesh
from magshell.model.course import Loading
from magshell.shell.state import State

SPAN, RISE, THICKNESS = 10.0, 0.25, 0.1
FORCE = 4e-5


def arch(stages: Sequence[Stage] = (), elements: int = 4, **options: Any) -> Model:
    """Half a clamped shallow arch, pushed down at its crown by a dead force: it snaps through."""
    mesh = ms.mesh.rectangle(SPAN / 2, 1.0, (elements, 1))
    points = mesh.points.copy()
    points[:, 2] = 0.5 * RISE * (1.0 - np.cos(2.0 * np.pi * points[:, 0] / SPAN))
    mesh = Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)
    shell = ms.Shell(mesh, THICKNESS, example(MATERIAL)._replace(length_scale=0.1 * THICKNESS))
    supports = [ms.Clamp("left"), ms.SymmetryPlane("right", (1, 0, 0))]
    push = ms.Force("right", (0, 0, -FORCE), **options)
    return Model(shell, supports, probes={"crown": (SPAN / 2, 0.5, RISE)}, loads=[push], stages=stages)


def sink(path: Path) -> np.ndarray:
    """Displacement of the crown at every step, downwards."""
    return -path.probe("crown").u3


def loads(path: Path) -> np.ndarray:
    """Load factor of every step."""
    return np.array([step.load_factor for step in path.steps])


def to_the_crown_at(depth: float, **options: Any) -> Stage:
    """A stage that pushes the crown down to a depth."""
    return Stage(control="displacement", probe="crown", component=3, target=-depth, **options)


def dense_tangent(path: Path, state: State, loading: Loading) -> np.ndarray:
    """Plain tangent (dofs, dofs) of a state."""
    matrix = path.discretisation.assemble(Instant(state, loading)).matrix
    assert matrix is not None
    return matrix.toarray()


def relative(one: np.ndarray, other: np.ndarray) -> float:
    """Largest difference over the largest value."""
    return float(np.abs(one - other).max() / np.abs(other).max())
