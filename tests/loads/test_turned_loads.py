"""A body turned as a whole with its loads and field gives the turned answer."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import magshell as ms
from loads.bodies import arm, mixed_loads
from magshell import Path, Settings, solve
from magshell.mesh import Mesh
from magshell.shell import rotation

SHARP = Settings(tolerance=1e-10)


def turned(model: ms.Model, Q: np.ndarray) -> ms.Model:
    """The arm with its points, remanence, field and loads turned by Q."""
    shell, old = model.shell, model.shell.mesh
    mesh = Mesh(old.points @ Q.T, old.elements, old.element_groups, old.edge_groups, old.node_groups)
    remanence = ms.remanence.function(lambda points: shell.remanence(old, (points @ Q)[None])[0] @ Q.T)
    loads = [type(load)(load.group, Q @ load.total) for load in model.loads]
    body = ms.Shell(mesh, shell.thickness, shell.material, remanence)
    return ms.Model(body, model.supports, ms.UniformField(Q @ model.field.vector), loads=loads)


@pytest.fixture(scope="module")
def bent() -> Path:
    return solve(arm(mixed_loads(), field=3e-3), SHARP)


@pytest.mark.parametrize("seed", [1, 2])
def test_turned_arm(bent: Path, seed: int) -> None:
    Q = Rotation.random(random_state=seed).as_matrix()
    ours, theirs = bent.steps[-1].state, solve(turned(bent.model, Q), SHARP).steps[-1].state
    pairs = {
        "u": (ours.u, theirs.u @ Q),
        "w": (ours.w, theirs.w @ Q),
        "phi": (ours.phi, theirs.phi),
        "rotation": (rotation.matrix(ours.q), Q.T @ rotation.matrix(theirs.q) @ Q),
    }
    for name, (one, two) in pairs.items():
        difference = np.abs(one - two).max() / np.abs(one).max()
        assert difference < 1e-8, f"seed {seed}: {difference:.1e} in {name}"
