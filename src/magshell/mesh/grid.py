"""The regular pattern of 8-node quadrilaterals that every generator bends into shape."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import find_edges


class Grid(NamedTuple):
    """Nodes and elements of the unit square."""

    parameters: FloatArray
    """(nodes, 2): s and t, both 0 to 1."""
    elements: IntArray
    """(elements, 8): numbered with s running faster, counter-clockwise from s to t."""

    def sides(self, where: Mapping[str, tuple[int, float]]) -> dict[str, IntArray]:
        """Boundary edges (k, 3) by name; `where` has the parameter, 0 for s or 1 for t, and its value."""
        edges = find_edges(self.elements)
        free = edges.sides[edges.boundary]
        return {name: free[(self.parameters[free, axis] == value).all(axis=1)] for name, (axis, value) in where.items()}


def grid(along_s: int, along_t: int, closed: int | None = None) -> Grid:
    """`along_s` times `along_t` elements; `closed`, 0 for s or 1 for t, joins that end to its start."""
    shape = (2 * along_s + 1, 2 * along_t + 1)
    steps = np.stack(np.meshgrid(*(np.arange(n) for n in shape), indexing="ij"), axis=-1)
    used = ~(steps % 2 == 1).all(axis=-1)
    if closed is not None:
        used[(slice(None),) * closed + (-1,)] = False
    numbers = np.full(shape, -1)
    numbers.T[used.T] = np.arange(used.sum())
    if closed == 0:
        numbers[-1] = numbers[0]
    elif closed == 1:
        numbers[:, -1] = numbers[:, 0]
    offsets = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = np.stack(
        [numbers[i : i + 2 * along_s - 1 : 2, j : j + 2 * along_t - 1 : 2].T.ravel() for i, j in offsets],
        axis=1,
    )
    parameters = steps.transpose(1, 0, 2)[used.T] / (2 * np.array([along_s, along_t]))
    return Grid(parameters, elements)
