"""What a page needs to make the closed surface of a step: where its points lie on the elements, and its triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.evaluation.converged import converged
from magshell.evaluation.patches import patches_of
from magshell.output.joints import joints_of
from magshell.output.page.arrays import quantised, text
from magshell.output.solid.slab import heights_of, slab
from magshell.output.solid.surface import Lattices

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

FINENESS, MOST_PIECES = 60.0, 6
"""Pieces along the side of a square of elements: some 15 000 triangles."""


def solid(path: Path, steps: Sequence[Step]) -> tuple[dict[str, Any], dict[str, str]]:
    """What the page knows of the levels of a `Slab`, and arrays.

    Levels at a node are apart if they are so at any step. Their heights, in directors, are stored as an output is.

    Returns
    -------
    dict
        `heights`, described as an output, and `kinds`: functions `N` of the points of the lattice and, as the number of
        the array, `levels` of both faces, of the elements and of their nodes.
    dict of str to str
        `solid-nodes` has the row of `Patches` of each level, `solid-mitres` and `solid-mitre-numbers` are `Mitres` of
        the levels, and `solid-triangles` three points for each triangle. `solid-places` says where a point lies: in the
        order of kinds, lower and upper face, elements of the kind and points of its lattice.
    """
    d, shell = path.discretisation, path.model.shell
    mesh, joints, patches = d.mesh, joints_of(shell), patches_of(shell)
    states = [converged(d, step) for step in steps]
    heights = [heights_of(reached) for reached in states]
    lengths = [(1.0 + reached.element_stretch()) * one for reached, one in zip(states, heights, strict=True)]
    # Equal in every step is equal in a mean with unequal weights.
    weights = np.sqrt(np.arange(2.0, len(steps) + 2.0))
    mean = np.tensordot(weights / weights.sum(), lengths, axes=1)
    pieces = max(1, min(MOST_PIECES, int(FINENESS / len(mesh.elements) ** 0.5)))
    anywhere = np.zeros((*mean.shape, 3))
    body = slab(joints, anywhere, anywhere, mean)
    made = Lattices(body, pieces)
    used, triangles = made.triangles()
    points, first = np.unique(np.concatenate([numbers.ravel() for numbers in made.numbers]), return_index=True)
    places = body.holder % mesh.elements.size
    mitres = joints.mitres(patches.elements, shell.faces_at_nodes, places, body.holder >= mesh.elements.size)
    coded = [quantised(one.ravel()[body.holder]) for one in heights]
    about = {
        "name": "solid-heights",
        "components": 1,
        "rows": len(body.holder),
        "steps": len(steps),
        "ranges": [[ends for _, ends in coded]],
    }
    arrays = {
        "solid-heights": text(np.stack([codes for codes, _ in coded]), "<u2"),
        "solid-nodes": text(patches.elements.ravel()[places], "<u4"),
        "solid-mitres": text(mitres.nodes, "<u4"),
        "solid-mitre-numbers": text(mitres.numbers, "<f4"),
        "solid-places": text(first[np.searchsorted(points, used)], "<u4"),
        "solid-triangles": text(triangles, "<u4"),
        **{f"solid-levels-{i}": text(made.levels(lattice), "<u4") for i, lattice in enumerate(made.lattices)},
    }
    return {"heights": about, "kinds": [{"N": lattice.N.tolist()} for lattice in made.lattices]}, arrays
