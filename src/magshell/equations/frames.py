"""Frames of the nodes: base vectors of their own where supports hold oblique directions."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.model.constraints import FRAME_OF_FIELD, Constraints
from magshell.shell.unknowns import COLUMNS


def to_global(constraints: Constraints, nodal: FloatArray) -> FloatArray:
    """Turn nodal columns (nodes, 11) from the nodes' frames to the global axes."""
    return _turned(constraints, nodal, "nji,nj->ni")


def to_frames(constraints: Constraints, nodal: FloatArray) -> FloatArray:
    """Turn nodal columns (nodes, 11) from the global axes to the nodes' frames."""
    return _turned(constraints, nodal, "nij,nj->ni")


def _turned(constraints: Constraints, nodal: FloatArray, rule: str) -> FloatArray:
    if not len(constraints.frames):
        return nodal
    turned = nodal.copy()
    for field, number in FRAME_OF_FIELD.items():
        oblique = np.flatnonzero(constraints.frame_of[:, number] >= 0)
        frames = constraints.frames[constraints.frame_of[oblique, number]]
        turned[oblique, COLUMNS[field]] = np.einsum(rule, frames, nodal[oblique, COLUMNS[field]])
    return turned


def bases(constraints: Constraints, field: str, nodes: IntArray) -> FloatArray:
    """Frames (n, 3, 3) of a field at nodes, base vectors as rows."""
    of = constraints.frame_of[nodes, FRAME_OF_FIELD[field]]
    frames = np.broadcast_to(np.eye(3), (len(nodes), 3, 3)).copy()
    frames[of >= 0] = constraints.frames[of[of >= 0]]
    return frames
