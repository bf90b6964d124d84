"""Bodies that supports let turn, as compass needles, and that the field does not hold.

The body is taken as rigid, with the moment m of its remanence, in the direction of the field at the start of the path.
It is turned about its free axes as the solve does (`magshell.solver.turning`), by the energy -m · B, its gradient
-a_i · (m × B) and its second derivative -(a_i × (a_j × m)) · B. Where loads or springs act the solve alone can tell.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from magshell.arrays import FloatArray
from magshell.magnetics.fields import UniformField
from magshell.mesh.geometry import diagonal_normals
from magshell.model.doubts.asked import Asked
from magshell.model.doubts.figures import VACUUM_PERMEABILITY
from magshell.model.rigid import FreeTurn, direction

UNSTABLE = (
    "the body stands opposite to the field, an unstable equilibrium that it does not leave by itself. Tilt the field "
    "by a degree to see it turn"
)
NEUTRAL, LONGEST, MOST = 1e-7, 0.5, 100
START = 1e-3
"""Load factor at which the path of a needle is looked at."""


def unheld(axis: FloatArray) -> str:
    """What is wrong where nothing holds a rotation."""
    return (
        f"the field exerts no torque about {direction(axis)}, so that nothing holds the rotation about it. Hold it by "
        "a support or a spring, or magnetise the body across the axis"
    )


def doubts(model: Asked) -> Iterator[str]:
    """Rotations that nothing holds, and bodies that stand opposite to the field."""
    if not isinstance(model.field, UniformField) or model.loads or model.springs:
        return
    B = model.course(0).at(START).flux_density
    for turn in model.turns:
        yield from _of_turn(*_moment(model, turn), B / np.linalg.norm(B), turn.axes)


def _of_turn(m: FloatArray, size: float, B: FloatArray, axes: FloatArray) -> Iterator[str]:
    """Those of a moment (3,) of parts of a total magnitude, in a field of the direction (3,) B."""
    for _ in range(MOST):
        g = -axes @ np.cross(m, B)
        H = -np.array([[np.cross(a, np.cross(b, m)) @ B for b in axes] for a in axes])
        values, vectors = np.linalg.eigh(0.5 * (H + H.T))
        sizes = np.abs(values)
        if np.abs(g).max() <= NEUTRAL * size:
            if sizes.min() <= NEUTRAL * size:
                yield unheld(axes.T @ vectors[:, int(sizes.argmin())])
            elif values.min() < 0.0:
                yield UNSTABLE
            return
        step = -axes.T @ vectors @ (vectors.T @ g / np.maximum(sizes, NEUTRAL * size))
        m = Rotation.from_rotvec(step * min(1.0, LONGEST / float(np.linalg.norm(step)))).apply(m)


def _moment(model: Asked, turn: FreeTurn) -> tuple[FloatArray, float]:
    """Moment (3,) of a part, A m², and the sum of the magnitudes of its elements and rigid bodies."""
    shell, mesh = model.shell, model.shell.mesh
    own = np.isin(mesh.elements, turn.places).all(axis=1)
    areas = np.linalg.norm(diagonal_normals(mesh.points[mesh.elements]), axis=1)
    thickness = np.ptp(shell.faces_at_nodes, axis=2).mean(axis=1)
    remanence = shell.remanence_at_points.mean(axis=1)
    moments = (remanence * (areas * thickness)[:, None])[own] / VACUUM_PERMEABILITY
    bodies = [
        np.asarray(body.moment, dtype=float)[None]
        for number, body in enumerate(shell.rigid)
        if len(mesh.points) + number in turn.places
    ]
    every = np.concatenate([moments, *bodies])
    return every.sum(axis=0), float(np.linalg.norm(every, axis=1).sum())
