"""Numerical phase: every front is assembled, its pivots eliminated, its update left for the parent.

With the front ordered as pivots 1 and the rest 2,

    [A11 A12]   [L11    ] [U11 U12]
    [A21 A22] = [L21  I ] [     S ],      S = A22 - L21 U12.

No rows are exchanged. For a symmetric matrix U12 = D L21ᵀ is not kept and only the lower triangle of S is made.
I. S. Duff and J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math.
Softw. 9, 1983.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.compiled import Kernel, inline
from magshell.linalg.multifrontal.blas import Panel, address_of, subtract_product
from magshell.linalg.multifrontal.fronts import Entries, Fronts

# Columns that are eliminated by loops, and rows of them that the cache keeps; columns of a symmetric update at a time.
STRIP, ROWS, CHUNK = 16, 128, 128


class Factors(NamedTuple):
    """Values of all panels; those of the upper ones are missing if the matrix is symmetric."""

    lower: AnyArray
    upper: AnyArray
    symmetric: bool


class Tree(NamedTuple):
    """Children of the fronts, and where their updates lie (see `Schedule`)."""

    child_pointer: IntArray
    child: IntArray
    update_at: IntArray


class Room(NamedTuple):
    """Memory of a thread: stack of updates, present update, upper panel of a symmetric front; updates of all tasks."""

    stack: AnyArray
    update: AnyArray
    panel: AnyArray
    kept: AnyArray


@Kernel
def scatter(indptr: IntArray, data: AnyArray, entries: Entries, factors: Factors) -> None:
    """Put the entries of the matrix into the panels, which are zero."""
    lower, upper, symmetric = factors.lower, factors.upper, factors.symmetric
    starts = entries.starts
    for b in range(starts.size - 1):
        for j in range(starts[b + 1] - starts[b]):
            p = indptr[starts[b] + j]
            for pair in range(entries.pointer[b], entries.pointer[b + 1]):
                row = entries.rows[pair]
                size, target = starts[row + 1] - starts[row], entries.target[pair]
                if target >= 0:
                    at = target + j * entries.column_step[pair]
                    for i in range(size):
                        lower[at + i] = data[p + i]
                elif not symmetric:
                    at, step = ~target + j, entries.row_step[pair]
                    for i in range(size):
                        upper[at + i * step] = data[p + i]
                p += size


@Kernel
def eliminate(sequence: IntArray, fronts: Fronts, tree: Tree, factors: Factors, room: Room, dgemm: int) -> float:
    """Eliminate the pivots of a sequence of fronts; returns the least pivot's magnitude."""
    lower, upper, symmetric = factors.lower, factors.upper, factors.symmetric
    width = lower.itemsize
    at_lower, at_update = address_of(lower), address_of(room.update)
    least = np.inf
    for s in sequence:
        k, r = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        stride, first = k + r, fronts.lower[s]
        room.update[: r * r] = 0.0
        for c in range(tree.child_pointer[s], tree.child_pointer[s + 1]):
            _add_update(tree.child[c], s, fronts, tree, factors, room)
        block = Panel(at_lower + width * first, k, k, stride)
        least = min(least, _factorise_block(lower, first, block, symmetric, dgemm, width))
        if r == 0:
            continue
        L = Panel(block.address + width * k, r, k, stride)
        _divide(dgemm, (lower, block, first), (lower, L, first + k), False)
        if symmetric:
            U = Panel(address_of(room.panel), r, k, r)
            for j in range(k):
                pivot = lower[first + j * stride + j]
                for i in range(r):
                    room.panel[j * r + i] = pivot * lower[first + j * stride + k + i]
        else:
            U = Panel(address_of(upper) + width * fronts.upper[s], r, k, r)
            _divide(dgemm, (lower, block, first), (upper, U, fronts.upper[s]), True)
        chunk = CHUNK if symmetric else r
        for j in range(0, r, chunk):
            columns = min(chunk, r - j)
            subtract_product(
                dgemm,
                Panel(L.address + width * j, r - j, k, stride),
                Panel(U.address + width * j, columns, k, r),
                True,
                Panel(at_update + width * (j * r + j), r - j, columns, r),
            )
        at = tree.update_at[s]
        if at >= 0:
            copy(room.update, 0, room.stack[at : at + r * r])
        else:
            copy(room.update, 0, room.kept[~at : ~at + r * r])
    return least


@inline
def _add_update(child: int, s: int, fronts: Fronts, tree: Tree, factors: Factors, room: Room) -> None:
    """Add the update of a child to the panels and the update of front `s`."""
    if tree.update_at[child] >= 0:
        _extend(child, s, fronts, factors, room.stack, tree.update_at[child], room.update)
    else:
        _extend(child, s, fronts, factors, room.kept, ~tree.update_at[child], room.update)


