"""Solution with the factors of all fronts: forward in their order, backward against it."""

from __future__ import annotations

from magshell.arrays import AnyArray
from magshell.compiled import Kernel, inline
from magshell.linalg.multifrontal.elimination import Factors
from magshell.linalg.multifrontal.fronts import Fronts


@Kernel
def solve(fronts: Fronts, factors: Factors, x: AnyArray, beyond: AnyArray) -> None:
    """x := U⁻¹ L⁻¹ x in elimination order; `beyond` has room for the rows of the largest front."""
    lower = factors.lower
    for s in range(fronts.parent.size):
        f, k, r = fronts.begin[s], fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        for i in range(r):
            beyond[i] = 0.0
        for j in range(k):
            at, value = fronts.lower[s] + j * (k + r), x[f + j]
            for i in range(j + 1, k):
                x[f + i] -= lower[at + i] * value
            for i in range(r):
                beyond[i] -= lower[at + k + i] * value
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        f, k, r = fronts.begin[s], fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        _take(s, fronts, x, beyond)
        for j in range(k):
            total = 0.0
            if factors.symmetric:
                at = fronts.lower[s] + j * (k + r)
                for i in range(r):
                    total += lower[at + k + i] * beyond[i]
                total *= lower[at + j]
            else:
                at = fronts.upper[s] + j * r
                for i in range(r):
                    total += factors.upper[at + i] * beyond[i]
            x[f + j] -= total
        for j in range(k - 1, -1, -1):
            at = fronts.lower[s] + j * (k + r)
            value = x[f + j] / lower[at + j]
            x[f + j] = value
            for i in range(j):
                x[f + i] -= lower[at + i] * value


@Kernel
def solve_transposed(fronts: Fronts, factors: Factors, x: AnyArray, beyond: AnyArray) -> None:
    """x := L⁻ᵀ U⁻ᵀ x in elimination order; of an unsymmetric matrix."""
    lower, upper = factors.lower, factors.upper
    for s in range(fronts.parent.size):
        f, k, r = fronts.begin[s], fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        for i in range(r):
            beyond[i] = 0.0
        for j in range(k):
            at, total = fronts.lower[s] + j * (k + r), x[f + j]
            for i in range(j):
                total -= lower[at + i] * x[f + i]
            value = total / lower[at + j]
            x[f + j] = value
            at = fronts.upper[s] + j * r
            for i in range(r):
                beyond[i] -= upper[at + i] * value
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        f, k, r = fronts.begin[s], fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        _take(s, fronts, x, beyond)
        for j in range(k - 1, -1, -1):
            at, total = fronts.lower[s] + j * (k + r), x[f + j]
            for i in range(j + 1, k):
                total -= lower[at + i] * x[f + i]
            for i in range(r):
                total -= lower[at + k + i] * beyond[i]
            x[f + j] = total


@inline
def _give(s: int, fronts: Fronts, beyond: AnyArray, x: AnyArray) -> None:
    """Add what the rows beyond a front receive."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        place = fronts.run_place[run]
        for i in range(fronts.run_length[run]):
            x[place + i] += beyond[at]
            at += 1


@inline
def _take(s: int, fronts: Fronts, x: AnyArray, beyond: AnyArray) -> None:
    """Collect the values of the rows beyond a front."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        place = fronts.run_place[run]
        for i in range(fronts.run_length[run]):
            beyond[at] = x[place + i]
            at += 1
