"""Symbolic phase: the dense fronts of a pattern, and where everything in them lies.

A front belongs to a supernode: k unknowns that are eliminated together, and the r unknowns above them that they couple
with. Its pivot columns are kept in two panels, its Schur complement of order r, the update, is handed to the parent.

    lower panel (k + r, k) by columns:  the pivot block, below it the rows of L
    upper panel (r, k) by columns:      the transpose of the columns of U to the right of the pivot block

Rows of a front ascend. Those of a child that follow each other in the child and in the parent are one run.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.compiled import Kernel
from magshell.linalg.multifrontal.tree import block_graph, blocks_of, is_symmetric, postordered_tree, supernodes_of

# Zeros that supernodes may store, per entry of their pivot columns; columns up to which they are joined at any price.
WASTE, NARROW = 0.12, 16


class Fronts(NamedTuple):
    """The fronts of a pattern, in postorder.

    Attributes
    ----------
    order : ndarray, shape (n,)
        Unknown at each place of the elimination order.
    begin : ndarray, shape (fronts + 1,)
        First place of each front's pivots.
    beyond : ndarray, shape (fronts,)
        Rows r below the pivot block.
    parent : ndarray, shape (fronts,)
        -1 for roots.
    lower, upper : ndarray, shape (fronts + 1,)
        Where the panels begin among those of all fronts.
    run_pointer : ndarray, shape (fronts + 1,)
        First run of the rows below each front's pivot block.
    run_place, run_target, run_length : ndarray, shape (runs,)
        First place of a run, its position in the parent's front, and its rows.
    """

    order: IntArray
    begin: IntArray
    beyond: IntArray
    parent: IntArray
    lower: IntArray
    upper: IntArray
    run_pointer: IntArray
    run_place: IntArray
    run_target: IntArray
    run_length: IntArray

    @property
    def pivots(self) -> IntArray:
        """Pivots k of each front."""
        return np.diff(self.begin)

    @property
    def operations(self) -> AnyArray:
        """Multiplications of the LU of each front."""
        k, r = self.pivots.astype(float), self.beyond.astype(float)
        return k**3 / 3.0 + k**2 * r + k * r**2


class Entries(NamedTuple):
    """Where the entries of the matrix go, block by block.

    Attributes
    ----------
    starts : ndarray, shape (blocks + 1,)
        First columns of the blocks.
    pointer, rows : ndarray
        Graph of the blocks, compressed columns.
    target : ndarray, shape (pairs,)
        Where the first entry of a pair of blocks goes in the lower panels; if negative, its complement in the upper.
    row_step, column_step : ndarray, shape (pairs,)
        From there to the next row and column of the pair.
    """

    starts: IntArray
    pointer: IntArray
    rows: IntArray
    target: IntArray
    row_step: IntArray
    column_step: IntArray


class Structure(NamedTuple):
    """Blocks of the fronts: places of the blocks' unknowns, first blocks of the fronts, blocks beyond each front."""

    order: IntArray
    places: IntArray
    supernodes: IntArray
    pointer: IntArray
    beyond: IntArray


def fronts_of(pointer: IntArray, rows: IntArray, widths: IntArray) -> tuple[Fronts, Structure]:
    """Fronts of a graph of blocks (symmetric, compressed columns, in a fill-reducing order) of so many unknowns."""
    order, parent = postordered_tree(pointer, rows)
    weight = widths[order]
    supernodes = supernodes_of(pointer, rows, order, parent, weight, WASTE, NARROW)
    places = np.append(0, np.cumsum(weight))
    beyond_pointer, beyond_blocks, above = _structures(pointer, rows, order, supernodes)
    begin = places[supernodes]
    sizes = np.append(0, np.cumsum(weight[beyond_blocks]))
    beyond, pivots = np.diff(sizes[beyond_pointer]), np.diff(begin)
    structure = Structure(order, places, supernodes, beyond_pointer, beyond_blocks)
    fronts = Fronts(
        np.repeat(np.cumsum(widths)[order] - places[1:], weight) + np.arange(places[-1]),
        begin,
        beyond,
        above,
        np.append(0, np.cumsum((pivots + beyond) * pivots)),
        np.append(0, np.cumsum(beyond * pivots)),
        *_runs(structure, above, begin),
    )
    return fronts, structure


def analyse(indptr: AnyArray, indices: AnyArray) -> tuple[Fronts, Entries]:
    """Fronts of a matrix of symmetric pattern with sorted rows, its columns in a fill-reducing order.

    Raises
    ------
    ValueError
        The pattern is not symmetric, or lacks entries of the diagonal.
    """
    if not is_symmetric(indptr, indices):
        raise ValueError("the pattern of the matrix must be symmetric, with all of its diagonal")
    starts = blocks_of(indptr, indices)
    pointer, rows = block_graph(indptr, indices, starts)
    fronts, structure = fronts_of(pointer, rows, np.diff(starts))
    return fronts, Entries(starts, pointer, rows, *_targets(pointer, rows, structure, fronts))


