"""Nodes, edges and elements by where they lie: at coordinates, between them, in shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.geometry import COINCIDENT, centres
from magshell.mesh.shapes import Shape, outside
from magshell.mesh.wording import place

Range: TypeAlias = Sequence[float] | None
"""Least and greatest coordinate, m; None leaves it free."""
Coordinate: TypeAlias = float | Range
"""A coordinate that is met, or the two that one lies between, m; None leaves it free."""
Within: TypeAlias = Shape | Sequence[Shape] | None
"""A shape, or several that are all meant; None: everywhere."""


def elements_there(points: FloatArray, elements: IntArray, ranges: Sequence[Range], within: Within) -> IntArray:
    """Which elements lie between coordinates and have their centres in shapes.

    Parameters
    ----------
    points : (nodes, 3)
        m.
    elements : (elements, 8)
    ranges : three of Range
    within : Within

    Returns
    -------
    (k,)
        Their numbers in `elements`.

    Raises
    ------
    InputError
        Nothing is given; a range that is not two finite numbers that rise; no element is there; an element that lies
        across a bound of a range.
    """
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    bounds = _bounds(ranges, within, "ranges x1, x2, x3, shapes or groups")
    for axis, (low, high) in bounds.items():
        if low >= high:
            raise InputError(f"x{axis + 1} is {[low, high]}; it must be a least and a greatest coordinate, m")
    x, near = points[elements], COINCIDENT * size
    gaps = _outside(x, bounds)
    whole = (gaps <= near).all(axis=1)
    across = np.flatnonzero((gaps < -near).any(axis=1) & ~whole)
    if across.size:
        element = int(across[0])
        raise InputError(
            f"an element, from {place(x[element].min(axis=0))} to {place(x[element].max(axis=0))}, lies across "
            "a bound of the range; the edges of elements must lie there"
        )
    there = whole & (_out_of_shapes(centres(points, elements), within) <= near)
    if not there.any():
        raise InputError(f"no element lies there; {_spanned(points)}")
    return np.flatnonzero(there)


def items_there(
    what: str, positions: FloatArray, coordinates: Sequence[Coordinate], within: Within, mesh: FloatArray
) -> IntArray:
    """Which edges or nodes have all of their nodes at or between coordinates and in shapes.

    Parameters
    ----------
    what : str
        What one of them is called.
    positions : (items, nodes, 3)
        Of their nodes, m.
    coordinates : three of Coordinate
    within : Within
    mesh : (nodes, 3)
        All positions of the mesh, m.

    Returns
    -------
    (k,)
        Their numbers among the items.

    Raises
    ------
    InputError
        Nothing is given; a coordinate that is not finite; a range that does not rise; nothing is there.
    """
    bounds = _bounds(coordinates, within, "coordinates x1, x2, x3, shapes or groups")
    near = COINCIDENT * float(np.linalg.norm(np.ptp(mesh, axis=0)))
    in_shapes = _out_of_shapes(positions.reshape(-1, 3), within).reshape(positions.shape[:2])
    gaps = np.maximum(_outside(positions, bounds), in_shapes).max(axis=1)
    chosen = np.flatnonzero(gaps <= near)
    if not chosen.size:
        nearest = positions[np.argmin(gaps)] if np.isfinite(gaps).any() else None
        at = "" if nearest is None else f". The nearest is at {' to '.join(place(each) for each in nearest[:2])}"
        raise InputError(f"no {what} {_sought(bounds, within)}{at}; {_spanned(mesh)}")
    return chosen


def _bounds(given: Sequence[Coordinate], within: Within, needed: str) -> dict[int, tuple[float, float]]:
    """Least and greatest coordinate of every axis that has them."""
    found = {}
    for axis, coordinate in enumerate(given):
        if coordinate is None:
            continue
        values = np.asarray(coordinate, dtype=float)
        if values.shape not in ((), (2,)) or not np.isfinite(values).all() or (values.ndim and values[0] > values[1]):
            raise InputError(
                f"x{axis + 1} is {values.tolist()}; it must be a coordinate that is finite, or a least and a greatest "
                "coordinate, m"
            )
        low, high = np.broadcast_to(values, (2,)).tolist()
        found[axis] = (low, high)
    if not found and within is None:
        raise InputError(f"give at least one of the {needed}")
    return found


def _outside(x: FloatArray, bounds: Mapping[int, tuple[float, float]]) -> FloatArray:
    """How far positions (n, m, 3) lie outside of the bounds, (n, m)."""
    gaps = np.full(x.shape[:2], -np.inf)
    for axis, (low, high) in bounds.items():
        gaps = np.maximum(gaps, np.maximum(low - x[..., axis], x[..., axis] - high))
    return gaps


def _out_of_shapes(x: FloatArray, within: Within) -> FloatArray:
    """How far positions (k, 3) lie outside of the shapes, (k,)."""
    shapes = () if within is None else (within,) if callable(within) else within
    return np.max([np.full(len(x), -np.inf), *(outside(x, shape) for shape in shapes)], axis=0)


def _sought(bounds: Mapping[int, tuple[float, float]], within: Within) -> str:
    """What must hold, in words."""
    parts = [
        f"X{axis + 1} = {low:.6g} m" if low == high else f"X{axis + 1} from {low:.6g} to {high:.6g} m"
        for axis, (low, high) in bounds.items()
    ]
    words = [f"has {', '.join(parts)}"] if parts else []
    return " and ".join([*words, *(["lies in the shape"] if within is not None else [])])


def _spanned(points: FloatArray) -> str:
    return f"the mesh spans {place(points.min(axis=0))} to {place(points.max(axis=0))}"
