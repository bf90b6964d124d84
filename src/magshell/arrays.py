"""Names for the kinds of array, and vectors that users write."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
AnyArray: TypeAlias = NDArray[Any]


def three_finite(value: ArrayLike | None) -> FloatArray | None:
    """Three finite numbers as an array (3,) of its own; None: they are not."""
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError):
        return None
    return found if found.shape == (3,) and np.isfinite(found).all() else None