@Kernel
def _structures(
    pointer: IntArray, rows: IntArray, order: IntArray, supernodes: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Blocks beyond each supernode that it couples with, ascending, and the supernodes' parents."""
    n, count = order.size, supernodes.size - 1
    place, owner = np.empty(n, np.int64), np.empty(n, np.int64)
    place[order] = np.arange(n)
    for s in range(count):
        owner[supernodes[s] : supernodes[s + 1]] = s
    beyond_pointer, above = np.zeros(count + 1, np.int64), np.full(count, -1, np.int64)
    head, following = np.full(count, -1, np.int64), np.full(count, -1, np.int64)
    mark, found = np.full(n, -1, np.int64), np.empty(n, np.int64)
    beyond = np.empty(4 * n + 64, np.int64)
    total = 0
    for s in range(count):
        last, here = supernodes[s + 1], 0
        child = head[s]
        while child != -1:
            for t in range(beyond_pointer[child], beyond_pointer[child + 1]):
                i = beyond[t]
                if i >= last and mark[i] != s:
                    mark[i], found[here] = s, i
                    here += 1
            child = following[child]
        for j in range(supernodes[s], last):
            for p in range(pointer[order[j]], pointer[order[j] + 1]):
                i = place[rows[p]]
                if i >= last and mark[i] != s:
                    mark[i], found[here] = s, i
                    here += 1
        if total + here > beyond.size:
            grown = np.empty(2 * (total + here), np.int64)
            grown[:total] = beyond[:total]
            beyond = grown
        beyond[total : total + here] = np.sort(found[:here])
        if here:
            above[s] = owner[beyond[total]]
            following[s] = head[above[s]]
            head[above[s]] = s
        total += here
        beyond_pointer[s + 1] = total
    return beyond_pointer, beyond[:total].copy(), above


@Kernel
def _runs(structure: Structure, above: IntArray, begin: IntArray) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Runs of rows of each front that stay together in the parent: pointer, place, target, length."""
    count, blocks, places = above.size, structure.beyond, structure.places
    pointer = np.zeros(count + 1, np.int64)
    place, target = np.empty(blocks.size, np.int64), np.empty(blocks.size, np.int64)
    length = np.empty(blocks.size, np.int64)
    at = 0
    for s in range(count):
        p = above[s]
        row, position = structure.pointer[p], begin[p + 1] - begin[p]
        for t in range(structure.pointer[s], structure.pointer[s + 1]):
            first, size = places[blocks[t]], places[blocks[t] + 1] - places[blocks[t]]
            if first < begin[p + 1]:
                to = first - begin[p]
            else:
                while blocks[row] != blocks[t]:
                    position += places[blocks[row] + 1] - places[blocks[row]]
                    row += 1
                to = position
            last = at - 1
            if (
                at > pointer[s]
                and place[last] + length[last] == first
                and target[last] + length[last] == to
                and first != begin[p + 1]
            ):
                length[last] += size
            else:
                place[at], target[at], length[at] = first, to, size
                at += 1
        pointer[s + 1] = at
    return pointer, place[:at].copy(), target[:at].copy(), length[:at].copy()


@Kernel
def _targets(
    pointer: IntArray, rows: IntArray, structure: Structure, fronts: Fronts
) -> tuple[IntArray, IntArray, IntArray]:
    """Target, row step and column step of every pair of blocks."""
    order, places, supernodes = structure.order, structure.places, structure.supernodes
    n = order.size
    place = np.empty(n, np.int64)
    place[order] = np.arange(n)
    target, row_step = np.empty(rows.size, np.int64), np.empty(rows.size, np.int64)
    column_step, position = np.empty(rows.size, np.int64), np.empty(n, np.int64)
    for s in range(fronts.parent.size):
        first, last = supernodes[s], supernodes[s + 1]
        k, r = fronts.begin[s + 1] - fronts.begin[s], fronts.beyond[s]
        for j in range(first, last):
            position[j] = places[j] - places[first]
        at = k
        for t in range(structure.pointer[s], structure.pointer[s + 1]):
            i = structure.beyond[t]
            position[i] = at
            at += places[i + 1] - places[i]
        for j in range(first, last):
            for p in range(pointer[order[j]], pointer[order[j] + 1]):
                i = place[rows[p]]
                if i >= first:
                    target[p] = fronts.lower[s] + position[j] * (k + r) + position[i]
                    row_step[p], column_step[p] = 1, k + r
        for t in range(structure.pointer[s], structure.pointer[s + 1]):
            j = structure.beyond[t]
            for p in range(pointer[order[j]], pointer[order[j] + 1]):
                i = place[rows[p]]
                if first <= i < last:
                    target[p] = ~(fronts.upper[s] + position[i] * r + position[j] - k)
                    row_step[p], column_step[p] = r, 1
    return target, row_step, column_step
