"""Loops that put matrices of elements into their places in the tangent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Kernel


class Elements(NamedTuple):
    """Elements of one kind: their nodes, and what their values are.

    Attributes
    ----------
    nodes : ndarray, shape (elements, m)
    node, component : ndarray, shape (values,)
        Node of the element and column of the nodal arrays of each value; components of a vector are all there.
    """

    nodes: IntArray
    node: IntArray
    component: IntArray


class Destination(NamedTuple):
    """Where the values of elements go.

    Attributes
    ----------
    elements : Elements
    slot : ndarray, shape (values,)
        Place of the element at which each value is: its nodes, and once more its nodes where unknowns of one node are
        at several places (on rigid bodies, beyond a jump).
    entry : ndarray, shape (elements, values)
        Node and column of each value, as places of flat nodal arrays.
    number, rank : ndarray, shape (nodes, 11)
    indptr : ndarray, shape (equations + 1,)
    offset : ndarray, shape (elements, slots, slots)
        Of the first row of slot I in the columns of slot J, at [e, J, I].
    """

    elements: Elements
    slot: IntArray
    entry: IntArray
    number: IntArray
    rank: IntArray
    indptr: IntArray
    offset: IntArray


@Kernel
def turn_matrices(to: Destination, first: int, K: FloatArray, frame_of: IntArray, frames: FloatArray) -> None:
    """Turn transposed matrices K (range, values, values) of elements from `first` on into the nodes' frames.

    Rows and columns of a vector lie apart from each other by the number of nodes that carry it.
    """
    node, component = to.elements.node, to.elements.component
    values = len(node)
    for e in range(first, min(first + len(K), len(to.elements.nodes))):
        for l in range(values):
            c = component[l]
            if c != 0 and c != 3 and c != 7:
                continue
            stride = 0
            for k in range(values):
                stride += component[k] == c
            frame = frame_of[to.elements.nodes[e, node[l]], 0 if c == 0 else 1 if c == 3 else 2]
            if frame < 0:
                continue
            matrix = K[e - first]
            for side in range(2):
                for j in range(values):
                    a0, a1, a2 = matrix[l, j], matrix[l + stride, j], matrix[l + 2 * stride, j]
                    if side == 1:
                        a0, a1, a2 = matrix[j, l], matrix[j, l + stride], matrix[j, l + 2 * stride]
                    for i in range(3):
                        turned = frames[frame, i, 0] * a0 + frames[frame, i, 1] * a1 + frames[frame, i, 2] * a2
                        if side == 0:
                            matrix[l + i * stride, j] = turned
                        else:
                            matrix[j, l + i * stride] = turned


@Kernel
def add_matrices(to: Destination, first: int, K: FloatArray, weight: float, data: FloatArray) -> None:
    """Add transposed matrices K (range, values, values) of elements from `first` on to the tangent's values.

    The rows of one place lie side by side in a column.
    """
    node, component = to.elements.node, to.elements.component
    values, m = len(node), to.offset.shape[1]
    free, rank = np.zeros(values, dtype=np.int64), np.zeros(values, dtype=np.int64)
    place = np.zeros((m, values), dtype=np.int64)
    for e in range(first, min(first + len(K), len(to.elements.nodes))):
        nodes, count = to.elements.nodes[e], 0
        for l in range(values):
            if to.number[nodes[node[l]], component[l]] >= 0:
                free[count], rank[count] = l, to.rank[nodes[node[l]], component[l]]
                count += 1
        for J in range(m):
            for k in range(count):
                place[J, k] = to.offset[e, J, to.slot[free[k]]] + rank[k]
        for f in range(count):
            l = free[f]
            row, places = K[e - first, l], place[to.slot[l]]
            start = to.indptr[to.number[nodes[node[l]], component[l]]]
            column = data[start:]
            if free[count - 1] == count - 1:  # the first values, all of them
                for k in range(count):
                    column[places[k]] += weight * row[k]
            else:
                for k in range(count):
                    column[places[k]] += weight * row[free[k]]
