"""Input of loads: numbers, vectors and histories, refused with the load that they belong to."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.model.loads.load import Load
from magshell.multipliers import numbers


def label(load: Load) -> str:
    """The load's name in messages."""
    return f"loads: {load.kind}" + ("" if load.group is None else f" on '{load.group}'")


@contextmanager
def located(load: Load) -> Iterator[None]:
    """Prefix every input error of the block with the load."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{label(load)}: {error}") from None


def keep_history(load: Load) -> None:
    """Replace a load's history by a tuple of floats.

    Raises
    ------
    InputError
        It is something else than finite numbers.
    """
    if load.history is not None:
        object.__setattr__(load, "history", tuple(numbers(load.history, label(load)).tolist()))


def vector(name: str, value: Any) -> FloatArray:
    """A vector (3,) of finite numbers that is not zero."""
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {value!r}; it takes three numbers") from None
    if found.shape != (3,) or not np.all(np.isfinite(found)):
        raise InputError(f"{name} is {value!r}; it needs 3 finite components")
    if not np.any(found):
        raise InputError(f"{name} is zero; leave the load out")
    return found


def number(name: str, value: Any) -> float:
    """A finite number that is not zero."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {value!r}; it takes one number") from None
    if not np.isfinite(found):
        raise InputError(f"{name} is {value!r}; it must be finite")
    if not found:
        raise InputError(f"{name} is zero; leave the load out")
    return found
