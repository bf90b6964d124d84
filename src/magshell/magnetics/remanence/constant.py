"""The same vector everywhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from magshell.magnetics.remanence.vectors import Remanence
from magshell.magnetics.remanence.vectors import vector as checked


def constant(vector: ArrayLike) -> Remanence:
    """The same vector (3,), T, everywhere."""
    value = checked("vector", vector)
    return lambda mesh, points: np.broadcast_to(value, points.shape).copy()
