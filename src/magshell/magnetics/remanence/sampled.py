"""Remanence given by numbers: a function of the position, a vector per element, vectors at places."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError
from magshell.magnetics.remanence.vectors import Remanence
from magshell.mesh.geometry import centres
from magshell.remembered import remembered
from magshell.tables import duplicate

if TYPE_CHECKING:
    from magshell.mesh import Mesh

AS_NEAR = 1e-6
"""Distances that differ by less than this part of half an element's diagonal are the same; vectors likewise."""


@remembered
def function(of_position: Callable[[FloatArray], ArrayLike]) -> Remanence:
    """A function of the reference position: takes points (n, 3) in m, returns vectors (n, 3) in T."""

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        asked = np.isfinite(points).all(axis=-1)
        values = np.full(points.shape, np.nan)
        found = np.asarray(of_position(points[asked]), dtype=float)
        expected = (int(asked.sum()), 3)
        if found.shape != expected:
            raise InputError(f"remanence: the function returned shape {found.shape}; expected {expected}")
        values[asked] = found
        return values

    return sample


@remembered
def per_element(vectors: ArrayLike) -> Remanence:
    """One vector per element, shape (elements, 3), T."""
    values = np.array(vectors, dtype=float)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        if values.shape != (len(points), 3):
            raise InputError(
                f"remanence: per-element array has shape {values.shape}; the mesh needs {(len(points), 3)}"
            )
        return np.broadcast_to(values[:, None, :], points.shape).copy()

    return sample


def at_places(places: ArrayLike, vectors: ArrayLike, tolerance: float | None = None) -> Remanence:
    """Vectors at places, as a measurement or another program gives them; an element takes that nearest its centre.

    Where several places are as near, it takes their mean.

    Parameters
    ----------
    places : array_like, shape (n, 3)
        m.
    vectors : array_like, shape (n, 3)
        T.
    tolerance : float, optional
        Largest distance from the centre of an element to its place, m; without it half the longest diagonal of the
        element, so that the place lies in the element or just beside it.

    Raises
    ------
    InputError
        Arrays that are no n × 3 finite numbers; a place with two vectors; when used: an element without
        a place within the tolerance.
    """
    where, values = np.array(places, dtype=float), np.array(vectors, dtype=float)
    for name, array in (("places", where), ("vectors", values)):
        if array.ndim != 2 or array.shape[1] != 3 or len(array) != len(where) or not len(array):
            raise InputError(f"remanence: {name} have shape {array.shape}; both need the same n × 3 with n > 0")
        if not np.isfinite(array).all():
            raise InputError(f"remanence: {name}[{np.flatnonzero(~np.isfinite(array).all(axis=1))[0]}] is not finite")
    found = duplicate(where, values)
    if found is not None:
        raise InputError(f"remanence: places[{found[0]}] and places[{found[1]}] are one place with different vectors")
    kept = np.unique(where, axis=0, return_index=True)[1]
    return AtPlaces(where[kept], values[kept], tolerance)


class AtPlaces:
    """What `at_places` returns: places (n, 3), no two of them the same, with their vectors (n, 3)."""

    def __init__(self, places: FloatArray, vectors: FloatArray, tolerance: float | None) -> None:
        self._places, self._vectors, self._tolerance = places, vectors, tolerance

    def __call__(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """The remanence at points (elements, points, 3): the vector of the nearest place, or the mean of several."""
        asked, vectors, _ = self._found(mesh, points)
        found = np.full(points.shape, np.nan)
        found[asked] = vectors[:, None]
        return found

    def averaged(self, mesh: Mesh, points: FloatArray) -> IntArray:
        """Numbers of the elements, of those that are asked, to which several places with other vectors are as near."""
        asked, _, several = self._found(mesh, points)
        return asked[several]

    def _found(self, mesh: Mesh, points: FloatArray) -> tuple[IntArray, FloatArray, AnyArray]:
        """The elements asked, their vectors, and which of these are means."""
        from scipy.spatial import cKDTree

        asked = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
        middles = centres(mesh.points, mesh.elements[asked])
        corners = mesh.points[mesh.elements[asked, :4]]
        half = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        reach = half if self._tolerance is None else self._tolerance
        tree = cKDTree(self._places)
        distance, nearest = map(np.asarray, tree.query(middles, k=[1, 2]))
        far = np.flatnonzero(distance[:, 0] > reach)
        if far.size:
            worst = far[np.argmax(distance[far, 0])]
            place = ", ".join(f"{x:.6g}" for x in middles[worst])
            raise InputError(
                f"remanence: {far.size} of {len(asked)} elements have no value near them; the worst is element "
                f"{asked[worst]} at ({place}) m, {distance[worst, 0]:.3g} m from the nearest place. Check the unit of "
                "the places, cover the whole part or give a larger tolerance"
            )
        vectors = self._vectors[nearest[:, 0]]
        several = np.zeros(len(asked), dtype=bool)
        for row in np.flatnonzero(distance[:, 1] - distance[:, 0] <= AS_NEAR * half):
            near = self._vectors[tree.query_ball_point(middles[row], distance[row, 0] + AS_NEAR * half[row])]
            several[row] = np.any(np.ptp(near, axis=0) > AS_NEAR * np.abs(near).max())
            vectors[row] = near.mean(axis=0) if several[row] else near[0]
        return asked, vectors, several


def averaged(remanence: Remanence, mesh: Mesh, points: FloatArray) -> IntArray:
    """Numbers of the elements whose remanence is the mean over several places that are as near."""
    of = getattr(remanence, "averaged", None)
    return np.zeros(0, dtype=np.int64) if of is None else of(mesh, points)
