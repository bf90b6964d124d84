"""How elements are interpolated in a page: the lattices of the tessellation, coarse enough for a browser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import IntArray
from magshell.evaluation.patches import patches_of
from magshell.output.joints import joints_of
from magshell.output.page.arrays import text
from magshell.output.skin import Hull
from magshell.output.tessellation import Tessellation, element_edges

if TYPE_CHECKING:
    from magshell.model.shell import Shell

MOST_PIECES = 6
FINENESS = 160.0
"""Pieces along the side of a square of elements: some 50 000 triangles, which software draws in a fifth of a second."""


def stencils(shell: Shell) -> tuple[dict[str, Any], dict[str, str]]:
    """For each shape of element: functions `N` and derivatives `N1`, `N2` (points, nodes), and `triangles` (n, 3).

    Returns
    -------
    dict
        `kinds`, each with the number `tops` of elements that may carry an arrow, `along`: the functions of an edge's
        nodes (end, end, middle) at points along it, and `thick`: whether the body between its faces is drawn.
    dict of str to str
        `elements-I`, `numbers-I`: rows of `Patches` and numbers of the elements of kind I; `edges`, `outline`: edges of
        the mesh. Of a thick body the elements have nodes of their own: `nodes`, `heights` are the row and the height
        over the mesh of each, `mitres` and `mitre-numbers` the `Mitres` of those that lie elsewhere, `drawn-edges` and
        `drawn-outline` their edges.
    """
    mesh, rows = shell.mesh, patches_of(shell).elements
    arrays = {"edges": text(element_edges(mesh.elements), "<u4"), "outline": text(joints_of(shell).outline, "<u4")}
    if shell.plain:
        kinds, along = _lattices(rows, np.arange(len(rows)), len(rows), arrays)
        return {"kinds": kinds, "along": along, "thick": False}, arrays
    hull = Hull(shell, shell.part_of).nodal(rows)
    kinds, along = _lattices(hull.elements, hull.element_of, hull.tops, arrays)
    arrays |= {
        "nodes": text(hull.nodes, "<u4"),
        "heights": text(hull.heights, "<f4"),
        "mitres": text(hull.mitres.nodes, "<u4"),
        "mitre-numbers": text(hull.mitres.numbers, "<f4"),
        "drawn-edges": text(hull.inner, "<u4"),
        "drawn-outline": text(hull.outer, "<u4"),
    }
    return {"kinds": kinds, "along": along, "thick": True}, arrays


def _lattices(
    elements: IntArray, element_of: IntArray, tops: int, arrays: dict[str, str]
) -> tuple[list[dict[str, Any]], list[list[float]]]:
    """Kinds, and the functions along an edge; nodes and numbers of the elements go into the arrays."""
    cells = Tessellation(elements, max(1, min(MOST_PIECES, int(FINENESS / len(elements) ** 0.5))))
    kinds: list[dict[str, Any]] = []
    for i, lattice in enumerate(cells.lattices):
        first, second = np.moveaxis(lattice.dN, 1, 0)
        functions = {"N": lattice.N, "N1": first, "N2": second, "triangles": lattice.pieces}
        kind = {name: values.tolist() for name, values in functions.items()}
        kinds.append({**kind, "tops": int((lattice.elements < tops).sum())})
        arrays |= {f"elements-{i}": text(lattice.nodes, "<u4")}
        arrays |= {f"numbers-{i}": text(element_of[lattice.elements], "<u4")}
    return kinds, cells.edges(np.eye(3), np.array([[0, 1, 2]]))[0].tolist()