@inline
def _extend(
    child: int, s: int, fronts: Fronts, factors: Factors, source: AnyArray, origin: int, update: AnyArray
) -> None:
    """Add entries run by run; of a symmetric matrix those on and below the diagonal."""
    lower, upper, symmetric = factors.lower, factors.upper, factors.symmetric
    k, r, size = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s], fronts.beyond[child]
    first_run, last_run = fronts.run_pointer[child], fronts.run_pointer[child + 1]
    column = 0
    for b in range(first_run, last_run):
        for j in range(fronts.run_target[b], fronts.run_target[b] + fronts.run_length[b]):
            row = column if symmetric else 0
            at = origin + column * size + row
            for a in range(b if symmetric else first_run, last_run):
                i, length = fronts.run_target[a], fronts.run_length[a]
                if symmetric and a == b:
                    length -= j - i
                    i = j
                if j < k:
                    to = fronts.lower[s] + j * (k + r) + i
                    subtract(source, at, -1.0, lower[to : to + length])
                elif i < k:
                    to = fronts.upper[s] + i * r + j - k
                    for t in range(length):
                        upper[to + t * r] += source[at + t]
                else:
                    to = (j - k) * r + i - k
                    subtract(source, at, -1.0, update[to : to + length])
                at += length
            column += 1


@inline
def _factorise_block(values: AnyArray, first: int, block: Panel, symmetric: bool, dgemm: int, width: int) -> float:
    """LU of a pivot block by strips of columns; of a symmetric one only the lower triangle is given."""
    k, stride, least = block.rows, block.stride, np.inf
    for b in range(0, k, STRIP):
        e = min(b + STRIP, k)
        if symmetric:
            for j in range(b, e):
                for i in range(j + 1, e):
                    values[first + i * stride + j] = values[first + j * stride + i]
        least = min(least, _factorise_strip(values, first + b * stride + b, e - b, stride))
        if e == k:
            break
        corner = Panel(block.address + width * (b * stride + b), e - b, e - b, stride)
        below = Panel(block.address + width * (b * stride + e), k - e, e - b, stride)
        _divide(dgemm, (values, corner, first + b * stride + b), (values, below, first + b * stride + e), False)
        for j in range(e, k):
            for i in range(b, e):
                if symmetric:
                    values[first + j * stride + i] = values[first + i * stride + j] * values[first + i * stride + i]
                else:
                    own = values[first + j * stride + i + 1 : first + j * stride + e]
                    subtract(values, first + i * stride + i + 1, values[first + j * stride + i], own)
        chunk = CHUNK if symmetric else k
        for j in range(e, k, chunk):
            columns = min(chunk, k - j)
            top = j if symmetric else e
            subtract_product(
                dgemm,
                Panel(block.address + width * (b * stride + top), k - top, e - b, stride),
                Panel(block.address + width * (j * stride + b), e - b, columns, stride),
                False,
                Panel(block.address + width * (j * stride + top), k - top, columns, stride),
            )
    return least


@inline
def _divide(dgemm: int, triangle: tuple[AnyArray, Panel, int], right: tuple[AnyArray, Panel, int], lower: bool) -> None:
    """X := X U⁻¹, or X := X L⁻ᵀ with ones on the diagonal of L, strip by strip.

    Parameters
    ----------
    triangle, right : tuple
        L and U in one block, and X: the array, the panel in it, and the place of the panel's first entry.
    lower : bool
        Whether to divide by Lᵀ.
    """
    T, block, first = triangle
    values, X, start = right
    width = values.itemsize
    for b in range(0, X.columns, STRIP):
        e = min(b + STRIP, X.columns)
        at = block.address + width * (b if lower else b * block.stride)
        before = Panel(at, e - b if lower else b, b if lower else e - b, block.stride)
        subtract_product(
            dgemm,
            Panel(X.address, X.rows, b, X.stride),
            before,
            lower,
            Panel(X.address + width * b * X.stride, X.rows, e - b, X.stride),
        )
        for top in range(0, X.rows, ROWS):
            bottom = min(top + ROWS, X.rows)
            for j in range(b, e):
                own = values[start + j * X.stride + top : start + j * X.stride + bottom]
                for i in range(b, j):
                    factor = T[first + i * block.stride + j] if lower else T[first + j * block.stride + i]
                    subtract(values, start + i * X.stride + top, factor, own)
                if not lower:
                    inverse = 1.0 / T[first + j * block.stride + j]
                    for t in range(own.size):
                        own[t] *= inverse


@inline
def _factorise_strip(values: AnyArray, first: int, size: int, stride: int) -> float:
    """LU of a small square block in place; returns the least pivot's magnitude."""
    least = np.inf
    for j in range(size):
        own = first + j * stride + j
        pivot = values[own]
        least = min(least, abs(pivot))
        for i in range(1, size - j):
            values[own + i] /= pivot
        for c in range(1, size - j):
            at = own + c * stride
            subtract(values, own + 1, values[at], values[at + 1 : at + size - j])
    return least


@inline
def subtract(values: AnyArray, start: int, factor: float, own: AnyArray) -> None:
    """Subtract so many times as many values from some of this or another array."""
    other = values[start : start + own.size]
    for t in range(own.size):
        own[t] -= other[t] * factor


@inline
def copy(values: AnyArray, start: int, own: AnyArray) -> None:
    """Take as many values from some of another array."""
    other = values[start : start + own.size]
    for t in range(own.size):
        own[t] = other[t]


@Kernel
def negative_pivots(fronts: Fronts, lower: AnyArray) -> int:
    """Pivots below zero."""
    count = 0
    for s in range(fronts.parent.size):
        k = fronts.begin[s + 1] - fronts.begin[s]
        for j in range(k):
            count += lower[fronts.lower[s] + j * (k + fronts.beyond[s] + 1)] < 0.0
    return count
