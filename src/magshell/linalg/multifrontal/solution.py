"""Solution with the factors of all fronts: forward in their order, backward against it."""

from __future__ import annotations

from magshell.arrays import AnyArray
from magshell.compiled import Kernel, inline
from magshell.linalg.multifrontal.elimination import Factors, copy, subtract
from magshell.linalg.multifrontal.fronts import Fronts


@Kernel
def solve(fronts: Fronts, factors: Factors, x: AnyArray, room: AnyArray) -> None:
    """x := U⁻¹ L⁻¹ x in elimination order; `room` holds the rows of the largest front."""
    lower, upper = factors.lower, factors.upper
    for s in range(fronts.parent.size):
        begin, end, at = fronts.begin[s], fronts.begin[s + 1], fronts.lower[s]
        own, beyond, stride = x[begin:end], room[: fronts.beyond[s]], end - begin + fronts.beyond[s]
        k = own.size
        beyond[:] = 0.0
        for j in range(k):
            subtract(lower, at + j * stride + j + 1, own[j], own[j + 1 :])
            subtract(lower, at + j * stride + k, own[j], beyond)
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        begin, end, at = fronts.begin[s], fronts.begin[s + 1], fronts.lower[s]
        own, beyond, stride = x[begin:end], room[: fronts.beyond[s]], end - begin + fronts.beyond[s]
        k = own.size
        _take(s, fronts, x, beyond)
        for j in range(k):
            if factors.symmetric:
                own[j] -= lower[at + j * stride + j] * product(lower, at + j * stride + k, beyond)
            else:
                own[j] -= product(upper, fronts.upper[s] + j * beyond.size, beyond)
        for j in range(k - 1, -1, -1):
            own[j] /= lower[at + j * stride + j]
            subtract(lower, at + j * stride, own[j], own[:j])


@Kernel
def solve_transposed(fronts: Fronts, factors: Factors, x: AnyArray, room: AnyArray) -> None:
    """x := L⁻ᵀ U⁻ᵀ x in elimination order; of an unsymmetric matrix."""
    lower, upper = factors.lower, factors.upper
    for s in range(fronts.parent.size):
        begin, end, at = fronts.begin[s], fronts.begin[s + 1], fronts.lower[s]
        own, beyond, stride = x[begin:end], room[: fronts.beyond[s]], end - begin + fronts.beyond[s]
        beyond[:] = 0.0
        for j in range(own.size):
            own[j] = (own[j] - product(lower, at + j * stride, own[:j])) / lower[at + j * stride + j]
            subtract(upper, fronts.upper[s] + j * beyond.size, own[j], beyond)
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        begin, end, at = fronts.begin[s], fronts.begin[s + 1], fronts.lower[s]
        own, beyond, stride = x[begin:end], room[: fronts.beyond[s]], end - begin + fronts.beyond[s]
        k = own.size
        _take(s, fronts, x, beyond)
        for j in range(k - 1, -1, -1):
            own[j] -= product(lower, at + j * stride + j + 1, own[j + 1 :])
            own[j] -= product(lower, at + j * stride + k, beyond)


@inline
def _give(s: int, fronts: Fronts, beyond: AnyArray, x: AnyArray) -> None:
    """Add what the rows beyond a front receive."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        place, length = fronts.run_place[run], fronts.run_length[run]
        subtract(beyond, at, -1.0, x[place : place + length])
        at += length


@inline
def _take(s: int, fronts: Fronts, x: AnyArray, beyond: AnyArray) -> None:
    """Collect the values of the rows beyond a front."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        place, length = fronts.run_place[run], fronts.run_length[run]
        copy(x, place, beyond[at : at + length])
        at += length


@inline
def product(values: AnyArray, start: int, own: AnyArray) -> float:
    """Scalar product with as many values from some of another array."""
    other, total = values[start : start + own.size], 0.0
    for t in range(own.size):
        total += other[t] * own[t]
    return total
