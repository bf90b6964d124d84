"""How a quantity varies along the load path: a multiplier at the end of each stage, linear in between."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError


def amplitudes(history: Sequence[float] | None, stages: int, where: str) -> FloatArray:
    """Multipliers (stages,) at the ends of the stages; without a history one at the end of the first and from then on.

    Raises
    ------
    InputError
        Not one finite number for each stage.
    """
    if history is None:
        return np.ones(stages)
    values = numbers(history, where)
    if len(values) != stages:
        raise InputError(
            f"{where}: history has {len(values)} entries; it needs one for each of the {stages} stages of the path"
        )
    return values


def numbers(history: Sequence[float], where: str, name: str = "history") -> FloatArray:
    """The entries as an array.

    Raises
    ------
    InputError
        Something else than finite numbers.
    """
    try:
        values = np.array(history, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{where}: {name} is {history!r}; it takes numbers, one for each stage") from None
    if values.ndim != 1 or not values.size or not np.all(np.isfinite(values)):
        raise InputError(f"{where}: {name} is {history!r}; it takes finite numbers, one for each stage")
    return values


MOST_STOPS = 10_000
"""Of evenly spaced ones in a stage."""


def spaced(stops: Any, end: float, where: str) -> Any:
    """So many stops, evenly spaced up to the end, for a whole number; others as they are.

    Raises
    ------
    InputError
        A number that is not positive, or too large.
    """
    if isinstance(stops, bool) or not isinstance(stops, int):
        return stops
    if not 1 <= stops <= MOST_STOPS:
        raise InputError(f"{where}: stops is {stops}; as a number of evenly spaced ones it must be 1 to {MOST_STOPS}")
    return [end * number / stops for number in range(1, stops + 1)] if end else []
