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
from magshell.linalg.multifrontal.blas import AS_IT_IS, TRANSPOSED, WIDTH, Panel, address_of, subtract_product, view
from magshell.linalg.multifrontal.fronts import Entries, Fronts
from magshell.linalg.multifrontal.tree import ranges

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
    starts = entries.starts
    for b in range(starts.size - 1):
        for j in range(starts[b + 1] - starts[b]):
            p = indptr[starts[b] + j]
            for pair in range(entries.pointer[b], entries.pointer[b + 1]):
                row = entries.rows[pair]
                size, at, panels = starts[row + 1] - starts[row], entries.target[pair], factors.lower
                if at < 0:
                    at, panels = ~at, factors.upper  # empty if the matrix is symmetric
                if panels.size > 0:
                    into, step = at + j * entries.column_step[pair], entries.row_step[pair]
                    for i in range(size):
                        panels[into + i * step] = data[p + i]
                p += size


@Kernel
def eliminate(sequence: IntArray, fronts: Fronts, tree: Tree, factors: Factors, room: Room, dgemm: int) -> float:
    """Eliminate the pivots of a sequence of fronts; returns the least pivot's magnitude."""
    symmetric, least = factors.symmetric, np.inf
    for s in sequence:
        k, r = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        _assemble(s, fronts, tree, factors, room)
        block = Panel(address_of(factors.lower) + WIDTH * fronts.lower[s], k, k, k + r)
        least = min(least, _factorise_block(block, symmetric, dgemm))
        if r == 0:
            continue
        L = Panel(block.address + WIDTH * k, r, k, k + r)
        U = Panel(address_of(room.panel if symmetric else factors.upper), r, k, r)
        if not symmetric:
            U = Panel(U.address + WIDTH * fronts.upper[s], r, k, r)
        for side in range(1 if symmetric else 2):
            _divide(block, U if side else L, TRANSPOSED if side else AS_IT_IS, dgemm)
        if symmetric:
            for j in range(k):
                column = view(block.address, j * (k + r), k + r)
                own, pivot = view(U.address, j * r, r), column[j]
                below = view(L.address, j * (k + r), r)
                for i in range(r):
                    own[i] = pivot * below[i]
        update = address_of(room.update)
        chunk = CHUNK if symmetric else r
        for j in range(0, r, chunk):
            columns = min(chunk, r - j)
            subtract_product(
                dgemm,
                Panel(L.address + WIDTH * j, r - j, k, k + r),
                Panel(U.address + WIDTH * j, columns, k, r),
                TRANSPOSED,
                Panel(update + WIDTH * (j * r + j), r - j, columns, r),
            )
        kept, at = address_of_update(s, tree, room)
        own, other = view(kept, at, r * r), view(update, 0, r * r)
        for t in range(r * r):
            own[t] = other[t]
    return least


@inline
def address_of_update(s: int, tree: Tree, room: Room) -> tuple[int, int]:
    """Memory where the update of a front is kept for the parent, and its first entry there."""
    at = tree.update_at[s]
    if at >= 0:
        return address_of(room.stack), at
    return address_of(room.kept), ~at


@inline
def _assemble(s: int, fronts: Fronts, tree: Tree, factors: Factors, room: Room) -> None:
    """Add the updates of the children to the panels, and to the update of the front, which is zero before.

    Entries are added run by run; of a symmetric matrix those on and below the diagonal.
    """
    symmetric = factors.symmetric
    k, r = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
    lower, update = address_of(factors.lower), address_of(room.update)
    own = view(update, 0, r * r)
    for t in range(r * r):
        own[t] = 0.0
    for c in range(tree.child_pointer[s], tree.child_pointer[s + 1]):
        child = tree.child[c]
        source, origin = address_of_update(child, tree, room)
        first_run, last_run = fronts.run_pointer[child], fronts.run_pointer[child + 1]
        column, size = 0, fronts.beyond[child]
        for b in range(first_run, last_run):
            for j in range(fronts.run_target[b], fronts.run_target[b] + fronts.run_length[b]):
                at = origin + column * size + (column if symmetric else 0)
                for a in range(b if symmetric else first_run, last_run):
                    i, length = fronts.run_target[a], fronts.run_length[a]
                    if symmetric and a == b:
                        length -= j - i
                        i = j
                    given = view(source, at, length)
                    if j >= k and i < k:
                        to = fronts.upper[s] + i * r + j - k
                        for t in range(length):
                            factors.upper[to + t * r] += given[t]
                    else:
                        own = view(lower, fronts.lower[s] + j * (k + r) + i, length)
                        if j >= k:
                            own = view(update, (j - k) * r + i - k, length)
                        for t in range(length):
                            own[t] += given[t]
                    at += length
                column += 1


