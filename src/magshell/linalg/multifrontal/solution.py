"""Solution with the factors of all fronts: forward in their order, backward against it."""

from __future__ import annotations

from magshell.arrays import AnyArray
from magshell.compiled import Kernel, inline
from magshell.linalg.multifrontal.blas import address_of, view
from magshell.linalg.multifrontal.elimination import Factors, subtract
from magshell.linalg.multifrontal.fronts import Fronts


@Kernel
def solve(fronts: Fronts, factors: Factors, x: AnyArray, room: AnyArray) -> None:
    """x := U⁻¹ L⁻¹ x in elimination order; `room` holds the rows of the largest front."""
    lower, symmetric, rows = address_of(factors.lower), factors.symmetric, address_of(room)
    coupling = lower if symmetric else address_of(factors.upper)
    for s in range(fronts.parent.size):
        k, r, at = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s], fronts.lower[s]
        own, beyond = view(address_of(x), fronts.begin[s], k), view(rows, 0, r)
        for i in range(r):
            beyond[i] = 0.0
        for j in range(k):
            for part in range(2):
                into = beyond if part else view(address_of(x), fronts.begin[s] + j + 1, k - j - 1)
                subtract(into, view(lower, at + j * (k + r) + (k if part else j + 1), into.size), own[j])
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        k, r, at = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s], fronts.lower[s]
        own, beyond = view(address_of(x), fronts.begin[s], k), view(rows, 0, r)
        pivots = view(lower, at, k * (k + r))
        _take(s, fronts, x, beyond)
        for j in range(k):
            factor, first = 1.0, fronts.upper[s] + j * r
            if symmetric:
                factor, first = pivots[j * (k + r) + j], at + j * (k + r) + k
            own[j] -= factor * product(view(coupling, first, r), beyond)
        for j in range(k - 1, -1, -1):
            own[j] /= pivots[j * (k + r) + j]
            subtract(view(address_of(x), fronts.begin[s], j), view(lower, at + j * (k + r), j), own[j])


@Kernel
def solve_transposed(fronts: Fronts, factors: Factors, x: AnyArray, room: AnyArray) -> None:
    """x := L⁻ᵀ U⁻ᵀ x in elimination order; of an unsymmetric matrix."""
    lower, upper, rows = address_of(factors.lower), address_of(factors.upper), address_of(room)
    for s in range(fronts.parent.size):
        k, r, at = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s], fronts.lower[s]
        own, beyond = view(address_of(x), fronts.begin[s], k), view(rows, 0, r)
        for i in range(r):
            beyond[i] = 0.0
        for j in range(k):
            column = view(lower, at + j * (k + r), k)
            own[j] = (own[j] - product(view(address_of(x), fronts.begin[s], j), column)) / column[j]
            subtract(beyond, view(upper, fronts.upper[s] + j * r, r), own[j])
        _give(s, fronts, beyond, x)
    for s in range(fronts.parent.size - 1, -1, -1):
        k, r, at = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s], fronts.lower[s]
        own, beyond = view(address_of(x), fronts.begin[s], k), view(rows, 0, r)
        _take(s, fronts, x, beyond)
        for j in range(k - 1, -1, -1):
            after = view(address_of(x), fronts.begin[s] + j + 1, k - j - 1)
            own[j] -= product(view(lower, at + j * (k + r) + j + 1, k - j - 1), after)
            own[j] -= product(view(lower, at + j * (k + r) + k, r), beyond)


@inline
def _give(s: int, fronts: Fronts, beyond: AnyArray, x: AnyArray) -> None:
    """Add what the rows beyond a front receive."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        into = view(address_of(x), fronts.run_place[run], fronts.run_length[run])
        for i in range(into.size):
            into[i] += beyond[at + i]
        at += into.size


@inline
def _take(s: int, fronts: Fronts, x: AnyArray, beyond: AnyArray) -> None:
    """Collect the values of the rows beyond a front."""
    at = 0
    for run in range(fronts.run_pointer[s], fronts.run_pointer[s + 1]):
        given = view(address_of(x), fronts.run_place[run], fronts.run_length[run])
        for i in range(given.size):
            beyond[at + i] = given[i]
        at += given.size


@inline
def product(own: AnyArray, other: AnyArray) -> float:
    """Scalar product of an array and as many values of another."""
    total = 0.0
    for t in range(own.size):
        total += own[t] * other[t]
    return total
