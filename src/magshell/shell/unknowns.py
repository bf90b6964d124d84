"""Columns of the nodal arrays (nodes, 10): displacement, director displacement, thickness stretch, spin."""

from __future__ import annotations

COLUMNS = {"u": slice(0, 3), "w": slice(3, 6), "phi": slice(6, 7), "omega": slice(7, 10)}
COMPONENTS = 10


def width(field: str) -> int:
    """Number of columns of a field."""
    return COLUMNS[field].stop - COLUMNS[field].start
