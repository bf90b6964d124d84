"""How elements are interpolated in a page: the lattices of the tessellation, coarse enough for a browser."""

from __future__ import annotations

from typing import Any

import numpy as np

from magshell.arrays import IntArray
from magshell.output.page.arrays import text
from magshell.output.tessellation import Tessellation

MOST_PIECES = 6
FINENESS = 160.0
"""Pieces along the side of a square of elements: some 50 000 triangles, which software draws in a fifth of a second."""


def stencils(elements: IntArray) -> tuple[dict[str, Any], dict[str, str]]:
    """For each shape of the elements (elements, 8): functions `N` and derivatives `N1`, `N2` (points, nodes), and
    `triangles` (n, 3).

    Returns
    -------
    dict
        `kinds`, and `along`: the functions of an edge's nodes (end, end, middle) at points along it.
    dict of str to str
        `elements-I`, `numbers-I`: nodes and numbers of the elements of kind I.
    """
    cells = Tessellation(elements, max(1, min(MOST_PIECES, int(FINENESS / len(elements) ** 0.5))))
    kinds: list[dict[str, Any]] = []
    arrays: dict[str, str] = {}
    for i, lattice in enumerate(cells.lattices):
        first, second = np.moveaxis(lattice.dN, 1, 0)
        functions = {"N": lattice.N, "N1": first, "N2": second, "triangles": lattice.pieces}
        kinds.append({name: values.tolist() for name, values in functions.items()})
        arrays |= {f"elements-{i}": text(lattice.nodes, "<u4"), f"numbers-{i}": text(lattice.elements, "<u4")}
    along = cells.edges(np.eye(3), np.array([[0, 1, 2]]))[0]
    return {"kinds": kinds, "along": along.tolist()}, arrays
