"""Graph of the blocks of a matrix, and its elimination tree.

A block is a run of columns with the same rows: the unknowns of a node. All symbolic work is done on blocks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, IntArray
from magshell.compiled import Kernel


def block_graph(indptr: AnyArray, indices: AnyArray) -> tuple[IntArray, IntArray, IntArray]:
    """First columns of the blocks and the number of columns; rows of each block, compressed columns, ascending.

    Raises
    ------
    ValueError
        The pattern is not symmetric, or lacks entries of the diagonal.
    """
    first = np.ones(indptr.size - 1, dtype=bool)
    _mark_equal_columns(indptr, indices, first)
    starts = np.append(np.flatnonzero(first), first.size)
    widths, lengths = np.diff(starts), np.diff(indptr)[starts[:-1]]
    entries = indices[ranges(indptr[starts[:-1]], lengths)]
    leading = np.flatnonzero(first[entries])
    rows = np.repeat(np.arange(widths.size), widths)[entries[leading]]
    pointer = np.searchsorted(leading, np.append(0, np.cumsum(lengths)))
    of_whole_blocks = np.array_equal(entries, ranges(starts[rows], widths[rows]))
    if not (of_whole_blocks and _is_symmetric(pointer, rows)):
        raise ValueError("the pattern of the matrix must be symmetric, with all of its diagonal")
    return starts, pointer, rows


def ranges(starts: IntArray, lengths: IntArray) -> IntArray:
    """All numbers of consecutive ranges."""
    numbers = np.arange(lengths.sum())
    numbers += np.repeat(starts - np.cumsum(lengths) + lengths, lengths)
    return numbers


def _is_symmetric(pointer: IntArray, rows: IntArray) -> bool:
    """Whether sorted rows make a symmetric pattern with all of its diagonal."""
    n = pointer.size - 1
    mirrored = sp.csc_array((np.ones(rows.size, dtype=np.int8), rows, pointer), shape=(n, n)).tocsr()
    on_diagonal = np.count_nonzero(rows == np.repeat(np.arange(n), np.diff(pointer)))
    return on_diagonal == n and np.array_equal(mirrored.indptr, pointer) and np.array_equal(mirrored.indices, rows)


@Kernel
def _mark_equal_columns(indptr: AnyArray, indices: AnyArray, first: AnyArray) -> None:
    """False for columns with the same rows as the one before."""
    for j in range(1, first.size):
        begin, end = indptr[j], indptr[j + 1]
        length = end - begin
        if length == begin - indptr[j - 1]:
            p = begin
            while p < end and indices[p] == indices[p - length]:
                p += 1
            first[j] = p < end


class Tree(NamedTuple):
    """Elimination tree of a graph of blocks, in a postorder.

    Attributes
    ----------
    order : ndarray, shape (blocks,)
        The postorder (order[new] = old): children before their parents, in the order of the graph.
    parent : ndarray, shape (blocks,)
        The number of blocks for roots.
    unknowns, blocks : ndarray, shape (blocks,)
        In the column of each block of the factor, the block itself included.
    """

    order: IntArray
    parent: IntArray
    unknowns: IntArray
    blocks: IntArray


def elimination_tree(pointer: IntArray, rows: IntArray, widths: IntArray) -> Tree:
    """Tree of a symmetric graph of blocks of so many unknowns, and the sizes of the factor's columns.

    Row i of the factor has an entry in each column from which a path of parents leads to i, beginning at the entries of
    row i of the matrix; the parent of a column is its first entry below the diagonal.
    J. W. H. Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11, 1990.
    T. A. Davis, Algorithm 849: a concise sparse Cholesky factorization package, ACM Trans. Math. Softw. 31, 2005.
    """
    n = widths.size
    parent, mark = np.full(n, n), np.full(n, -1)
    unknowns, blocks = widths.copy(), np.ones(n, dtype=np.int64)
    _walk_rows(pointer, rows, widths, mark, parent, unknowns, blocks)
    place, below, last = np.empty(n + 1, np.int64), np.ones(n + 1, np.int64), np.full(n + 1, n - 1)
    place[n] = n
    _place_in_postorder(parent, below, last, place)
    order = np.empty(n, np.int64)
    order[place[:n]] = np.arange(n)
    return Tree(order, place[parent[order]], unknowns[order], blocks[order])


@Kernel
def _walk_rows(
    pointer: IntArray,
    rows: IntArray,
    widths: IntArray,
    mark: IntArray,
    parent: IntArray,
    unknowns: IntArray,
    blocks: IntArray,
) -> None:
    """Find parents, and add each row of the factor to the sizes of its columns."""
    for i in range(widths.size):
        for p in range(pointer[i], pointer[i + 1]):
            j = rows[p]
            while j < i and mark[j] != i:
                mark[j] = i
                unknowns[j] += widths[i]
                blocks[j] += 1
                parent[j] = min(parent[j], i)
                j = parent[j]


@Kernel
def _place_in_postorder(parent: IntArray, below: IntArray, last: IntArray, place: IntArray) -> None:
    """A subtree takes the last places that are left in its parent's, its root the last of them.

    `below` starts as one block in each subtree, `last` as the last place.
    """
    for j in range(parent.size):
        below[parent[j]] += below[j]
    for j in range(parent.size - 1, -1, -1):
        above = parent[j]
        place[j] = last[above]
        last[j] = last[above] - 1
        last[above] -= below[j]


def supernodes_of(tree: Tree, widths: IntArray, waste: float, narrow: int) -> IntArray:
    """First blocks of the supernodes, and the number of blocks: blocks that are eliminated together.

    Blocks whose columns of the factor are the same are together. Such a supernode joins the one after it where that is
    its parent and the zeros stored for it are at most `waste` of the pivot columns, or where both together have at most
    `narrow` columns.

    Parameters
    ----------
    tree : Tree
    widths : ndarray, shape (blocks,)
        Unknowns of the blocks in postorder.
    """
    n = widths.size
    is_child = tree.parent[:-1] == np.arange(1, n)
    alone = np.bincount(tree.parent, minlength=n)[1:n] == 1
    follows = is_child & alone & (tree.unknowns[:-1] == tree.unknowns[1:] + widths[:-1])
    starts = np.append(np.flatnonzero(np.append(True, ~follows)), n)
    widths = np.add.reduceat(widths, starts[:-1])
    may_join = np.append(False, is_child)[starts[:-1]]
    joined, width, size, zeros = [], 0, 0, 0.0
    for start, may, own, rows in zip(
        *(values.tolist() for values in (starts[:-1], may_join, widths, tree.unknowns[starts[:-1]])), strict=True
    ):
        added, both = zeros + width * (rows - size + width), own + width
        if may and (both <= narrow or added <= waste * both * (width + rows)):
            width, size, zeros = both, width + rows, added
        else:
            joined.append(start)
            width, size, zeros = own, rows, 0.0
    return np.array([*joined, n])
