"""Numbers as text in a page: 16 bits between the least and the largest of a step, base64, little-endian."""

from __future__ import annotations

import base64
from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray

MISSING = 65535
"""Code of a value that is not finite."""
LARGEST = MISSING - 1


class Range(NamedTuple):
    """Least and largest finite value; 0 and 0 where there is none."""

    low: float
    high: float


def span(values: FloatArray) -> Range:
    """The range of the finite values."""
    finite = values[np.isfinite(values)]
    return Range(float(finite.min()), float(finite.max())) if finite.size else Range(0.0, 0.0)


def quantised(values: FloatArray) -> tuple[AnyArray, Range]:
    """Values as whole numbers 0 to `LARGEST` between the ends of their range, `MISSING` where not finite.

    Returns
    -------
    array of uint16
    Range
    """
    ends = span(values)
    scale = LARGEST / (ends.high - ends.low) if ends.high > ends.low else 0.0
    known = np.isfinite(values)
    codes = np.full(values.shape, MISSING, dtype="<u2")
    codes[known] = np.rint((values[known] - ends.low) * scale)
    return codes, ends


def text(values: Any, kind: str) -> str:
    """An array as base64 of its numbers of this kind ("<f4", "<u4", "<u2", "u1")."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()
