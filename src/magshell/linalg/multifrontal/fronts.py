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
from magshell.linalg.multifrontal.tree import Tree, block_graph, elimination_tree, ranges, supernodes_of

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
    """Blocks of the fronts, numbered in postorder.

    Attributes
    ----------
    order : ndarray, shape (blocks,)
        The postorder.
    places : ndarray, shape (blocks + 1,)
        First unknown of each block in the elimination order.
    supernodes : ndarray, shape (fronts + 1,)
        First block of each front.
    pointer : ndarray, shape (fronts + 1,)
    beyond : ndarray
        Blocks below the pivot block of each front, ascending.
    """

    order: IntArray
    places: IntArray
    supernodes: IntArray
    pointer: IntArray
    beyond: IntArray

    @property
    def owner(self) -> IntArray:
        """Front of which a block's unknowns are pivots, (blocks,)."""
        return np.repeat(np.arange(self.supernodes.size - 1), np.diff(self.supernodes))

    def position(self, front: IntArray, block: IntArray) -> IntArray:
        """First row of blocks in fronts that they are in; arrays of the same shape."""
        places, first = self.places, self.supernodes[front]
        size = np.diff(places)[self.beyond]
        above = np.cumsum(size) - size
        n, count = self.order.size, self.supernodes.size - 1
        keys = np.repeat(np.arange(count), np.diff(self.pointer)) * n + self.beyond
        position = places[block] - places[first]
        last = self.supernodes[front + 1]
        outside = np.flatnonzero(block >= last)
        front, block = front[outside], block[outside]
        row = above[np.searchsorted(keys, front * n + block)] - above[self.pointer[front]]
        position[outside] = places[last[outside]] - places[first[outside]] + row
        return np.asarray(position)


def fronts_of(pointer: IntArray, rows: IntArray, widths: IntArray) -> tuple[Fronts, Structure]:
    """Fronts of a graph of blocks (symmetric, compressed columns, in a fill-reducing order) of so many unknowns."""
    tree = elimination_tree(pointer, rows, widths)
    weight = widths[tree.order]
    structure, parent = _structure_of(pointer, rows, tree, weight)
    places, beyond = structure.places, structure.beyond
    begin = places[structure.supernodes]
    sizes = np.append(0, np.cumsum(weight[beyond]))
    r, k = np.diff(sizes[structure.pointer]), np.diff(begin)
    fronts = Fronts(
        order=ranges((np.cumsum(widths) - widths)[tree.order], weight),
        begin=begin,
        beyond=r,
        parent=parent,
        lower=np.append(0, np.cumsum((k + r) * k)),
        upper=np.append(0, np.cumsum(r * k)),
        **_runs(structure, parent),
    )
    return fronts, structure


def analyse(indptr: AnyArray, indices: AnyArray) -> tuple[Fronts, Entries]:
    """Fronts of a matrix of symmetric pattern with sorted rows, its columns in a fill-reducing order.

    Raises
    ------
    ValueError
        The pattern is not symmetric, or lacks entries of the diagonal.
    """
    starts, pointer, rows = block_graph(indptr, indices)
    fronts, structure = fronts_of(pointer, rows, np.diff(starts))
    return fronts, Entries(starts, pointer, rows, *_targets(pointer, rows, structure, fronts))


def _structure_of(pointer: IntArray, rows: IntArray, tree: Tree, weight: IntArray) -> tuple[Structure, IntArray]:
    """Supernodes with the blocks beyond them, and their parents."""
    supernodes = supernodes_of(tree, weight, WASTE, NARROW)
    count, last = supernodes.size - 1, supernodes[1:] - 1
    beyond_pointer = np.append(0, np.cumsum(tree.blocks[last] - 1))
    structure = Structure(
        tree.order, np.append(0, np.cumsum(weight)), supernodes, beyond_pointer, np.empty(beyond_pointer[-1], np.int64)
    )
    parent = np.append(structure.owner, -1)[tree.parent[last]]
    owner = np.empty_like(tree.order)
    owner[tree.order] = structure.owner
    _fill_rows(
        pointer, rows, tree.order, owner, parent, np.full(count, -1), beyond_pointer[:-1].copy(), structure.beyond
    )
    return structure, parent


@Kernel
def _fill_rows(
    pointer: IntArray,
    rows: IntArray,
    order: IntArray,
    owner: IntArray,
    parent: IntArray,
    mark: IntArray,
    end: IntArray,
    beyond: IntArray,
) -> None:
    """Append each row of the factor to the supernodes that have entries in it (see `elimination_tree`)."""
    for i in range(order.size):
        j = order[i]
        for p in range(pointer[j], pointer[j + 1]):
            s = owner[rows[p]]
            while s < owner[j] and mark[s] != i:
                mark[s] = i
                beyond[end[s]] = i
                end[s] += 1
                s = parent[s]


def _runs(structure: Structure, parent: IntArray) -> dict[str, IntArray]:
    """Runs of rows of each front that stay together in the parent."""
    blocks, places = structure.beyond, structure.places
    front = np.repeat(np.arange(parent.size), np.diff(structure.pointer))
    target = structure.position(parent[front], blocks)
    place, length = places[blocks], np.diff(places)[blocks]
    pivots_end = places[structure.supernodes[parent[front] + 1]]
    goes_on = (
        (front[1:] == front[:-1])
        & (np.diff(place) == length[:-1])
        & (np.diff(target) == length[:-1])
        & (place[1:] != pivots_end[1:])
    )
    starts = np.flatnonzero(np.append(True, ~goes_on)[: front.size])
    return {
        "run_pointer": np.searchsorted(front[starts], np.arange(parent.size + 1)),
        "run_place": place[starts],
        "run_target": target[starts],
        "run_length": np.add.reduceat(length, starts),
    }


def _targets(
    pointer: IntArray, rows: IntArray, structure: Structure, fronts: Fronts
) -> tuple[IntArray, IntArray, IntArray]:
    """Target, row step and column step of every pair of blocks."""
    place = np.empty_like(structure.order)
    place[structure.order] = np.arange(place.size)
    row, column = place[rows], np.repeat(place, np.diff(pointer))
    owner = structure.owner
    front = np.minimum(owner[row], owner[column])
    i, j = structure.position(front, row), structure.position(front, column)
    k, r = fronts.pivots[front], fronts.beyond[front]
    upper = j >= k
    target = np.where(upper, ~(fronts.upper[front] + i * r + j - k), fronts.lower[front] + j * (k + r) + i)
    return target, np.where(upper, r, 1), np.where(upper, 1, k + r)
