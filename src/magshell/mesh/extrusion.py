"""Thin-walled profiles: cross-sections of straight walls, extruded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.mesh.arguments import axes, count, divisions, positive
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.grid import grid
from magshell.mesh.mesh import Mesh
from magshell.mesh.welding import merged

ENDS = ("start", "end")
"""Edge groups of the two ends of a profile."""


def profile(
    points: Mapping[str, Sequence[float]],
    walls: Mapping[str, Sequence[str]],
    length: float,
    elements: Sequence[int],
    divided: Mapping[str, int] | None = None,
    axis: Sequence[float] = (0.0, 0.0, 1.0),
    first: Sequence[float] = (1.0, 0.0, 0.0),
) -> Mesh:
    """Thin-walled profile: straight walls between the points of a cross-section, extruded along an axis.

    L, Z and T sections, boxes of one or more cells and ribbed plates are profiles: any number of walls may meet at a
    point.

    Parameters
    ----------
    points : mapping of name to (2,)
        Points of the cross-section, m, in the plane through the origin across the axis.
    walls : mapping of name to (str, str)
        The two points that each wall joins.
    length : float
        Along the axis, from the origin, m.
    elements : (int, int)
        Number of elements across a wall and along the axis.
    divided : mapping of name to int, optional
        Number of elements across walls that are to have another.
    axis : (3,)
        Direction of the extrusion.
    first : (3,)
        Direction of the first coordinate of the points; what it has along the axis is dropped. The second is that of
        axis × first.

    Returns
    -------
    Mesh
        With an element group for each wall, an edge group for each point (a fold, a joint or a free edge), and the edge
        groups start (at the origin) and end (at `length`). The normal of a wall is that of (direction from its first
        point to its second) × axis, which is outward on a section that is walked like a circle about the axis.

    Raises
    ------
    InputError
        A point without a wall or a wall without a point; points or walls that lie on each other or cross; a wall that
        passes through a point; a name that is used twice; a length or number that is not allowed; `first` along the
        axis.
    """
    length = positive("profile", "length", length)
    across, along = divisions("profile", elements)
    e1, e2, e3 = axes("profile", axis, "first", first)
    places = _points(points)
    ends = _walls(walls, places)
    numbers = dict.fromkeys(ends, across) | _divided(divided or {}, ends)
    _check_names(places, ends)
    tolerance = COINCIDENT * float(np.linalg.norm([*np.ptp(list(places.values()), axis=0), length]))
    _check_crossings(places, ends, tolerance)
    nodes, rows, groups = [], [], {}
    edges: dict[str, list[IntArray]] = {name: [] for name in (*places, *ENDS)}
    node_count = element_count = 0
    for name, (begin, end) in ends.items():
        pattern = grid(numbers[name], along)
        s, t = pattern.parameters[:, :1], pattern.parameters[:, 1:]
        flat = (1.0 - s) * places[begin] + s * places[end]
        nodes.append(flat[:, :1] * e1 + flat[:, 1:] * e2 + length * t * e3)
        sides = pattern.sides({"begin": (0, 0.0), "end": (0, 1.0), "start": (1, 0.0), "stop": (1, 1.0)})
        for group, side in ((begin, "begin"), (end, "end"), (ENDS[0], "start"), (ENDS[1], "stop")):
            edges[group].append(sides[side] + node_count)
        rows.append(pattern.elements + node_count)
        groups[name] = element_count + np.arange(len(pattern.elements))
        node_count, element_count = node_count + len(flat), element_count + len(pattern.elements)
    every = np.concatenate(nodes)
    kept, new = np.unique(merged(every, tolerance), return_inverse=True)
    named = {name: new[np.concatenate(each)] for name, each in edges.items()}
    return Mesh(every[kept], new[np.concatenate(rows)], groups, named)


def _points(points: Mapping[str, Any]) -> dict[str, FloatArray]:
    if not isinstance(points, Mapping) or len(points) < 2:
        raise InputError(f"profile: points = {points!r} is not allowed; it must map two names or more to positions.")
    places = {}
    for name, given in points.items():
        try:
            place = np.array(given, dtype=np.float64)
        except (TypeError, ValueError):
            place = np.zeros(0)
        if place.shape != (2,) or not np.isfinite(place).all():
            raise InputError(
                f"profile: point '{name}' must be two finite coordinates of the cross-section in m, not {given!r}."
            )
        places[name] = place
    return places


def _walls(walls: Mapping[str, Any], places: Mapping[str, FloatArray]) -> dict[str, tuple[str, str]]:
    if not isinstance(walls, Mapping) or not walls:
        raise InputError(f"profile: walls = {walls!r} is not allowed; it must map names to two points each.")
    ends: dict[str, tuple[str, str]] = {}
    for name, given in walls.items():
        pair = () if isinstance(given, str) or not isinstance(given, Sequence) else tuple(given)
        if len(pair) != 2 or pair[0] == pair[1]:
            raise InputError(f"profile: wall '{name}' must join two points, by their names, not {given!r}.")
        for point in pair:
            if point not in places:
                raise InputError(
                    f"profile: wall '{name}' joins '{point}', which is no point. {suggest(str(point), places)}"
                )
        ends[name] = pair
    for point in places:
        if not any(point in pair for pair in ends.values()):
            raise InputError(f"profile: no wall joins point '{point}'; leave it out.")
    return ends


def _divided(divided: Mapping[str, Any], walls: Mapping[str, Any]) -> dict[str, int]:
    for name in divided:
        if name not in walls:
            raise InputError(f"profile: '{name}' is divided, but is no wall. {suggest(str(name), walls)}")
    return {name: count("profile", f"elements of wall '{name}'", value) for name, value in divided.items()}


def _check_names(places: Mapping[str, Any], walls: Mapping[str, Any]) -> None:
    for name in (*places, *walls):
        if name in ENDS or (name in places and name in walls):
            taken = "an end of the profile" if name in ENDS else "a point and of a wall"
            raise InputError(f"profile: '{name}' is the name of {taken}; every group must have a name of its own.")


def _check_crossings(places: Mapping[str, FloatArray], walls: Mapping[str, tuple[str, str]], tolerance: float) -> None:
    """Refuse points and walls that lie on each other, and walls that cross."""
    for one, other in combinations(places, 2):
        if np.linalg.norm(places[one] - places[other]) <= tolerance:
            raise InputError(f"profile: points '{one}' and '{other}' lie on each other; make them one.")
    for name, pair in walls.items():
        start, along = places[pair[0]], places[pair[1]] - places[pair[0]]
        for point, place in places.items():
            share = float(((place - start) @ along / (along @ along)).clip(0.0, 1.0))
            if point not in pair and np.linalg.norm(start + share * along - place) <= tolerance:
                raise InputError(f"profile: point '{point}' lies within wall '{name}'; split the wall there.")
    for (one, first), (other, second) in combinations(walls.items(), 2):
        if set(first) == set(second):
            raise InputError(f"profile: walls '{one}' and '{other}' join the same two points; leave one out.")
        if not set(first) & set(second) and _cross(*(places[name] for name in (*first, *second))):
            raise InputError(f"profile: walls '{one}' and '{other}' cross; put a point there and split both.")


def _cross(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> bool:
    """Whether the segments ab and cd cross, with no end of one on the other."""

    def left(p: FloatArray, q: FloatArray, r: FloatArray) -> bool:
        return bool((q[0] - p[0]) * (r[1] - p[1]) > (q[1] - p[1]) * (r[0] - p[0]))

    return left(a, b, c) != left(a, b, d) and left(c, d, a) != left(c, d, b)
