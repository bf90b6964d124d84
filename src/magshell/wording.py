"""Vectors, quantities and counts in words."""

from __future__ import annotations

from collections.abc import Iterable

from magshell.units import Dimension, show


def vector(components: Iterable[float]) -> str:
    """Plain numbers in brackets."""
    return f"({', '.join(f'{component:.4g}' for component in components)})"


def place(point: Iterable[float]) -> str:
    """A position, m, in millimetres."""
    return f"({', '.join(f'{1e3 * x:.4g}' for x in point)}) mm"


def quantity(value: float | tuple[float, ...], dimension: Dimension) -> str:
    """A quantity, or several in brackets, with units."""
    if isinstance(value, tuple):
        return f"({', '.join(show(component, dimension) for component in value)})"
    return show(value, dimension)


def counted(number: int, what: str) -> str:
    """The number of something, in the plural unless it is one."""
    return f"{number} {what}{'s' if number != 1 else ''}"


def towards(direction: Iterable[float] | None) -> str:
    """A preferred direction, as an addition; empty without one."""
    return "" if direction is None else f", towards {vector(direction)}"
