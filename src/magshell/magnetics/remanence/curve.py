"""Along a curve: the tangent at the nearest point of a named edge group."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence, direction, flipped_towards
from magshell.magnetics.remanence.way import MAGNITUDE, TOWARDS, Way
from magshell.remembered import remembered

if TYPE_CHECKING:
    from magshell.mesh import Mesh

SAMPLES = 9
ITERATIONS = 6


@remembered
def along_curve(group: str, magnitude: float, towards: ArrayLike | None = None) -> Remanence:
    """Along the tangent of a curve of edges, at its point nearest to the material point.

    Parameters
    ----------
    group : str
        Edge group: one or several curves, open or closed, that do not branch.
    magnitude : float
        T.
    towards : array_like, shape (3,), optional
        Where the component along this direction would be negative, the sign is flipped. Without it a curve runs as its
        first edge does; an edge of the boundary runs with the surface on its left.

    Raises
    ------
    InputError
        When used: no such edge group; a curve that branches.
    """
    preferred = None if towards is None else direction("towards", towards)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        if group not in mesh.edge_groups:
            fault = (
                f"'{group}' is not a group of edges" if group in mesh.groups else f"There is no edge group '{group}'"
            )
            raise InputError(f"remanence: {fault}. {suggest(group, mesh.edge_groups)}")
        edges = chained(mesh.edge_groups[group], group)
        asked = np.isfinite(points).all(axis=-1)
        tangents = np.full(points.shape, np.nan)
        tangents[asked] = _nearest_tangents(mesh.points[edges], points[asked])
        return magnitude * flipped_towards(tangents, preferred)

    return sample


def chained(edges: IntArray, group: str) -> IntArray:
    """The edges (k, 3), turned so that each curve runs as its first edge does.

    Raises
    ------
    InputError
        Three edges meet at a node.
    """
    at: dict[int, list[int]] = {}
    for number, (one, other, _) in enumerate(edges.tolist()):
        for end in (one, other):
            at.setdefault(end, []).append(number)
    for node, meeting in at.items():
        if len(meeting) > 2:
            raise InputError(f"remanence: the curve '{group}' branches at node {node}; a curve has no branches")
    turned = edges.copy()
    left = set(range(len(edges)))
    while left:
        first = min(left)
        left.remove(first)
        for forwards in (True, False):
            here = first
            while True:
                end = int(turned[here, 1 if forwards else 0])
                following = [number for number in at[end] if number in left]
                if not following:
                    break
                here = following[0]
                left.remove(here)
                if turned[here, 0 if forwards else 1] != end:
                    turned[here, :2] = turned[here, [1, 0]]
    return turned


def _nearest_tangents(ends: FloatArray, points: FloatArray) -> FloatArray:
    """Unit tangents (n, 3) of quadratic edges (k, 3, 3) at the point of them nearest to points (n, 3)."""
    from scipy.spatial import cKDTree

    t = np.linspace(-1.0, 1.0, SAMPLES)
    samples = np.einsum("mi,kix->kmx", _line(t)[0], ends).reshape(-1, 3)
    _, nearest = cKDTree(samples).query(points)
    edge, at = ends[nearest // SAMPLES], t[nearest % SAMPLES]
    curvature = edge[:, 0] + edge[:, 1] - 2.0 * edge[:, 2]
    for _ in range(ITERATIONS):
        N, dN = _line(at)
        x, tangent = np.einsum("mi,mix->mx", N, edge), np.einsum("mi,mix->mx", dN, edge)
        gap = x - points
        stiffness = (tangent * tangent).sum(axis=1)
        bent = stiffness + (curvature * gap).sum(axis=1)
        at = np.clip(at - (tangent * gap).sum(axis=1) / np.where(bent > 0.1 * stiffness, bent, stiffness), -1.0, 1.0)
    tangent = np.einsum("mi,mix->mx", _line(at)[1], edge)
    return np.asarray(tangent / np.linalg.norm(tangent, axis=1, keepdims=True))


def _line(t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Quadratic functions of end, end, middle and their derivatives at t (m,): (m, 3) each."""
    N = np.stack([t * (t - 1.0) / 2.0, t * (t + 1.0) / 2.0, 1.0 - t**2], axis=1)
    return N, np.stack([t - 0.5, t + 0.5, -2.0 * t], axis=1)


ALONG_CURVE = Way(
    lambda curve, magnitude, towards=None: along_curve(curve, magnitude, towards),
    {
        "curve": Key(
            "Name", "Group of edges: the tangent at its nearest point is the direction. It runs as its first edge."
        ),
        "magnitude": MAGNITUDE,
        "towards": TOWARDS,
    },
    lambda curve, magnitude, towards: f"along the curve {curve}" + wording.towards(towards),
)