@inline
def _factorise_block(block: Panel, symmetric: bool, dgemm: int) -> float:
    """LU of a pivot block by strips of columns; of a symmetric one only the lower triangle is given."""
    k, stride, least = block.rows, block.stride, np.inf
    values = view(block.address, 0, stride * k)
    for b in range(0, k, STRIP):
        e = min(b + STRIP, k)
        if symmetric:
            for j in range(b, e):
                for i in range(j + 1, e):
                    values[i * stride + j] = values[j * stride + i]
        corner = Panel(block.address + WIDTH * (b * stride + b), e - b, e - b, stride)
        least = min(least, _factorise_strip(corner))
        if e == k:
            break
        _divide_strip(corner, Panel(block.address + WIDTH * (b * stride + e), k - e, e - b, stride), AS_IT_IS)
        for j in range(e, k):
            for i in range(b, e):
                if symmetric:
                    values[j * stride + i] = values[i * stride + j] * values[i * stride + i]
                else:
                    own = view(block.address, j * stride + i + 1, e - i - 1)
                    subtract(own, view(block.address, i * stride + i + 1, e - i - 1), values[j * stride + i])
        chunk = CHUNK if symmetric else k
        for j in range(e, k, chunk):
            columns = min(chunk, k - j)
            top = j if symmetric else e
            subtract_product(
                dgemm,
                Panel(block.address + WIDTH * (b * stride + top), k - top, e - b, stride),
                Panel(block.address + WIDTH * (j * stride + b), e - b, columns, stride),
                AS_IT_IS,
                Panel(block.address + WIDTH * (j * stride + top), k - top, columns, stride),
            )
    return least


@inline
def _divide(triangle: Panel, X: Panel, form: np.uint8, dgemm: int) -> None:
    """X := X U⁻¹, or transposed X := X L⁻ᵀ with ones on the diagonal of L, by strips; L and U are in one block."""
    lower = form == TRANSPOSED
    for b in range(0, X.columns, STRIP):
        size = min(STRIP, X.columns - b)
        at = triangle.address + WIDTH * (b if lower else b * triangle.stride)
        before = Panel(at, size if lower else b, b if lower else size, triangle.stride)
        strip = Panel(X.address + WIDTH * b * X.stride, X.rows, size, X.stride)
        subtract_product(dgemm, Panel(X.address, X.rows, b, X.stride), before, form, strip)
        corner = triangle.address + WIDTH * (b * triangle.stride + b)
        _divide_strip(Panel(corner, size, size, triangle.stride), strip, form)


@inline
def _divide_strip(triangle: Panel, X: Panel, form: np.uint8) -> None:
    """The same for few columns, by so many rows at a time as the cache keeps."""
    lower = form == TRANSPOSED
    T = view(triangle.address, 0, triangle.stride * triangle.columns)
    for top in range(0, X.rows, ROWS):
        size = min(ROWS, X.rows - top)
        for j in range(X.columns):
            own = view(X.address, j * X.stride + top, size)
            for i in range(j):
                factor = T[i * triangle.stride + j] if lower else T[j * triangle.stride + i]
                subtract(own, view(X.address, i * X.stride + top, size), factor)
            if not lower:
                inverse = 1.0 / T[j * triangle.stride + j]
                for t in range(size):
                    own[t] *= inverse


@inline
def _factorise_strip(block: Panel) -> float:
    """LU of a small square block in place; returns the least pivot's magnitude."""
    least = np.inf
    for j in range(block.columns):
        size = block.columns - j
        column = view(block.address, j * block.stride + j, size)
        pivot = column[0]
        least = min(least, abs(pivot))
        for i in range(1, size):
            column[i] /= pivot
        below = view(block.address, j * block.stride + j + 1, size - 1)
        for c in range(1, size):
            right = view(block.address, (j + c) * block.stride + j, size)
            subtract(view(block.address, (j + c) * block.stride + j + 1, size - 1), below, right[0])
    return least


@inline
def subtract(own: AnyArray, other: AnyArray, factor: float) -> None:
    """Subtract so many times another array of the same size."""
    for t in range(own.size):
        own[t] -= other[t] * factor


def negative_pivots(fronts: Fronts, lower: AnyArray) -> int:
    """Pivots below zero."""
    step = np.repeat(fronts.pivots + fronts.beyond + 1, fronts.pivots)
    first = np.repeat(fronts.lower[:-1], fronts.pivots)
    number = ranges(np.zeros_like(fronts.pivots), fronts.pivots)
    return int(np.count_nonzero(lower[first + number * step] < 0.0))
