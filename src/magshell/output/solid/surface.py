"""The closed surface of a body, as small flat triangles whose corners are shared.

Both faces of every element are cut into a regular lattice. Points on an edge are those of the edge, so that neighbours
have the same; where one is upside down, its lower face goes on in the upper one of the other. Where an edge has one
element, a wall joins its two faces; where it has two of different thickness, risers join their faces. At its ends a
wall or riser has all the levels that lie between its corners there, so that it fits whatever else meets on that
director.

Flat pieces cut curves short. So the thickness is changed by as much as makes the volume that of the body, by less than
`CLOSE`: the points then are off the faces by less than the middles of the pieces are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.output.joints import sides_of
from magshell.output.solid.slab import LOWER, UPPER, Slab, volume
from magshell.output.tessellation import Lattice, Tessellation
from magshell.shell import triangle

QUAD_SIDES = np.array([[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]])
TRIANGLE_SIDES = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]])
# Relative error of the volume that flat pieces may make, and the triangles that this may take.
CLOSE, MOST_TRIANGLES = 2e-4, 500_000
# Changes of the thickness: each leaves a small part of the error.
CHANGES = 4


class Surface(NamedTuple):
    """Triangles, counter-clockwise seen from outside.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        m; those that triangles share are there once.
    triangles : ndarray, shape (m, 3)
    """

    points: FloatArray
    triangles: IntArray

    @property
    def volume(self) -> float:
        """Enclosed, m³."""
        a, b, c = np.moveaxis((self.points - self.points.mean(axis=0))[self.triangles], 1, 0)
        return float(np.einsum("nx,nx->", a, np.cross(b, c))) / 6.0


def closed_surface(body: Slab) -> Surface:
    """The surface, as coarse as `CLOSE` and `MOST_TRIANGLES` allow, with the volume of the body."""
    exact, pieces, factor = volume(body), 1, 1.0
    most = max(1, int(math.sqrt(MOST_TRIANGLES / (4.0 * len(body.elements)))))
    made = surface(body, pieces)
    while (error := abs(made.volume / exact - 1.0)) > CLOSE and pieces < most:
        pieces = min(most, max(pieces + 1, math.ceil(pieces * math.sqrt(error / CLOSE))))
        made = surface(body, pieces)
    for _ in range(CHANGES):
        factor *= exact / made.volume
        made = surface(body.thickened(factor), pieces)
    return made


def surface(body: Slab, pieces: int) -> Surface:
    """The surface with each side of an element cut into so many pieces."""
    lattices = Lattices(body, pieces)
    used, triangles = lattices.triangles()
    return Surface(lattices.points[used], triangles)


class Lattices:
    """Points of the lattices of both faces, shared along edges: levels of the nodes first, then edges, then insides.

    Attributes
    ----------
    lattices : list of Lattice
        Of the quadrilaterals and of the triangles, if there are any.
    numbers : list of ndarray, shape (2, elements, lattice points)
        For each, the points of the lower and of the upper faces.
    points : ndarray, shape (n, 3)
        m.
    """

    def __init__(self, body: Slab, pieces: int) -> None:
        self.body, self.pieces = body, pieces
        self.lattices = Tessellation(body.elements, pieces).lattices
        self.numbers = [np.full((2, len(one.elements), len(one.N)), -1) for one in self.lattices]
        self._sides = [_sides(one, pieces) for one in self.lattices]
        inner = [body.levels, self._number_edges()]
        first = sum(map(len, inner))
        for lattice, numbers in zip(self.lattices, self.numbers, strict=True):
            for side in (LOWER, UPPER):
                free = numbers[side, 0] < 0
                count = len(numbers[side]), int(free.sum())
                numbers[side][:, free] = first + np.arange(count[0] * count[1]).reshape(count)
                positions = body.levels[self.levels(lattice)[side]]
                inner.append(np.einsum("mn,enx->emx", lattice.N[free], positions).reshape(-1, 3))
                first += len(inner[-1])
        self.points = np.concatenate(inner)

    def _number_edges(self) -> FloatArray:
        """Number corners and the points between them; positions of the latter (n, 3).

        A curve is known by the levels of its ends and its middle.
        """
        triples, where = [], []
        for lattice, numbers, (corners, sides) in zip(self.lattices, self.numbers, self._sides, strict=True):
            levels = self.levels(lattice)
            numbers[:, :, corners] = levels[:, :, : len(corners)]
            ends = TRIANGLE_SIDES if len(corners) == 3 else QUAD_SIDES
            for side, along in zip(ends, sides, strict=True):
                triples.append(levels[:, :, side].reshape(-1, 3))
                where.append((numbers, along[1:-1]))
        every = np.concatenate(triples)
        turned = every[:, 0] > every[:, 1]
        every[turned, :2] = every[turned, 1::-1]
        curves, curve_of = np.unique(every, axis=0, return_inverse=True)
        between = np.arange(1, self.pieces)
        number = len(self.body.levels) + curve_of.ravel()[:, None] * len(between) + between - 1
        number[turned] = number[turned, ::-1]
        first = 0
        for numbers, along in where:
            count = numbers.shape[0] * numbers.shape[1]
            numbers[:, :, along] = number[first : first + count].reshape(*numbers.shape[:2], -1)
            first += count
        t = 2.0 * between / self.pieces - 1.0
        functions = np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2], axis=1)
        return np.asarray(np.einsum("mn,cnx->cmx", functions, self.body.levels[curves]).reshape(-1, 3))

    def levels(self, lattice: Lattice) -> IntArray:
        """Levels (2, n, nodes) of the elements of a lattice, in its order of nodes."""
        at = self.body.at[:, lattice.elements]
        return np.asarray(at[:, :, triangle.SLOTS] if lattice.nodes.shape[1] == len(triangle.SLOTS) else at)

    def triangles(self) -> tuple[IntArray, IntArray]:
        """Points that the surface has, and its triangles (n, 3), which number these."""
        used, triangles = np.unique(np.concatenate([*self._faces(), _strips(*self._walls())]), return_inverse=True)
        return used, triangles.reshape(-1, 3)

    def _faces(self) -> Iterator[IntArray]:
        """Triangles of the faces."""
        for lattice, numbers in zip(self.lattices, self.numbers, strict=True):
            yield numbers[LOWER][:, lattice.pieces[:, ::-1]].reshape(-1, 3)
            yield numbers[UPPER][:, lattice.pieces].reshape(-1, 3)

    def _walls(self) -> tuple[IntArray, IntArray]:
        """Pairs of curves (n, pieces + 1) that walls and risers join, points by number; the outside is on the right."""
        sides = sides_of(self.body.elements)
        place_of = np.full(4 * len(self.body.elements), -1)
        place_of[sides.numbers] = np.arange(len(sides.numbers))
        where, low, high = [], [], []
        for lattice, numbers, (corners, curves) in zip(self.lattices, self.numbers, self._sides, strict=True):
            places = (0, 1, 3) if len(corners) == 3 else (0, 1, 2, 3)
            for place, along in zip(places, curves, strict=True):
                where.append(place_of[4 * lattice.elements + place])
                low.append(numbers[LOWER][:, along])
                high.append(numbers[UPPER][:, along])
        order = np.argsort(np.concatenate(where))
        lower, upper = (np.concatenate(each)[order] for each in (low, high))
        alone, one = sides.partners < 0, np.flatnonzero(sides.partners > np.arange(len(sides.partners)))
        other, against = sides.partners[one], sides.against[one, None]
        beneath = np.where(against, upper[other], lower[other][:, ::-1])
        over = np.where(against, lower[other], upper[other][:, ::-1])
        risen, sunk = (np.any(mine != theirs, axis=1) for mine, theirs in ((upper[one], over), (lower[one], beneath)))
        below = [lower[alone], over[risen], lower[one[sunk]]]
        above = [upper[alone], upper[one[risen]], beneath[sunk]]
        return np.concatenate(below), np.concatenate(above)


def _sides(lattice: Lattice, pieces: int) -> tuple[IntArray, IntArray]:
    """Corners of a lattice, and its points along each side (sides, pieces + 1), counter-clockwise."""
    if lattice.nodes.shape[1] == 8:
        number = np.arange((pieces + 1) ** 2).reshape(pieces + 1, pieces + 1)
        sides = np.array([number[0], number[:, -1], number[-1, ::-1], number[::-1, 0]])
    else:
        first = np.cumsum([0, *range(pieces + 1, 0, -1)])[:-1]
        last = first + np.arange(pieces, -1, -1)
        sides = np.array([np.arange(pieces + 1), last, first[::-1]])
    return sides[:, 0], sides


def _strips(lower: IntArray, upper: IntArray) -> IntArray:
    """Triangles (n, 3) between pairs of curves; at their ends, levels of one node have consecutive numbers."""
    plain = np.all(np.abs(upper - lower)[:, [0, -1]] == 1, axis=1)
    a, b, c, d = lower[plain, :-1], lower[plain, 1:], upper[plain, 1:], upper[plain, :-1]
    parts = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    for low, high in zip(lower[~plain], upper[~plain], strict=True):
        columns = [[int(one), int(two)] for one, two in zip(low, high, strict=True)]
        columns[0], columns[-1] = _column(*columns[0]), _column(*columns[-1])
        parts += [_between(left, right) for left, right in pairwise(columns)]
    return np.concatenate(parts)


def _column(low: int, high: int) -> list[int]:
    """The levels of a node from one to the other."""
    step = 1 if high >= low else -1
    return list(range(low, high + step, step))


def _between(left: list[int], right: list[int]) -> IntArray:
    """Triangles between two columns of points, from below."""
    made = [(right[0], after, before) for before, after in pairwise(left)]
    made += [(left[-1], before, after) for before, after in pairwise(right)]
    return np.array(made, dtype=np.int64).reshape(-1, 3)
