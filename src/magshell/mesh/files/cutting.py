"""Bad quadrilaterals cut into triangles, where that makes better corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from magshell.errors import MeshError
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.geometry import unit
from magshell.mesh.mesh import Mesh
from magshell.mesh.quality import measure, worst
from magshell.mesh.triangles import split


def with_bad_ones_cut(mesh: FileMesh, least: float) -> FileMesh:
    """Quadrilaterals with a corner of a scaled Jacobian below the least cut from their widest corner.

    A quadrilateral that fills a corner of nearly 180 degrees, as at a smooth boundary, makes two good triangles. The
    mesh stays as it is where its worst corner would not become better.
    """
    bad = np.flatnonzero((measure(mesh).scaled_jacobian < least) & ~mesh.triangles)
    if not bad.size:
        return mesh
    x = mesh.points[mesh.elements[bad, :4]]
    ahead, back = unit(np.roll(x, -1, axis=1) - x), unit(np.roll(x, 1, axis=1) - x)
    rising = np.argmin((ahead * back).sum(axis=2), axis=1) % 2 == 0
    try:
        cut: Mesh = split(mesh, "falling", bad[~rising])
        cut = split(cut, "rising", bad[rising] + np.searchsorted(bad[~rising], bad[rising]))
    except MeshError:
        return mesh
    if worst(cut)["scaled_jacobian"].value <= worst(mesh)["scaled_jacobian"].value:
        return mesh
    what = f"{bad.size} quadrilateral{'s' * (bad.size > 1)} with a bad corner cut into triangles"
    origin = replace(mesh.origin, changes=(*mesh.origin.changes, what))
    return FileMesh(
        cut.points, cut.elements, cut.element_groups, cut.edge_groups, cut.node_groups, cut.cuts, origin=origin
    )
