"""Graph of the blocks of a matrix, and its elimination tree.

A block is a run of columns with the same rows: the unknowns of a node. All symbolic work is done on blocks.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.compiled import Kernel, allocate


@Kernel
def is_symmetric(indptr: AnyArray, indices: AnyArray) -> bool:
    """Whether sorted rows make a symmetric pattern with all of its diagonal."""
    n = indptr.size - 1
    after = indptr[1:].copy()
    for j in range(n):
        diagonal = False
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            if i < j:
                if after[i] == indptr[i + 1] or indices[after[i]] != j:
                    return False
                after[i] += 1
            elif i == j:
                diagonal = True
                after[j] = p + 1
        if not diagonal:
            return False
    return bool(np.all(after == indptr[1:]))


@Kernel
def blocks_of(indptr: AnyArray, indices: AnyArray) -> IntArray:
    """First columns of the runs of columns with equal rows, and the number of columns."""
    n = indptr.size - 1
    starts = np.empty(n + 1, np.int64)
    count = 0
    for j in range(n):
        begin, length = indptr[j], indptr[j + 1] - indptr[j]
        same = j > 0 and length == begin - indptr[j - 1]
        p = 0
        while same and p < length:
            same = indices[begin + p] == indices[begin - length + p]
            p += 1
        if not same:
            starts[count] = j
            count += 1
    starts[count] = n
    return starts[: count + 1].copy()


@Kernel
def block_graph(indptr: AnyArray, indices: AnyArray, starts: IntArray) -> tuple[IntArray, IntArray]:
    """Compressed columns of the blocks: rows of each, ascending, the diagonal included."""
    blocks = starts.size - 1
    block_at = np.full(starts[-1], -1, np.int64)
    for b in range(blocks):
        block_at[starts[b]] = b
    pointer = np.zeros(blocks + 1, np.int64)
    for b in range(blocks):
        count = 0
        for p in range(indptr[starts[b]], indptr[starts[b] + 1]):
            count += block_at[indices[p]] >= 0
        pointer[b + 1] = pointer[b] + count
    rows = np.empty(pointer[blocks], np.int64)
    at = 0
    for b in range(blocks):
        for p in range(indptr[starts[b]], indptr[starts[b] + 1]):
            row = block_at[indices[p]]
            if row >= 0:
                rows[at] = row
                at += 1
    return pointer, rows


@Kernel
def postordered_tree(pointer: IntArray, rows: IntArray) -> tuple[IntArray, IntArray]:
    """A postorder (order[new] = old) of the elimination tree, and the parents in it, -1 for roots.

    J. W. H. Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11, 1990.
    """
    n = pointer.size - 1
    parent, ancestor = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    for j in range(n):
        for p in range(pointer[j], pointer[j + 1]):
            i = rows[p]
            while i != -1 and i < j:
                after = ancestor[i]
                ancestor[i] = j
                if after == -1:
                    parent[i] = j
                i = after
    head, following = np.full(n + 1, -1, np.int64), np.full(n, -1, np.int64)
    for j in range(n - 1, -1, -1):
        above = parent[j] if parent[j] >= 0 else n
        following[j] = head[above]
        head[above] = j
    order, place, stack = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64)
    count, root = 0, head[n]
    while root != -1:
        top = 0
        stack[0] = root
        while top >= 0:
            j = stack[top]
            child = head[j]
            if child == -1:
                order[count], place[j] = j, count
                count += 1
                top -= 1
            else:
                head[j] = following[child]
                top += 1
                stack[top] = child
        root = following[root]
    renamed = np.empty(n, np.int64)
    for j in range(n):
        above = parent[order[j]]
        renamed[j] = place[above] if above >= 0 else -1
    return order, renamed


@Kernel
def supernodes_of(
    pointer: IntArray, rows: IntArray, order: IntArray, parent: IntArray, weight: IntArray, waste: float, narrow: int
) -> IntArray:
    """First blocks of the supernodes, and the number of blocks: blocks that are eliminated together.

    A supernode joins the one after it where that is its parent and the zeros stored for it are at most `waste` of the
    pivot columns, or where both together have at most `narrow` columns.

    Parameters
    ----------
    pointer, rows : ndarray
        Graph of the blocks in the given order.
    order, parent : ndarray, shape (blocks,)
        Postorder, and the tree in it.
    weight : ndarray, shape (blocks,)
        Unknowns of the blocks in postorder.
    """
    n = parent.size
    place = np.empty(n, np.int64)
    place[order] = np.arange(n)
    height = _column_heights(pointer, rows, order, place, parent, weight)
    children = np.zeros(n, np.int64)
    for j in range(n):
        if parent[j] >= 0:
            children[parent[j]] += 1
    starts, width = np.empty(n + 1, np.int64), np.zeros(n, np.int64)
    count = 0
    for j in range(n):
        follows = j > 0 and parent[j - 1] == j and children[j] == 1 and height[j - 1] == height[j] + weight[j - 1]
        if not follows:
            starts[count] = j
            count += 1
        width[count - 1] += weight[j]
    starts[count] = n
    size, zeros, joined = np.empty(n, np.int64), np.zeros(n), 0
    for s in range(count):
        first, columns, rows_here = starts[s], width[s], height[starts[s]]
        before = joined - 1
        if s > 0 and parent[first - 1] == first:
            added = zeros[before] + width[before] * (rows_here - size[before] + width[before])
            both = columns + width[before]
            if both <= narrow or added <= waste * both * (width[before] + rows_here):
                size[before], zeros[before], width[before] = width[before] + rows_here, added, both
                continue
        starts[joined], width[joined], size[joined], zeros[joined] = first, columns, rows_here, 0.0
        joined += 1
    starts[joined] = n
    return starts[: joined + 1].copy()


@allocate
def _column_heights(
    pointer: IntArray, rows: IntArray, order: IntArray, place: IntArray, parent: IntArray, weight: IntArray
) -> IntArray:
    """Unknowns in the column of each block of the factor, the block's own included."""
    n = parent.size
    height, mark = weight.copy(), np.full(n, -1, np.int64)
    for i in range(n):
        mark[i] = i
        for p in range(pointer[order[i]], pointer[order[i] + 1]):
            j = place[rows[p]]
            while j < i and mark[j] != i:
                mark[j] = i
                height[j] += weight[i]
                j = parent[j]
    return height
