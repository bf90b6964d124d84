"""Remanent flux density of the undeformed material, T: constant, along meridians or circles, by group, by element.

Every function returns a `Remanence`: a callable that takes the mesh and points of each of its elements, shape
(elements, points, 3), and gives the remanence there, same shape. It is taken constant through the thickness.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError

if TYPE_CHECKING:
    from magshell.mesh import Mesh

Remanence: TypeAlias = Callable[["Mesh", FloatArray], FloatArray]


def _vector(name: str, value: ArrayLike) -> FloatArray:
    vector = np.asarray(value, dtype=float)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise InputError(f"remanence: {name} is {value!r}; it needs 3 finite components")
    return vector


def _direction(name: str, value: ArrayLike) -> FloatArray:
    vector = _vector(name, value)
    length = np.linalg.norm(vector)
    if length == 0.0:
        raise InputError(f"remanence: {name} is the zero vector; it must have a direction")
    return np.asarray(vector / length)


def _along(direction: FloatArray, magnitude: float, what: str) -> FloatArray:
    length = np.linalg.norm(direction, axis=-1, keepdims=True)
    if np.any(length < 1e-12):
        raise InputError(f"remanence: the {what} direction is undefined on the axis itself; a point lies there")
    return np.asarray(magnitude * direction / length)


def constant(vector: ArrayLike) -> Remanence:
    """The same vector (3,), T, everywhere."""
    value = _vector("vector", vector)
    return lambda mesh, points: np.broadcast_to(value, points.shape).copy()


def meridional(magnitude: float, axis: ArrayLike = (0.0, 0.0, 1.0), mirrored: bool = True) -> Remanence:
    """Along the meridians of a sphere about the origin, pointing away from the pole on the +axis side.

    Parameters
    ----------
    magnitude : float
        T.
    axis : array_like, shape (3,)
        From the centre to the pole.
    mirrored : bool
        Reverse it below the equator, so that both halves are mirror images.
    """
    pole = _direction("axis", axis)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        height = points @ pole
        radius = np.linalg.norm(points, axis=-1)
        along = points * (height / radius**2)[..., None] - pole
        sign = np.where(mirrored & (height < 0.0), -1.0, 1.0)
        return _along(along, magnitude, "meridional") * sign[..., None]

    return sample


def circumferential(magnitude: float, axis: ArrayLike = (0.0, 0.0, 1.0), towards: ArrayLike | None = None) -> Remanence:
    """Along the circles about an axis through the origin, in the sense axis × radius.

    Parameters
    ----------
    magnitude : float
        T.
    axis : array_like, shape (3,)
        Axis of the circles.
    towards : array_like, shape (3,), optional
        Where the component along this direction would be negative, the sign is flipped.
    """
    centre_line = _direction("axis", axis)
    preferred = None if towards is None else _direction("towards", towards)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        values = _along(np.cross(centre_line, points), magnitude, "circumferential")
        if preferred is not None:
            values = values * np.where(values @ preferred < 0.0, -1.0, 1.0)[..., None]
        return values

    return sample


def function(of_position: Callable[[FloatArray], ArrayLike]) -> Remanence:
    """A function of the reference position: takes points (n, 3) in m, returns vectors (n, 3) in T."""

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        values = np.asarray(of_position(points.reshape(-1, 3)), dtype=float)
        if values.shape != (points.size // 3, 3):
            raise InputError(f"remanence: the function returned shape {values.shape}; expected {(points.size // 3, 3)}")
        return values.reshape(points.shape)

    return sample


def by_group(remanences: Mapping[str, Remanence]) -> Remanence:
    """One remanence per element group; elements in none of the groups have none."""

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        values = np.zeros(points.shape)
        owner = np.full(len(points), "", dtype=object)
        for group, remanence in remanences.items():
            members = mesh.elements_of(group)
            taken = members[owner[members] != ""]
            if taken.size:
                raise InputError(
                    f"remanence: element {taken[0]} is in the groups '{owner[taken[0]]}' and '{group}'; "
                    "one of them must give it up"
                )
            owner[members] = group
            values[members] = remanence(mesh, points)[members]
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
