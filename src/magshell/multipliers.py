"""How a quantity varies along the load path: a multiplier at the end of each stage, straight in between."""

from __future__ import annotations

from collections.abc import Sequence

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
