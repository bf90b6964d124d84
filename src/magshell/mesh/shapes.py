"""Shapes in space, for selections: how far a position lies outside of a sphere, a cylinder, a prism."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError

Shape = Callable[[FloatArray], AnyArray]
"""Of positions (k, 3), m: how far outside each lies (k,), m, at most 0 inside; or (k,) whether it lies inside."""


def in_sphere(centre: Sequence[float], radius: float | Sequence[float]) -> Shape:
    """Inside of a sphere, or between two about the same point.

    Parameters
    ----------
    centre : (3,)
        m.
    radius : float or (float, float)
        Largest distance from the centre, or least and largest, m.

    Raises
    ------
    InputError
        Not three finite coordinates; a radius that is not positive, two that do not rise.
    """
    middle, (inner, outer) = _vector("centre", centre), _radii(radius)
    return lambda x: _beyond(np.linalg.norm(x - middle, axis=1), inner, outer)


def in_cylinder(through: Sequence[float], axis: Sequence[float], radius: float | Sequence[float]) -> Shape:
    """Inside of an endless cylinder, or between two about the same axis.

    Parameters
    ----------
    through : (3,)
        A point of the axis, m.
    axis : (3,)
        Its direction.
    radius : float or (float, float)
        Largest distance from the axis, or least and largest, m.

    Raises
    ------
    InputError
        Not three finite numbers; an axis of length 0; a radius that is not positive, two that do not rise.
    """
    point, direction, (inner, outer) = _vector("through", through), _vector("axis", axis), _radii(radius)
    length = np.linalg.norm(direction)
    if not length:
        raise InputError("axis is the zero vector; it must have a direction")
    return lambda x: _beyond(np.linalg.norm(np.cross(x - point, direction / length), axis=1), inner, outer)


def in_polygon(corners: Sequence[Sequence[float]] | FloatArray) -> Shape:
    """Above, in and below a polygon in the plane X1-X2.

    Parameters
    ----------
    corners : (n, 2)
        X1 and X2 of three or more corners in the order of a walk around it, m.

    Raises
    ------
    InputError
        Not three or more pairs of finite numbers.
    """
    start = np.asarray(corners, dtype=float)
    if start.ndim != 2 or start.shape[1:] != (2,) or len(start) < 3 or not np.isfinite(start).all():
        raise InputError("polygon: expected three or more corners, each two finite coordinates X1, X2, in m")
    side = np.roll(start, -1, axis=0) - start

    def outside(x: FloatArray) -> FloatArray:
        away = x[:, None, :2] - start
        share = np.clip((away * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-300), 0.0, 1.0)
        distance: FloatArray = np.linalg.norm(away - share[..., None] * side, axis=2).min(axis=1)
        above = away[..., 1] >= 0.0
        crossed = above != np.roll(above, -1, axis=1)
        turn = side[:, 0] * away[..., 1] - side[:, 1] * away[..., 0]
        inside = (crossed & ((turn > 0.0) == (side[:, 1] > 0.0))).sum(axis=1) % 2 == 1
        return np.where(inside, -distance, distance)

    return outside


def outside(x: FloatArray, shape: Shape) -> FloatArray:
    """How far outside of a shape positions (k, 3) lie, m; infinitely far where all that it says is that they do.

    Raises
    ------
    InputError
        It does not return an array (k,).
    """
    found = np.asarray(shape(x))
    if found.shape != (len(x),) or found.dtype.kind not in "bfiu":
        raise InputError(
            f"a shape returned {found.dtype} of shape {found.shape} for {len(x)} positions; it must return one number "
            "for each, how far outside it lies, or whether it lies inside"
        )
    return np.where(found, 0.0, np.inf) if found.dtype.kind == "b" else found.astype(float)


def _beyond(distance: FloatArray, inner: float, outer: float) -> FloatArray:
    return np.maximum(distance - outer, inner - distance)


def _radii(radius: float | Sequence[float]) -> tuple[float, float]:
    given = np.atleast_1d(np.asarray(radius, dtype=float))
    inner, outer = (-np.inf, given[0]) if given.shape == (1,) else given if given.shape == (2,) else (np.nan, np.nan)
    if not (np.isfinite(outer) and inner < outer and outer > 0.0):
        raise InputError(
            f"radius is {np.asarray(radius).tolist()}; it must be positive, or a least and a largest one, m"
        )
    return float(inner), float(outer)


def _vector(name: str, value: Sequence[float]) -> FloatArray:
    vector = np.asarray(value, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f"{name} is {vector.tolist()}; it must be three finite numbers")
    return vector
