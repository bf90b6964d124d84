"""Checks of the arguments of generators: each message names the argument, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from numbers import Integral, Real

import numpy as np

from magshell.arrays import FloatArray, three_finite
from magshell.errors import InputError

WIDEST = 120.0
"""Degrees an element may span: a quarter turn is usual, and a turn of two elements would fold onto itself."""


def positive(generator: str, name: str, value: float) -> float:
    """A length in m that is positive and finite."""
    if isinstance(value, Real) and math.isfinite(value) and value > 0:
        return float(value)
    raise InputError(f"{generator}: {name} = {value!r} is not allowed; it must be a positive number, in m.")


def divisions(generator: str, value: Sequence[int], name: str = "elements") -> tuple[int, int]:
    """Two numbers of elements, each at least 1."""
    numbers = tuple(value) if isinstance(value, Iterable) else ()
    if len(numbers) == 2 and all(isinstance(n, Integral) and not isinstance(n, bool) and n >= 1 for n in numbers):
        return int(numbers[0]), int(numbers[1])
    raise InputError(f"{generator}: {name} = {value!r} is not allowed; it must be two whole numbers, each at least 1.")


def count(generator: str, name: str, value: int) -> int:
    """A number of elements, at least 1."""
    if isinstance(value, Integral) and not isinstance(value, bool) and value >= 1:
        return int(value)
    raise InputError(f"{generator}: {name} = {value!r} is not allowed; it must be a whole number, at least 1.")


def angle(generator: str, name: str, value: float, least: float, greatest: float) -> float:
    """An angle in degrees between two others, which are excluded."""
    if isinstance(value, Real) and least < value < greatest:
        return float(value)
    raise InputError(
        f"{generator}: {name} = {value!r} is not allowed; it must be between {least:g} and {greatest:g} degrees."
    )


def angles(generator: str, name: str, value: Sequence[float], elements: int) -> tuple[float, float]:
    """Start and stop in degrees, rising, at most 360 apart and at most 120 to an element."""
    start, stop = number_pair(generator, name, value)
    if start >= stop:
        raise InputError(f"{generator}: {name} = {value!r} is not allowed; the start must be below the stop.")
    if stop - start > 360 and not whole_turn(start, stop):
        raise InputError(f"{generator}: {name} = {value!r} spans {stop - start:g} degrees; at most 360 are allowed.")
    if stop - start > WIDEST * elements * (1.0 + 1e-12):
        raise InputError(
            f"{generator}: elements = {elements} over {name} = {value!r} makes elements of "
            f"{(stop - start) / elements:g} degrees; at most {WIDEST:g} are allowed, so give at least "
            f"{math.ceil((stop - start) / WIDEST)} elements."
        )
    return start, stop


def whole_turn(start: float, stop: float) -> bool:
    """Whether the angles span 360 degrees but for rounding."""
    return math.isclose(stop - start, 360.0, rel_tol=1e-12)


def number_pair(generator: str, name: str, value: Sequence[float]) -> tuple[float, float]:
    """Two finite numbers, in degrees."""
    try:
        start, stop = (float(v) for v in value)
    except (TypeError, ValueError):
        start = stop = math.nan
    if not (math.isfinite(start) and math.isfinite(stop)):
        raise InputError(f"{generator}: {name} = {value!r} is not allowed; it must be two numbers, in degrees.")
    return start, stop


def axes(
    generator: str, axis: Sequence[float], name: str, across: Sequence[float]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Right-handed unit vectors e1, e2, e3: e3 along the axis, e1 along what another direction has across it."""
    e3, e1 = direction(generator, "axis", axis), direction(generator, name, across)
    e1 = e1 - (e1 @ e3) * e3
    if np.linalg.norm(e1) < 1e-6:
        raise InputError(
            f"{generator}: {name} = {across!r} lies along axis = {axis!r}; it must point away from the axis."
        )
    e1 /= np.linalg.norm(e1)
    return e1, np.cross(e3, e1), e3


def direction(generator: str, name: str, value: Sequence[float]) -> FloatArray:
    """Unit vector (3,)."""
    vector = three_finite(value)
    if vector is None or not vector.any():
        raise InputError(f"{generator}: {name} = {value!r} is not allowed; it must be three numbers, not all zero.")
    return vector / np.linalg.norm(vector)
