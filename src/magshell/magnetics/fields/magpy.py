"""Objects of magpylib as sources of this package: what they are, where they are and how they are turned.

magpylib's objects are mutable; what is made of them here is not, so a model does not change after it was made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields.coils import Loop, Polygon
from magshell.magnetics.fields.dipoles import Dipole, Sphere
from magshell.magnetics.fields.magnets import Cuboid, Cylinder
from magshell.magnetics.fields.polyhedron import Polyhedron
from magshell.magnetics.fields.rings import CylinderSegment, Ring
from magshell.magnetics.fields.shapes import Shape


def _cylinder(one: Any) -> Shape:
    diameter, height = np.asarray(one.dimension, dtype=float).tolist()
    return Cylinder(diameter, height, one.polarization)


def _segment(one: Any) -> Shape:
    inner, outer, height, start, end = np.asarray(one.dimension, dtype=float).tolist()
    J = one.polarization
    if end - start < 360.0:
        return CylinderSegment(2.0 * inner, 2.0 * outer, height, np.deg2rad([start, end]), J)
    return Ring(2.0 * inner, 2.0 * outer, height, J) if inner else Cylinder(2.0 * outer, height, J)


def _polygon(one: Any) -> Shape:
    vertices = np.asarray(one.vertices, dtype=float)
    if not np.allclose(vertices[0], vertices[-1], rtol=0.0, atol=1e-9 * float(np.ptp(vertices, axis=0).max())):
        raise InputError(
            "the polyline is open: its last vertex is not its first. A current flows in closed loops; the field of an "
            "open line is not free of curl"
        )
    return Polygon(vertices[:-1], float(one.current))


def _tetrahedron(one: Any) -> Shape:
    return Polyhedron(one.vertices, [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]], one.polarization)


KNOWN: Mapping[str, tuple[tuple[str, ...], Callable[[Any], Shape]]] = {
    "Cuboid": (("dimension", "polarization"), lambda one: Cuboid(one.dimension, one.polarization)),
    "Cylinder": (("dimension", "polarization"), _cylinder),
    "CylinderSegment": (("dimension", "polarization"), _segment),
    "Sphere": (("diameter", "polarization"), lambda one: Sphere(float(one.diameter), one.polarization)),
    "Tetrahedron": (("vertices", "polarization"), _tetrahedron),
    "TriangularMesh": (
        ("vertices", "polarization"),
        lambda one: Polyhedron(one.vertices, one.faces, one.polarization),
    ),
    "Dipole": (("moment",), lambda one: Dipole(one.moment)),
    "Circle": (("diameter", "current"), lambda one: Loop(float(one.diameter), float(one.current))),
    "Polyline": (("vertices", "current"), _polygon),
}


def is_of_magpylib(one: object) -> bool:
    """Whether something is an object of magpylib; does not import it."""
    return type(one).__module__.partition(".")[0] == "magpylib"


def shapes_of(one: Any) -> Iterator[tuple[Shape, FloatArray, FloatArray]]:
    """Shape, position (3,) and rotation vector (3,) of an object of magpylib, or of all in a collection.

    Raises
    ------
    InputError
        It is of a kind that is not known here, lacks a value, or has a path of its own.
    """
    name = type(one).__name__
    if name == "Collection":
        for child in one.sources_all:
            yield from shapes_of(child)
        return
    if name not in KNOWN:
        raise InputError(f"magpylib's {name} is not known here; known are {', '.join(KNOWN)} and Collection")
    needed, make = KNOWN[name]
    for attribute in needed:
        if getattr(one, attribute) is None:
            raise InputError(f"magpylib's {name}: {attribute} is not set, so it has no field")
    position, turn = np.asarray(one.position, dtype=float), one.orientation.as_rotvec()
    if position.ndim != 1:
        raise InputError(
            f"magpylib's {name} has a path of {len(position)} places; give it one, and say with Motion how it moves"
        )
    try:
        shape = make(one)
    except InputError as error:
        raise InputError(f"magpylib's {name}: {error}") from None
    yield shape, position, np.asarray(turn, dtype=float)
