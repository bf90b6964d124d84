"""What a page needs to make the closed surface of a step: where its points lie on the elements, and its triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.evaluation.converged import converged
from magshell.output.page.arrays import quantised, text
from magshell.output.solid.slab import has_outside, heights_of, slab
from magshell.output.solid.surface import Lattices

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

FINENESS, MOST_PIECES = 60.0, 6
"""Pieces along the side of a square of elements: some 15 000 triangles."""


def solid(path: Path, steps: Sequence[Step]) -> tuple[dict[str, Any] | None, dict[str, str]]:
    """What the page knows of the levels of a `Slab`, and arrays; None where a mesh has no such surface.

    Levels at a node are apart if they are so at any step. Their heights, in directors, are stored as an output is.

    Returns
    -------
    dict or None
        `heights`, described as an output, and `kinds`: functions `N` of the points of the lattice and, as the number of
        the array, `levels` of both faces, of the elements and of their nodes.
    dict of str to str
        `solid-nodes` has the node of each level, `solid-triangles` three points for each triangle. `solid-places` says
        where a point lies: in the order of kinds, lower and upper face, elements of the kind and points of its lattice.
    """
    d = path.discretisation
    mesh = d.mesh
    if not has_outside(mesh):
        return None, {}
    heights = [heights_of(converged(d, step)) for step in steps]
    # Equal in every step is equal in a mean with unequal weights.
    weights = np.sqrt(np.arange(2.0, len(steps) + 2.0))
    mean = np.tensordot(weights / weights.sum(), heights, axes=1)
    pieces = max(1, min(MOST_PIECES, int(FINENESS / len(mesh.elements) ** 0.5)))
    body = slab(mesh.elements, mesh.points, d.normals, mean)
    made = Lattices(body, pieces)
    used, triangles = made.triangles()
    points, first = np.unique(np.concatenate([numbers.ravel() for numbers in made.numbers]), return_index=True)
    _, holders = np.unique(body.at, return_index=True)
    coded = [quantised(one.ravel()[holders]) for one in heights]
    about = {
        "name": "solid-heights",
        "components": 1,
        "rows": len(holders),
        "steps": len(steps),
        "ranges": [[ends for _, ends in coded]],
    }
    arrays = {
        "solid-heights": text(np.stack([codes for codes, _ in coded]), "<u2"),
        "solid-nodes": text(body.node_of, "<u4"),
        "solid-places": text(first[np.searchsorted(points, used)], "<u4"),
        "solid-triangles": text(triangles, "<u4"),
        **{f"solid-levels-{i}": text(made.levels(lattice), "<u4") for i, lattice in enumerate(made.lattices)},
    }
    return {"heights": about, "kinds": [{"N": lattice.N.tolist()} for lattice in made.lattices]}, arrays
