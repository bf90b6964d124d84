"""The mid-surface of a plate: the outline of one side, moved by half the thickness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from magshell.arrays import FloatArray
from magshell.mesh.drawings.joining import EXACT, Joined
from magshell.mesh.drawings.nesting import planned
from magshell.mesh.drawings.pieces import Piece
from magshell.mesh.drawings.reading import meshed
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.solids.pairing import Sides
from magshell.mesh.solids.skin import Skin

PLANE = 1e-6
"""Of the size: corners of a flat side are no further from its plane, as in files of single precision."""
LAYER = "sheet"
"""Group of all elements."""


def is_flat(skin: Skin, sides: Sides) -> bool:
    """Whether the upper side lies in one plane."""
    x = skin.points[np.unique(skin.triangles[sides.upper])]
    heights = x @ _frame(skin, sides)[2]
    return bool(np.ptp(heights) <= PLANE * skin.size)


def flat_mesh(skin: Skin, sides: Sides, name: str, size: float | None) -> FileMesh:
    """The mid-surface of a plate, meshed by gmsh; lengths of the skin in mm, the size in m."""
    frame = _frame(skin, sides)
    local = skin.points @ frame.T
    height = 0.5 * sum(
        float(np.median(local[np.unique(skin.triangles[side]), 2])) for side in (sides.upper, sides.lower)
    )
    beyond, _ = skin.neighbours
    inside = np.zeros(len(skin.triangles), dtype=bool)
    inside[sides.upper] = True
    triangle, side = np.nonzero(inside[:, None] & ~inside[beyond])
    begin, end = skin.triangles[triangle, side], skin.triangles[triangle, (side + 1) % 3]
    pieces = [Piece(local[[a, b], :2], LAYER) for a, b in zip(begin.tolist(), end.tolist(), strict=True)]
    mesh = meshed(planned(Joined(pieces, EXACT * skin.size, merging=True), None), name, size)
    points = mesh.points.copy()
    points[:, 2] = 1e-3 * height
    return replace(mesh, points=points @ frame)


def _frame(skin: Skin, sides: Sides) -> FloatArray:
    """Rows e1, e2, e3: along X1 as far as that goes, and along the normal of the upper side."""
    normal = skin.vectors[sides.upper].sum(axis=0)
    normal /= np.linalg.norm(normal)
    nearest = int(np.argmax(np.abs(normal)))
    axis = np.sign(normal[nearest]) * np.eye(3)[nearest]
    if np.linalg.norm(normal - axis) < PLANE:
        normal = axis
    along = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[1]
    first = along - (along @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])
