"""Observed order and limit of a sequence of meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

ORDERS = (0.25, 12.0)


class Limit(NamedTuple):
    """Where a sequence goes.

    Attributes
    ----------
    value : float
        Extrapolated; the last one where there is no order.
    order : float
        Of the three finest meshes; nan where they do not approach a value from one side.
    """

    value: float
    order: float


def limit(sizes: Sequence[float], values: Sequence[float]) -> Limit:
    """Fit v + C h^p to the last three values.

    Parameters
    ----------
    sizes : sequence of float
        Element sizes h in any unit, falling.
    values : sequence of float
        One for each.
    """
    from scipy.optimize import brentq

    h1, h2, h3 = (size / sizes[-3] for size in sizes[-3:])
    v1, v2, v3 = values[-3:]
    first, second = v1 - v2, v2 - v3
    if not all(map(math.isfinite, (v1, v2, v3))) or first * second <= 0.0:
        return Limit(v3, math.nan)

    def excess(order: float) -> float:
        return (h1**order - h2**order) * second - (h2**order - h3**order) * first

    if excess(ORDERS[0]) * excess(ORDERS[1]) > 0.0:
        return Limit(v3, math.nan)
    order = float(brentq(excess, *ORDERS))
    return Limit(v3 - second * h3**order / (h2**order - h3**order), order)
