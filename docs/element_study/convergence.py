"""Limits, orders, errors, and what they say: errors at equal unknowns, CPU time at equal error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from element_study.cases import Case, Quantity

HIGHEST, LOWEST = 4.0, 1.0
"""Orders that are believed: twice the degree of the functions at best, and that of a strong singularity."""


@dataclass(frozen=True)
class Series:
    """One quantity of one member on a sequence of meshes, coarse to fine.

    Attributes
    ----------
    member : str
    size : (n,) ndarray
        Mesh size, relative.
    unknowns, values, cpu : (n,) ndarray
        Values in the unit of the quantity; s.
    """

    member: str
    size: np.ndarray
    unknowns: np.ndarray
    values: np.ndarray
    cpu: np.ndarray

    @cached_property
    def order(self) -> float:
        """Order p of value = limit + C size^p on the three finest meshes, within what is believed."""
        h, (one, two, three) = self.size[-3:], self.values[-3:]
        if (three - two) * (two - one) <= 0.0:
            return LOWEST

        def excess(p: float) -> float:
            return (h[1] ** p - h[2] ** p) / (h[0] ** p - h[1] ** p) - (three - two) / (two - one)

        low, high = LOWEST, HIGHEST
        if excess(low) <= 0.0:
            return low
        if excess(high) >= 0.0:
            return high
        while high - low > 1e-6:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if excess(middle) > 0.0 else (low, middle)
        return low

    @cached_property
    def limit(self) -> float:
        """Richardson's, from the two finest meshes with that order."""
        coarse, fine = self.size[-2:] ** self.order
        return float((coarse * self.values[-1] - fine * self.values[-2]) / (coarse - fine))

    @cached_property
    def errors(self) -> np.ndarray:
        """Relative distance of each value from the limit."""
        return np.abs(self.values / self.limit - 1.0)

    @cached_property
    def sure(self) -> np.ndarray:
        """Largest error of a mesh and all finer ones: a value that crosses the limit by chance earns nothing."""
        return np.maximum.accumulate(self.errors[::-1])[::-1]


def series(runs: Sequence[dict], case: Case, member: str, quantity: Quantity) -> Series:
    """Read a quantity off the runs of a member, those that reached its load."""
    kept, size = [], []
    for run, divisions in zip(runs, case.meshes[member], strict=True):
        at = [i for i, load in enumerate(run["loads"]) if abs(load - quantity.load) < 1e-9]
        if at:
            value = quantity.scale * run["displacements"][quantity.probe][at[0]][quantity.component - 1]
            kept.append((run["unknowns"], value, run["cpu"][at[0]]))
            size.append(1.0 / divisions[1])
    return Series(member, np.array(size), *np.array(kept, dtype=float).T)


def at_equal_unknowns(better: Series, other: Series) -> np.ndarray:
    """Errors of the other over those of the better one, at every number of unknowns of either that both span.

    The members should have one limit: what is below the difference of the two they have counts as that difference.
    """
    known = abs(other.limit / better.limit - 1.0)
    both = np.union1d(better.unknowns, other.unknowns)
    first, last = max(better.unknowns[0], other.unknowns[0]), min(better.unknowns[-1], other.unknowns[-1])
    both = np.log(both[(both >= first) & (both <= last)])
    errors = [np.interp(both, np.log(one.unknowns), np.log(np.maximum(one.sure, known))) for one in (better, other)]
    return np.exp(errors[1] - errors[0])


class Cost(NamedTuple):
    """CPU time (s) at an error; `sign` is < or > where the meshes do not reach so far, else empty."""

    seconds: float
    sign: str


def cost(one: Series, error: float) -> Cost:
    """CPU time at which the error falls to a value, on the lines of the log-log picture."""
    below = np.flatnonzero(one.sure <= error)
    if not below.size:
        return Cost(float(one.cpu[-1]), ">")
    if below[0] == 0:
        return Cost(float(one.cpu[0]), "<")
    pair = slice(below[0] - 1, below[0] + 1)
    e, c = np.log(one.sure[pair])[::-1], np.log(one.cpu[pair])[::-1]
    return Cost(float(np.exp(np.interp(np.log(error), e, c))), "")
