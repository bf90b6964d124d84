"""Magnets and coils of a page: surfaces in the frame of their part of the field, and where that is at each step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import MagnetField
from magshell.output.page.arrays import text
from magshell.output.sources import extent, of_source, pieces

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step


def sources(path: Path, steps: Sequence[Step]) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """What the header says of each surface, and the arrays of corners and normals of their triangles."""
    moved = [list(path.model.field.parts(step.drives)) for step in steps]
    told: list[dict[str, Any]] = []
    arrays: dict[str, str] = {}
    for number, (part, _) in enumerate(moved[0]):
        if not isinstance(part, MagnetField):
            continue
        places = [part.placement(parts[number][1]) for parts in moved]
        for piece in (piece for source in part.sources for piece in of_source(source, part.name)):
            surface = piece.surface.triangulate()
            corners = np.asarray(surface.points, dtype=float)[surface.regular_faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            name = f"source-{len(told)}"
            arrays[name] = text(np.concatenate([corners, np.repeat(normals[:, None], 3, axis=1)], axis=2), "<f4")
            told.append(
                {
                    "array": name,
                    "colour": piece.colour,
                    "turns": [turn.ravel().tolist() for turn, _ in places],
                    "shifts": [shift.tolist() for _, shift in places],
                }
            )
    return told, arrays


def reached(path: Path, steps: Sequence[Step], part: FloatArray) -> FloatArray:
    """Points (n, 3) of magnets and coils that a picture of the steps must hold; `part` holds points of the shell."""
    return np.concatenate([extent(pieces(path.model.field, step.drives), part) for step in steps])
