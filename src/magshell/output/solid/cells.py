"""A body as solid elements: hexahedra of 20 nodes and wedges of 15, straight from the lower face to the upper one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.evaluation.outputs import chosen
from magshell.evaluation.patches import patches_of
from magshell.output.solid.slab import Slab, slab_of
from magshell.output.vtu import annotate

if TYPE_CHECKING:
    from magshell.evaluation.converged import Converged

VTK_QUADRATIC_HEXAHEDRON, VTK_QUADRATIC_WEDGE = 25, 26
# Places of a wedge's nodes in the row of 20 of a collapsed hexahedron.
WEDGE = np.array([0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18])


def solid_grid(reached: Converged, step: Any) -> Any:
    """A converged state as a `pyvista.UnstructuredGrid` of solid elements at their deformed places, with its outputs.

    Outputs of the mid-surface's nodes stand at both faces and between them; at mitred kinks those of one sheet do.
    Stresses and strains of the faces are in the files of the mid-surface only.
    """
    import pyvista

    body = slab_of(reached)
    points, holder, rows = _nodes(body)
    elements, patches = reached.mesh.elements, patches_of(reached.discretisation.model.shell)
    holder %= elements.size
    cells = np.insert(rows, 0, np.where(body.triangles, len(WEDGE), 20), axis=1)
    kept = np.ones(cells.shape, dtype=bool)
    kept[np.ix_(body.triangles, 1 + np.setdiff1d(np.arange(20), WEDGE))] = False
    types = np.where(body.triangles, VTK_QUADRATIC_WEDGE, VTK_QUADRATIC_HEXAHEDRON).astype(np.uint8)
    result = pyvista.UnstructuredGrid(cells[kept], types, points)
    outputs = [output for output in chosen(reached.discretisation.model.outputs) if output.where != "patch"]
    for output in outputs:
        values = np.array(output.evaluate(reached))
        if output.where == "cell":
            result.cell_data.set_array(values, output.name)
        else:
            of = elements if output.where == "point" else patches.elements
            result.point_data.set_array(values[of.ravel()[holder]], output.name)
    annotate(result, reached.mesh, step, outputs)
    return result


def _nodes(body: Slab) -> tuple[FloatArray, IntArray, IntArray]:
    """Points (n, 3), the places in `at` that have them (n,), and the 20 of each element."""
    lower, upper = body.at
    pairs = np.sort(np.stack([lower[:, :4], upper[:, :4]], axis=-1), axis=-1)
    upright, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    points = np.concatenate([body.levels, body.levels[upright].mean(axis=1)])
    holder = np.concatenate([body.holder, body.holder[upright[:, 0]]])
    between = len(body.levels) + number.reshape(-1, 4)
    return points, holder, np.hstack([lower[:, :4], upper[:, :4], lower[:, 4:], upper[:, 4:], between])
