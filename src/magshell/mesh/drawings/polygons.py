"""A polygon with holes, meshed by gmsh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from importlib.util import find_spec

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.mesh.drawings.joining import Joined
from magshell.mesh.drawings.nesting import planned
from magshell.mesh.drawings.pieces import Piece
from magshell.mesh.drawings.reading import INSTALL, meshed
from magshell.mesh.drawings.table import polygon as sides_of
from magshell.mesh.files.session import required
from magshell.mesh.mesh import Mesh

Corners = Sequence[Sequence[float]] | FloatArray
_LAYER = "polygon"


def polygon(corners: Corners, size: float | None = None, holes: Sequence[Corners] = ()) -> Mesh:
    """Flat polygon in the plane X1-X2 with the normal +X3, meshed by gmsh (the extra `magshell[drawings]`).

    Parameters
    ----------
    corners : (n, 2)
        In the order of a walk around it, m.
    size : float, optional
        Length of an element's side, m; without it such that there are about 800 elements.
    holes : sequence of (k, 2)
        Polygons that are cut out, m.

    Returns
    -------
    Mesh
        With the edge groups side-1 (from the first corner to the second), side-2 and so on, and hole-1, hole-2.

    Raises
    ------
    InputError
        gmsh or shapely is not there; fewer than three corners; a polygon that crosses itself or another.
    """
    required("polygon")
    if find_spec("shapely") is None:
        raise InputError(f"polygon: needs shapely, which is not installed: {INSTALL}")
    outlines = [_sides(outline, number) for number, outline in enumerate((corners, *holes))]
    try:
        plan = planned(Joined([piece for outline in outlines for piece in outline], 0.0), None)
    except InputError as error:
        said = str(error).replace(f"layer '{_LAYER}': ", "")
        raise InputError(f"polygon: {said}") from None
    if len(plan.faces) != 1 or len(plan.faces[0].cut) != len(holes):
        raise InputError("polygon: a hole lies outside of the corners, in another hole, or is there twice")
    edges = {f"side-{number}": [side] for number, side in enumerate(outlines[0], start=1)}
    edges |= {f"hole-{number}": hole for number, hole in enumerate(outlines[1:], start=1)}
    made = meshed(replace(plan, edges=edges), "polygon", size)
    return Mesh(made.points, made.elements, edge_groups=made.edge_groups)


def _sides(corners: Corners, number: int) -> list[Piece]:
    where = "polygon: corners" if not number else f"polygon: holes[{number - 1}]"
    try:
        array = 1e3 * np.asarray(corners, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.ndim != 2 or array.shape[1] != 2 or not np.isfinite(array).all():
        raise InputError(f"{where}: are pairs of finite coordinates X1, X2 in m, not {corners!r}")
    return sides_of([(x, y) for x, y in array.tolist()], _LAYER, number, where)
