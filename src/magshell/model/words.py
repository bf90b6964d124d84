"""Parts of a shell in words."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.parts import REST, Part
from magshell.units import LENGTH, show


def name_of(part: Part) -> str:
    """Name of its region, or 'rest'."""
    return "rest" if part.name == REST else part.name


def thickness_of(part: Part, layer: int | None = None) -> str:
    """Of the part or of one of its layers: a length, or the least and the greatest."""
    heights = part.at_nodes.sum(axis=2) if layer is None else part.at_nodes[..., layer]
    return span(heights)


def offset_of(part: Part) -> str:
    """Where the mesh lies, as an addition; empty for the middle."""
    offset, half = part.offset_at_nodes, 0.5 * part.at_nodes.sum(axis=2)
    if not offset.any():
        return ""
    for face, height in (("top", half), ("bottom", -half)):
        if np.abs(offset - height).max() <= 1e-12 * np.abs(half).max():
            return f", mesh at the {face} face"
    return f", mesh {span(np.abs(offset))} {'above' if offset.flat[0] > 0.0 else 'below'} the mid-plane"


def span(lengths: FloatArray) -> str:
    """One length, or the least and the greatest."""
    least, greatest = float(lengths.min()), float(lengths.max())
    if greatest - least <= 1e-9 * greatest:
        return show(greatest, LENGTH)
    return f"{show(least, LENGTH)} to {show(greatest, LENGTH)}"
