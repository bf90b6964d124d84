"""Phrases that the messages about meshes share."""

from __future__ import annotations

from collections.abc import Iterable

from magshell.arrays import FloatArray

COUNTING = "(elements and nodes are counted from 0, the corners of an element from 1)"


def place(point: FloatArray) -> str:
    """Position as in `(0.1, 0, 0.25) m`."""
    return "(" + ", ".join(f"{value:.6g}" for value in point) + ") m"


def listing(numbers: Iterable[int], limit: int = 5) -> str:
    """`3, 8, 9` or, of many, the first few and how many more."""
    every = [str(int(number)) for number in numbers]
    return ", ".join(every[:limit]) + (f" and {len(every) - limit} more" if len(every) > limit else "")


def further(count: int) -> str:
    """What to add when `count` places have the fault that the message describes for the first of them."""
    return f" The mesh has {count} such places; this is the first." if count > 1 else ""
