"""The mid-surface of a curved sheet that is given by triangles: those of one side, moved by half the thickness."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError, MeshError
from magshell.mesh.files.assembling import FileMesh, assemble
from magshell.mesh.files.cells import MISSING, TRIANGLE3
from magshell.mesh.files.contents import Block, Contents
from magshell.mesh.files.normals import side_normals
from magshell.mesh.quality import worst
from magshell.mesh.solids.facing import along_all
from magshell.mesh.solids.pairing import Sides
from magshell.mesh.solids.skin import Skin

GROUP = "sheet"
WORST = 0.05
"""Least scaled Jacobian of triangles that can be solved with."""


def curved_mesh(skin: Skin, sides: Sides, name: str, size: float | None) -> FileMesh:
    """The mid-surface of a sheet with the triangles of its upper side, raised to second order; the skin in mm.

    Raises
    ------
    InputError
        A size is asked for; the triangles are no elements.
    """
    if size is not None:
        raise InputError(
            f"size: {name} is a curved sheet of triangles, which become the elements as they are; leave the size out. "
            "A STEP file of the body is meshed with any size"
        )
    points, triangles = _midway(skin, sides)
    every = np.arange(len(triangles))
    contents = Contents(points, [Block(TRIANGLE3, every, triangles, {GROUP: every})])
    advice = "mesh the body with finer, evenly shaped triangles, or give its STEP file"
    try:
        mesh = assemble(contents, name, "mm", second_order=True, closed=True)
    except MeshError as error:
        raise MeshError(f"{error} These are triangles of the solid's upper side: {advice}") from None
    shape = worst(mesh)["scaled_jacobian"]
    if shape.value < WORST:
        place = ", ".join(f"{1e3 * value:.4g}" for value in mesh.points[mesh.elements[shape.element, :4]].mean(axis=0))
        raise InputError(f"{name}: its triangles are too long and thin to be elements, as at ({place}) mm: {advice}")
    return mesh


def _midway(skin: Skin, sides: Sides) -> tuple[FloatArray, IntArray]:
    """Points and triangles of the upper side, moved inward by half the thickness along the smooth normals there."""
    used, compact = np.unique(skin.triangles[sides.upper], return_inverse=True)
    points, triangles = skin.points[used], compact.reshape(-1, 3)
    none = np.full(len(triangles), MISSING)
    rows = np.column_stack([triangles, triangles[:, 2], none, none, triangles[:, 2], none])
    normals = side_normals(points, rows).normals.reshape(-1, 4, 2, 3)[:, [0, 1, 3], 0]
    away = along_all(normals.reshape(-1, 3), triangles.ravel(), len(points))
    return points - 0.5 * sides.thickness * away, triangles
