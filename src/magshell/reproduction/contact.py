r"""When neighbouring arms of the gripper touch.

The arms are equal and share out the circle, so each has the half-plane through the axis and its undeformed side
between itself and its neighbour: they touch where a deformed side reaches that half-plane. The gap of a side is

    g(s, z, B) = -n · x,    x = X + u + z (1 + z φ) d,

with the half-plane's normal n pointing to the neighbour, s along the side and z through the thickness. Undeformed, g is
zero everywhere: the arms cover the sphere without clearance. The field opens a gap first and closes it later.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.output.bodies import faces
from magshell.output.tessellation import Tessellation

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

PIECES = 8
OUTER, MIDDLE, INNER = 0.5, 0.0, -0.5
"""Fractions of the thickness over the mid-surface; the director points outwards."""


class Touch(NamedTuple):
    """Where and when a line of the side reaches the half-plane.

    Attributes
    ----------
    field : float
        T; 0 if the gap never opens.
    polar : float
        Undeformed polar angle of the point, degrees.
    """

    field: float
    polar: float


def first_touch(path: Path, height: float, side: str = "right") -> Touch | None:
    """The field at which the gap closes first, below the clamped upper end.

    Between converged steps the gap of every point is a cubic spline of the load; the zero is bracketed by the steps.

    Parameters
    ----------
    path : Path
        Of one arm, a patch of a sphere about the origin.
    height : float
        Line of the side, as a fraction of the thickness over the mid-surface.
    side : str
        Edge group.

    Returns
    -------
    Touch or None
        None if the gap stays open to the end of the path.
    """
    from scipy.interpolate import CubicSpline
    from scipy.optimize import brentq

    polar = _side(path, side).polar
    free = polar > polar.min() * (1.0 + 1e-9)
    load = np.array([step.load_factor for step in path.steps])
    gaps = np.array([gap(path, step, height, side) for step in path.steps])[:, free]
    closed = np.flatnonzero(gaps[1:].min(axis=1) < 0.0) + 1
    if not closed.size:
        return None
    first = int(closed[0])
    if first == 1:
        return Touch(0.0, float(polar[free][gaps[1].argmin()]))
    curve = CubicSpline(load, gaps)
    at = float(brentq(lambda t: float(curve(t).min()), load[first - 1], load[first]))
    return Touch(at * path.model.field_magnitude, float(polar[free][curve(at).argmin()]))


def gap(path: Path, step: Step, height: float, side: str = "right") -> FloatArray:
    """Gap (points,) in m along the side; negative where the half-plane is crossed."""
    line = _side(path, side)
    (face,) = faces(path, step, [height])
    return np.asarray(-(line.on(face) @ line.normal))


class _Side(NamedTuple):
    """A side of the arm: its edges cut into pieces, their polar angles, and the normal of the half-plane through it."""

    cells: Tessellation
    edges: IntArray
    polar: FloatArray
    normal: FloatArray

    def on(self, nodal: FloatArray) -> FloatArray:
        """Nodal positions (nodes, 3) at the points of the side."""
        return self.cells.edges(nodal, self.edges).reshape(-1, 3)


def _side(path: Path, name: str) -> _Side:
    mesh = path.discretisation.mesh
    cells, edges = Tessellation(mesh.elements, PIECES), mesh.edge_groups[name]
    X = cells.edges(mesh.points, edges).reshape(-1, 3)
    polar = np.degrees(np.arccos(X[:, 2] / np.linalg.norm(X, axis=1)))
    across = np.cross([0.0, 0.0, 1.0], X.mean(axis=0))
    outwards = -np.sign(mesh.points.mean(axis=0) @ across)
    return _Side(cells, edges, polar, outwards * across / np.linalg.norm(across))
