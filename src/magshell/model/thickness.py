"""Thickness that varies over the mid-surface: by a function, along a direction, from a table.

A `Thickness` is a callable that takes the mesh and points of each of its elements, shape (elements, points, 3), and
gives the thickness there, shape (elements, points), m. Points that are not needed are NaN, and so may their thickness
be. Continuous ones taper across the edges of elements; stepped ones are constant in each element.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from magshell import units
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.remanence.files import PLACE, check_one_value_each, factor
from magshell.magnetics.remanence.inside import find
from magshell.magnetics.remanence.sampled import AS_NEAR
from magshell.mesh import Mesh
from magshell.mesh.geometry import centres
from magshell.remembered import remembered
from magshell.tables import Columns, duplicate, read_table

Thickness: TypeAlias = Callable[[Mesh, FloatArray], FloatArray]
"""From the mesh and points of each of its elements, (elements, points, 3) in m, to the thickness there, in m."""


@remembered
def function(of_position: Callable[[FloatArray], ArrayLike]) -> Thickness:
    """A function of the reference position: takes points (n, 3) in m, returns thicknesses (n,) in m."""

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        asked = np.isfinite(points).all(axis=-1)
        values = np.full(points.shape[:-1], np.nan)
        found = np.asarray(of_position(points[asked]), dtype=float)
        if found.shape != (int(asked.sum()),):
            raise InputError(f"thickness: the function returned shape {found.shape}; expected {(int(asked.sum()),)}")
        values[asked] = found
        return values

    return sample


@remembered
def profile(along: ArrayLike, positions: ArrayLike, values: ArrayLike) -> Thickness:
    """Piecewise linear along a direction, constant beyond the first and the last position.

    Parameters
    ----------
    along : array_like, shape (3,)
        Direction of the coordinate, which is 0 at the origin.
    positions : array_like, shape (n,)
        m, rising.
    values : array_like, shape (n,)
        Thickness there, m.

    Raises
    ------
    InputError
        No direction; positions that do not rise; not one value for each.
    """
    direction, at, thickness = (np.asarray(given, dtype=float) for given in (along, positions, values))
    if direction.shape != (3,) or not np.isfinite(direction).all() or not direction.any():
        raise InputError(f"thickness: along is {direction.tolist()}; it must be a direction of 3 components")
    if at.ndim != 1 or not at.size or not np.isfinite(at).all() or np.any(np.diff(at) <= 0.0):
        raise InputError(f"thickness: positions are {at.tolist()}; they must be finite numbers that rise")
    if thickness.shape != at.shape:
        raise InputError(f"thickness: values has {thickness.size} entries; there are {at.size} positions")
    unit = direction / np.linalg.norm(direction)
    return lambda mesh, points: np.asarray(np.interp(points @ unit, at, thickness))


@remembered
def per_element(values: ArrayLike) -> Thickness:
    """One value (elements,), m, for each element."""
    thickness = np.array(values, dtype=float)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        if thickness.shape != (len(mesh.elements),):
            raise InputError(f"thickness: has shape {thickness.shape}; the mesh has {len(mesh.elements)} elements")
        return np.broadcast_to(thickness[:, None], points.shape[:-1]).copy()

    return sample


@remembered
def per_node(values: ArrayLike) -> Thickness:
    """One value (nodes,), m, for each node; interpolated as the surface is."""
    thickness = np.array(values, dtype=float)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        if thickness.shape != (len(mesh.points),):
            raise InputError(f"thickness: has shape {thickness.shape}; the mesh has {len(mesh.points)} nodes")
        return _between_nodes(mesh, points, thickness)

    return sample


@remembered
def at_places(places: ArrayLike, values: ArrayLike, stepped: bool = False, tolerance: float | None = None) -> Thickness:
    """Values at places, as a measurement gives them.

    Parameters
    ----------
    places : array_like, shape (n, 3)
        m.
    values : array_like, shape (n,)
        m.
    stepped : bool, optional
        An element has the value of the place nearest to its centre. Otherwise each node has that of the place nearest
        to it, and between the nodes it is interpolated as the surface is. Where several places are as near: their mean.
    tolerance : float, optional
        Largest distance to the place, m; without it half the longest diagonal of the element, or of the elements of
        the node.

    Raises
    ------
    InputError
        Arrays that are no n × 3 and n finite numbers; a place with two values; when used: no place is near enough.
    """
    where, thickness = np.array(places, dtype=float), np.array(values, dtype=float)
    if where.ndim != 2 or where.shape[1:] != (3,) or thickness.shape != where.shape[:1] or not len(where):
        raise InputError(f"thickness: places and values have the shapes {where.shape} and {thickness.shape}")
    if not np.isfinite(where).all() or not np.isfinite(thickness).all():
        raise InputError("thickness: places or values are not finite")
    found = duplicate(where, thickness[:, None])
    if found is not None:
        raise InputError(f"thickness: places[{found[0]}] and places[{found[1]}] are one place with different values")

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        asked = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
        middles = centres(mesh.points, mesh.elements[asked])
        half = np.linalg.norm(mesh.points[mesh.elements[asked, :4]] - middles[:, None], axis=2).max(axis=1)
        if stepped:
            at_centres = np.full(len(points), np.nan)
            at_centres[asked] = _nearest(where, thickness, middles, half, tolerance)
            return np.broadcast_to(at_centres[:, None], points.shape[:-1]).copy()
        nodes, reach = np.unique(mesh.elements[asked]), np.zeros(len(mesh.points))
        np.maximum.at(reach, mesh.elements[asked], half[:, None])
        at_nodes = np.full(len(mesh.points), np.nan)
        at_nodes[nodes] = _nearest(where, thickness, mesh.points[nodes], reach[nodes], tolerance)
        return _between_nodes(mesh, points, at_nodes)

    return sample


def from_file(
    file: str | os.PathLike[str],
    thickness_unit: str = "m",
    length_unit: str | None = "m",
    stepped: bool = False,
    tolerance: float | None = None,
) -> Thickness:
    """Thickness from a table.

    Parameters
    ----------
    file : path
        A CSV file whose first line names the column `thickness`, and `x1,x2,x3` where the rows are places (see
        `at_places`). Without them it has one row per node or one per element, in the order of the mesh. Other columns
        are passed over.
    thickness_unit : str
        Of the thickness.
    length_unit : str or None
        Of the places; None: there are none.
    stepped, tolerance
        See `at_places`.

    Raises
    ------
    InputError
        No such file or column; a line with something that is not a number; an unknown unit, or another one in a
        heading; a place with two values; when used: neither as many rows as nodes nor as many as elements.
    """
    metre, path = factor(thickness_unit, units.LENGTH), pathlib.Path(file)
    wanted = Columns(("thickness",), units.LENGTH, thickness_unit, "thickness_unit")
    table = read_table(path, wanted, Columns(PLACE, units.LENGTH, length_unit, "length_unit"))
    values = metre * table.wanted[:, 0]
    if table.optional is not None:
        if length_unit is None:
            raise InputError(f"{path.name}: has the columns {','.join(PLACE)}; length_unit must say in which unit")
        check_one_value_each(path, table, "Keep one of the lines")
        return at_places(factor(length_unit, units.LENGTH) * table.optional, values, stepped, tolerance)
    return _by_rows(path.name, values)


@remembered
def _by_rows(name: str, values: FloatArray) -> Thickness:
    """Of a file without places: a row for each node or for each element."""

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        if len(values) not in (len(mesh.points), len(mesh.elements)):
            raise InputError(
                f"{name}: has {len(values)} rows and no places; the mesh has {len(mesh.points)} nodes and "
                f"{len(mesh.elements)} elements"
            )
        return (per_node if len(values) == len(mesh.points) else per_element)(values)(mesh, points)

    return sample


def _between_nodes(mesh: Mesh, points: FloatArray, at_nodes: FloatArray) -> FloatArray:
    return find(mesh, points).at(at_nodes[mesh.elements][..., None])[..., 0]


def _nearest(
    places: FloatArray, values: FloatArray, targets: FloatArray, reach: FloatArray, tolerance: float | None
) -> FloatArray:
    """Values (n,) of the places nearest to targets (n, 3), no farther than the reach (n,) or the tolerance."""
    from scipy.spatial import cKDTree

    tree = cKDTree(places)
    distance, nearest = map(np.asarray, tree.query(targets, k=[1, 2]))
    far = np.flatnonzero(distance[:, 0] > (reach if tolerance is None else tolerance))
    if far.size:
        worst = far[np.argmax(distance[far, 0])]
        raise InputError(
            f"thickness: has no value near ({', '.join(f'{x:.6g}' for x in targets[worst])}) m; the nearest place is "
            f"{distance[worst, 0]:.3g} m away. Check length_unit, cover the whole region or give a larger tolerance"
        )
    found = values[nearest[:, 0]]
    for row in np.flatnonzero(distance[:, 1] - distance[:, 0] <= AS_NEAR * reach):
        found[row] = values[tree.query_ball_point(targets[row], distance[row, 0] + AS_NEAR * reach[row])].mean()
    return np.asarray(found)
