"""Kinds of elements that a file may hold, and how they become rows of a mesh."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import IntArray

MISSING = -1
"""In a row: a mid-side node that an element of first order does not have."""


class Kind(NamedTuple):
    """A kind of element.

    A triangle's row has one node as third corner, fourth corner and the middle between them.
    """

    name: str
    """In the plural, for messages."""
    dimension: int
    nodes: int
    """How many nodes it has in a file."""
    row: tuple[int, ...]
    """Which of its nodes stand in the row of 8 (surfaces), 3 (curves: end, end, middle) or 1; -1: none does."""

    def rows(self, nodes: IntArray) -> IntArray:
        """Rows of the mesh from nodes (elements, nodes of this kind)."""
        padded = np.column_stack([nodes, np.full(len(nodes), MISSING)])
        return padded[:, self.row]


QUAD8 = Kind("8-node quadrilaterals", 2, 8, (0, 1, 2, 3, 4, 5, 6, 7))
QUAD9 = Kind("9-node quadrilaterals", 2, 9, (0, 1, 2, 3, 4, 5, 6, 7))
QUAD4 = Kind("4-node quadrilaterals", 2, 4, (0, 1, 2, 3, -1, -1, -1, -1))
TRIANGLE6 = Kind("6-node triangles", 2, 6, (0, 1, 2, 2, 3, 4, 2, 5))
TRIANGLE7 = Kind("7-node triangles", 2, 7, (0, 1, 2, 2, 3, 4, 2, 5))
TRIANGLE3 = Kind("3-node triangles", 2, 3, (0, 1, 2, 2, -1, -1, 2, -1))
PIXEL = Kind("4-node quadrilaterals", 2, 4, (0, 1, 3, 2, -1, -1, -1, -1))
LINE3 = Kind("3-node lines", 1, 3, (0, 1, 2))
LINE2 = Kind("2-node lines", 1, 2, (0, 1, -1))
POINT = Kind("points", 0, 1, (0,))

GMSH = {1: LINE2, 2: TRIANGLE3, 3: QUAD4, 8: LINE3, 9: TRIANGLE6, 10: QUAD9, 15: POINT, 16: QUAD8}
"""By the number that gmsh gives the type."""
GMSH_SOLIDS = {4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19, 29, 30, 31, 71, 72, 73, 79, 80, 81, 82, 83, 90, 91, 92, 93}
"""gmsh's numbers of tetrahedra, hexahedra, prisms and pyramids."""
GMSH_SURFACES = {*range(20, 26), 34, *range(36, 62), 69, 85, 86, 135}
"""gmsh's numbers of triangles, quadrilaterals and polygons of other kinds."""
VTK = {
    1: (POINT,),
    3: (LINE2,),
    5: (TRIANGLE3,),
    7: (TRIANGLE3, QUAD4),
    8: (PIXEL,),
    9: (QUAD4,),
    21: (LINE3,),
    22: (TRIANGLE6,),
    23: (QUAD8,),
    28: (QUAD9,),
    34: (TRIANGLE7,),
    68: (LINE2, LINE3),
    69: (TRIANGLE3, TRIANGLE6, TRIANGLE7),
    70: (QUAD4, QUAD9),
}
"""By the number that VTK gives the type: polygons and Lagrange cells may have several numbers of nodes."""
MESHIO = {
    "vertex": POINT,
    "line": LINE2,
    "line3": LINE3,
    "triangle": TRIANGLE3,
    "triangle6": TRIANGLE6,
    "quad": QUAD4,
    "quad8": QUAD8,
    "quad9": QUAD9,
}
"""By the name that meshio gives the type."""
