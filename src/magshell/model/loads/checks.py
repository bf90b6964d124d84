"""Input of loads: numbers and vectors."""

from __future__ import annotations

from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError


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
