"""How elements are interpolated in a page: functions at the points of a lattice, and the triangles between these."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.output.page.arrays import text
from magshell.shell.shape_functions import serendipity

if TYPE_CHECKING:
    from magshell.mesh import Mesh

MOST_PIECES = 6
FINENESS = 160.0
"""Pieces along the side of a square of elements: some 50 000 triangles, which software draws in a tenth of a second."""


def stencils(mesh: Mesh) -> tuple[dict[str, Any], dict[str, str]]:
    """For each kind of element: functions `N` and derivatives `N1`, `N2` (points, nodes), and `triangles` (n, 3).

    Returns
    -------
    dict
        `kinds`, and `along`: the functions of an edge's nodes (end, end, middle) at points along it.
    dict of str to str
        `elements-I`, `numbers-I`: nodes and numbers of the elements of kind I.
    """
    pieces = max(1, min(MOST_PIECES, int(FINENESS / len(mesh.elements) ** 0.5)))
    t = np.linspace(-1.0, 1.0, pieces + 1)
    along = np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2], axis=1)
    kinds = [_quad(t)]
    arrays = {"elements-0": text(mesh.elements, "<u4"), "numbers-0": text(np.arange(len(mesh.elements)), "<u4")}
    return {"kinds": kinds, "along": along.tolist()}, arrays


def _quad(t: Any) -> dict[str, Any]:
    eta, xi = np.meshgrid(t, t, indexing="ij")
    N, dN, _ = serendipity(np.column_stack([xi.ravel(), eta.ravel()]))
    side = len(t)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + side + 1, corner + side], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return {"N": N.tolist(), "N1": dN[:, 0].tolist(), "N2": dN[:, 1].tolist(), "triangles": triangles.tolist()}
