"""A field interpolated by quintic splines on a lattice, so that its values cost the same for any number of sources.

The lattice is fixed in the frame of the sources. Blocks of `CELLS`³ cells are sampled when a point in them is first
asked for, and each block depends on the field alone: values do not depend on what was asked before. On a block the
field is

    B(y) = Σ c_ijk β(y1/h − i) β(y2/h − j) β(y3/h − k),    c = (1 − δ²/4 + 13 δ⁴/240) B along each axis,

with the quintic B-spline β, spacing h and central differences δ². Polynomials of fifth degree are reproduced, so the
errors of B, its gradient and second derivatives fall as h⁶, h⁵ and h⁴. B is continuous with its fourth derivatives, and
gradients are those of the interpolated B.
"""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Kernel
from magshell.magnetics.fields.field import Values

CELLS = 8
SUPPORT = 6
"""Coefficients along an axis that a point sees."""
MARGIN = 2
"""Samples on either side of a coefficient that it is made of."""
BEFORE = 2
"""Coefficients before the first of a cell."""
FILTER = np.array([13.0 / 240.0, -0.25 - 4.0 * 13.0 / 240.0, 1.5 + 6.0 * 13.0 / 240.0, 0.0, 0.0])
FILTER[3:] = FILTER[1::-1]
PIECES = np.array(
    [
        [
            sum((-1) ** j * comb(6, j) * comb(5, power) * (5 - k - j) ** (5 - power) for j in range(6 - k)) / 120.0
            for power in range(6)
        ]
        for k in range(6)
    ]
)
"""β(t + 2 − k), for t in [0, 1], as Σ PIECES[k, power] t**power."""
NEAREST = 8
"""Least distance, in spacings, from a singularity of the field (a surface, a wire): nearer, the error of the gradient
is more than some 1e-4 of it."""
MOST_BLOCKS = 2000
FARTHEST = 1e6
"""Of a point from the origin, in spacings."""


class Lattice:
    """The interpolation of a function from points (n, 3) to B (n, 3), with a spacing, m."""

    def __init__(self, function: Callable[[FloatArray], FloatArray], spacing: float) -> None:
        self._function, self._spacing = function, spacing
        self._blocks: dict[tuple[int, ...], FloatArray] = {}

    def values(self, points: FloatArray, second: bool) -> Values:
        """B with its derivatives at points (n, 3)."""
        h = self._spacing
        places = points / h
        blocks = np.floor(np.clip(places, -FARTHEST, FARTHEST) / CELLS).astype(np.int64)
        order = np.lexsort(blocks.T)
        starts = np.flatnonzero(np.any(np.diff(blocks[order], axis=0, prepend=blocks[order[:1]] - 1) != 0, axis=1))
        out = np.zeros((len(points), 10, 3))
        for members in np.split(order, starts[1:]) if len(points) else ():
            block = blocks[members[0]]
            _evaluate(self._coefficients(block), places, block * CELLS, members, out)
        B, gradient = out[:, 0], out[:, 1:4].transpose(0, 2, 1) / h
        return Values(B, gradient, _filled(out[:, 4:]) / h**2 if second else None)

    def _coefficients(self, block: IntArray) -> FloatArray:
        """Those (CELLS + 5, CELLS + 5, CELLS + 5, 3) that points of a block see."""
        key = tuple(block.tolist())
        if key not in self._blocks:
            if len(self._blocks) >= MOST_BLOCKS:
                self._blocks.clear()
            numbers = np.arange(-BEFORE - MARGIN, CELLS + SUPPORT - BEFORE - 1 + MARGIN)
            axes = [self._spacing * (CELLS * start + numbers) for start in block]
            grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
            values = self._function(grid.reshape(-1, 3)).reshape(grid.shape)
            for axis in range(3):
                count = values.shape[axis] - 2 * MARGIN
                values = sum(
                    weight * values.take(np.arange(k, k + count), axis=axis) for k, weight in enumerate(FILTER)
                )
            self._blocks[key] = np.ascontiguousarray(values)
        return self._blocks[key]


def _filled(six: FloatArray) -> FloatArray:
    """∂²B_i/∂x_j∂x_k (n, 3, 3, 3) of the derivatives (n, 6, 3) by 11, 12, 13, 22, 23, 33."""
    place = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
    return np.moveaxis(six[:, place], 3, 1)


@Kernel
def _evaluate(
    coefficients: FloatArray, places: FloatArray, first: IntArray, members: IntArray, out: FloatArray
) -> None:
    """B and its derivatives by places, in lattice units: 1; 1, 2, 3; 11, 12, 13, 22, 23, 33 into out (n, 10, 3)."""
    weights = np.empty((3, 3, 6))
    along = np.empty((3, 3))
    across = np.empty((6, 3))
    for p in members:
        start = np.empty(3, dtype=np.int64)
        for axis in range(3):
            cell = min(max(int(np.floor(places[p, axis])) - first[axis], 0), coefficients.shape[axis] - 6)
            start[axis] = cell
            t = places[p, axis] - first[axis] - cell
            for k in range(6):
                value, slope, bend = PIECES[k, 5], 0.0, 0.0
                for power in range(4, -1, -1):
                    bend = bend * t + 2.0 * slope
                    slope = slope * t + value
                    value = value * t + PIECES[k, power]
                weights[axis, 0, k] = value
                weights[axis, 1, k] = slope
                weights[axis, 2, k] = bend
        for i in range(6):
            across[:] = 0.0
            for j in range(6):
                along[:] = 0.0
                for k in range(6):
                    for c in range(3):
                        value = coefficients[start[0] + i, start[1] + j, start[2] + k, c]
                        along[0, c] += weights[2, 0, k] * value
                        along[1, c] += weights[2, 1, k] * value
                        along[2, c] += weights[2, 2, k] * value
                for c in range(3):
                    across[0, c] += weights[1, 0, j] * along[0, c]
                    across[1, c] += weights[1, 0, j] * along[1, c]
                    across[2, c] += weights[1, 1, j] * along[0, c]
                    across[3, c] += weights[1, 0, j] * along[2, c]
                    across[4, c] += weights[1, 1, j] * along[1, c]
                    across[5, c] += weights[1, 2, j] * along[0, c]
            w, d, dd = weights[0, 0, i], weights[0, 1, i], weights[0, 2, i]
            for c in range(3):
                out[p, 0, c] += w * across[0, c]
                out[p, 1, c] += d * across[0, c]
                out[p, 2, c] += w * across[2, c]
                out[p, 3, c] += w * across[1, c]
                out[p, 4, c] += dd * across[0, c]
                out[p, 5, c] += d * across[2, c]
                out[p, 6, c] += d * across[1, c]
                out[p, 7, c] += w * across[5, c]
                out[p, 8, c] += w * across[4, c]
                out[p, 9, c] += w * across[3, c]
