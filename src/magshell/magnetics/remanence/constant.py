"""The same vector everywhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence, given_once
from magshell.magnetics.remanence.vectors import vector as checked
from magshell.magnetics.remanence.way import Way
from magshell.remembered import remembered


@remembered
def constant(vector: ArrayLike) -> Remanence:
    """The same vector (3,), T, everywhere."""
    value = checked("vector", vector)
    return lambda mesh, points: np.broadcast_to(value, points.shape).copy()


def _from_keys(
    vector: ArrayLike | None = None, magnitude: float | None = None, direction: ArrayLike | None = None
) -> Remanence:
    if vector is not None:
        return constant(vector)
    return constant((magnitude or 0.0) * np.asarray(direction) / np.linalg.norm(np.asarray(direction)))


def _words(vector: Sequence[float] | None, magnitude: float | None, direction: Sequence[float] | None) -> str:
    along = np.array(direction if vector is None else vector)
    length = np.linalg.norm(along)
    return f"constant, along {wording.vector(along / length)}" if length else "constant"


def _fault(
    vector: Sequence[float] | None, magnitude: float | None, direction: Sequence[float] | None
) -> tuple[str, str] | None:
    return given_once("vector", vector, magnitude, direction)


CONSTANT = Way(
    _from_keys,
    {
        "vector": Key("RemanenceVector", "The remanent flux density; or instead", "magnitude and direction"),
        "magnitude": Key("PositiveRemanence", "its magnitude, and"),
        "direction": Key("Direction", "its direction."),
    },
    _words,
    in_space=True,
    fault=_fault,
)
