"""The type of every remanence, and common checks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray, three_finite
from magshell.errors import InputError

if TYPE_CHECKING:
    from magshell.mesh import Mesh

Remanence: TypeAlias = Callable[["Mesh", FloatArray], FloatArray]
"""From the mesh and points of each of its elements, (elements, points, 3) in m, to the remanence there, in T."""

ON_THE_AXIS = 1e-12


def vector(name: str, value: ArrayLike) -> FloatArray:
    """Three finite components."""
    components = three_finite(value)
    if components is None:
        raise InputError(f"remanence: {name} is {value!r}; it needs 3 finite components")
    return components


def direction(name: str, value: ArrayLike) -> FloatArray:
    """A unit vector along three finite components that are not all zero."""
    components = vector(name, value)
    length = np.linalg.norm(components)
    if length == 0.0:
        raise InputError(f"remanence: {name} is the zero vector; it must have a direction")
    return np.asarray(components / length)


def given_once(
    key: str, vector: Sequence[float] | None, magnitude: float | None, direction: Sequence[float] | None
) -> tuple[str, str] | None:
    """Key and fault, unless a vector is given or else its magnitude and direction are."""
    polar = (magnitude is not None, direction is not None)
    if vector is None and polar == (False, False):
        return key, "is missing; give it, or magnitude and direction"
    if vector is not None and any(polar):
        return key, "is given beside magnitude or direction; give one or the other"
    if vector is None and not all(polar):
        present, missing = ("magnitude", "direction") if polar[0] else ("direction", "magnitude")
        return missing, f"is missing beside {present}"
    return None


def scaled(along: FloatArray, magnitude: float, what: str) -> FloatArray:
    """Vectors (..., 3) made this long."""
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    if np.any(length < ON_THE_AXIS):
        raise InputError(f"remanence: the {what} direction is undefined on the axis itself; a point lies there")
    return np.asarray(magnitude * along / length)


def flipped_towards(values: FloatArray, preferred: FloatArray | None) -> FloatArray:
    """Vectors (..., 3), reversed where their component along `preferred` is negative."""
    if preferred is None:
        return values
    return np.asarray(values * np.where(values @ preferred < 0.0, -1.0, 1.0)[..., None])


def first_element(bad: AnyArray) -> int:
    """Number of the first element with a bad point (elements, points)."""
    return int(np.flatnonzero(bad.any(axis=1))[0])
