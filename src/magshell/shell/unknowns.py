"""The table of unknowns: columns of the nodal arrays (nodes, 11), their names and units."""

from __future__ import annotations

COLUMNS = {"u": slice(0, 3), "w": slice(3, 6), "phi": slice(6, 7), "omega": slice(7, 10), "s": slice(10, 11)}
COMPONENTS = 11
#: Name of each column.
UNKNOWNS = ("u1", "u2", "u3", "w1", "w2", "w3", "phi", "omega1", "omega2", "omega3", "s")


def width(field: str) -> int:
    """Number of columns of a field."""
    return COLUMNS[field].stop - COLUMNS[field].start
