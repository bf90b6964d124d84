"""Elements between given coordinates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.wording import place

Range = Sequence[float] | None


def elements_between(points: FloatArray, elements: IntArray, ranges: Sequence[Range], size: float) -> IntArray:
    """Numbers of the elements that lie between coordinates.

    Parameters
    ----------
    points : (nodes, 3)
        m.
    elements : (elements, 8)
    ranges : three of (float, float) or None
        Least and greatest coordinate, m; None leaves it free.
    size : float
        Of the mesh, m.

    Raises
    ------
    InputError
        No range; one that is not two finite numbers that rise; no element between them; an element that lies across a
        bound.
    """
    given = {axis: np.asarray(bounds, dtype=float) for axis, bounds in enumerate(ranges) if bounds is not None}
    if not given:
        raise InputError("give at least one of the ranges x1, x2, x3, or groups")
    for axis, bounds in given.items():
        if bounds.shape != (2,) or not np.isfinite(bounds).all() or bounds[0] >= bounds[1]:
            raise InputError(f"x{axis + 1} is {bounds.tolist()}; it must be a least and a greatest coordinate, m")
    x, near = points[elements], COINCIDENT * size
    inside, strictly = np.ones(x.shape[:2], dtype=bool), np.ones(x.shape[:2], dtype=bool)
    for axis, (low, high) in given.items():
        inside &= (x[..., axis] >= low - near) & (x[..., axis] <= high + near)
        strictly &= (x[..., axis] > low + near) & (x[..., axis] < high - near)
    whole = inside.all(axis=1)
    across = np.flatnonzero(strictly.any(axis=1) & ~whole)
    if across.size:
        element = int(across[0])
        raise InputError(
            f"an element, from {place(x[element].min(axis=0))} to {place(x[element].max(axis=0))}, lies across "
            "a bound of the range; the edges of elements must lie there"
        )
    if not whole.any():
        raise InputError(
            f"no element lies there; the mesh spans {place(points.min(axis=0))} to {place(points.max(axis=0))}"
        )
    return np.flatnonzero(whole)
