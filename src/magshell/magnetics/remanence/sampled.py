"""Remanence given by numbers: a function of the position, a vector per element, vectors at places."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.remanence.vectors import Remanence

if TYPE_CHECKING:
    from magshell.mesh import Mesh


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
        Arrays that are no n × 3 finite numbers; when used: an element without a place within the tolerance.
    """
    where, values = np.array(places, dtype=float), np.array(vectors, dtype=float)
    for name, array in (("places", where), ("vectors", values)):
        if array.ndim != 2 or array.shape[1] != 3 or len(array) != len(where) or not len(array):
            raise InputError(f"remanence: {name} have shape {array.shape}; both need the same n × 3 with n > 0")
        if not np.isfinite(array).all():
            raise InputError(f"remanence: {name}[{np.flatnonzero(~np.isfinite(array).all(axis=1))[0]}] is not finite")

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        from scipy.spatial import cKDTree

        asked = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
        corners = mesh.points[mesh.elements[asked, :4]]
        centres = 0.5 * mesh.points[mesh.elements[asked, 4:]].sum(axis=1) - 0.25 * corners.sum(axis=1)
        reach = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1) if tolerance is None else tolerance
        distance, nearest = map(np.asarray, cKDTree(where).query(centres))
        far = np.flatnonzero(distance > reach)
        if far.size:
            worst = far[np.argmax(distance[far])]
            place = ", ".join(f"{x:.6g}" for x in centres[worst])
            raise InputError(
                f"remanence: {far.size} of {len(asked)} elements have no value near them; the worst is element "
                f"{asked[worst]} at ({place}) m, {distance[worst]:.3g} m from the nearest place. Check the unit of "
                "the places, cover the whole part or give a larger tolerance"
            )
        found = np.full(points.shape, np.nan)
        found[asked] = values[nearest][:, None]
        return found

    return sample
