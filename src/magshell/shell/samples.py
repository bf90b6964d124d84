r"""Dipoles in place of the magnetised body of an element: few, and many.

The moments m_i of the levels at the points i of an element stand for a density over the parent square or triangle,
μ = Σ L_i m_i / ω_i with the polynomials L_i that are 1 at one point and 0 at the others, and ω_i the weights of the
rule. A finer rule with points a and weights ω_a has the dipoles

    m_a = Σ_i P_ai m_i,   P_ai = ω_a L_i(a) / ω_i,   at   x_a = Σ_i L_i(a) x_i,

level by level. As the finer rule integrates the L_i, Σ_a P_ai = 1: the whole moment is the same. With the fields of
the dipoles averaged by the same numbers, B_i = Σ_a P_ai B(x_a) and likewise ∇B_i, torques m_i × B_i and forces
m_i · ∇B_i at the points add up to those on the dipoles, and so, as long as the moment varies little in the element, do
their moments. So what two elements exert on each other is opposite and equal.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import triangle
from magshell.shell.elements import ElementType
from magshell.shell.shape_functions import gauss_legendre


class Samples(NamedTuple):
    """A finer rule: L (elements, a, p) for positions and P (elements, a, p) for moments."""

    places: FloatArray
    moments: FloatArray


def samples(element: ElementType, coordinates: FloatArray, cells: int) -> Samples:
    """With two by two dipoles in each of cells × cells parts of quadrilaterals (e, 8, 3), and as many in triangles."""
    points, weights = element.integration(coordinates)
    triangles = triangle.collapsed(coordinates)
    finer, shares = _in_cells(cells)
    inner = _centroids(2 * cells)
    L, P = (np.zeros((len(coordinates), len(shares), weights.shape[1])) for _ in range(2))
    for is_triangle in (False, True):
        some = triangles == is_triangle
        if not some.any():
            continue
        own = weights[np.argmax(some)]
        used = np.flatnonzero(own)
        if is_triangle:
            parent, ω = points.triangles[used], own[used] * (1.0 - points.triangles[used, 1]) / 4.0
            values = inner @ np.linalg.pinv(triangle.barycentric(parent)[0])
            portion = np.full(len(inner), 1.0 / len(inner))
        else:
            parent, ω = points.quadrilaterals[used], own[used]
            degree = round(np.sqrt(len(used)))
            values = _powers(finer, degree) @ np.linalg.pinv(_powers(parent, degree))
            portion = shares
        L[np.ix_(some, np.arange(len(shares)), used)] = values
        P[np.ix_(some, np.arange(len(shares)), used)] = portion[:, None] * values / ω
    return Samples(L, P)


def _in_cells(cells: int) -> tuple[FloatArray, FloatArray]:
    """Gauss points, two by two in each cell, and their weights."""
    points, weights = gauss_legendre(2)
    middles = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    corner = np.stack(np.meshgrid(middles, middles, indexing="ij"), axis=-1).reshape(-1, 1, 2)
    return (corner + points / cells).reshape(-1, 2), np.tile(weights / cells**2, cells**2)


def _centroids(parts: int) -> FloatArray:
    """Barycentric coordinates of the middles of a triangle's parts² similar parts."""
    upright = [(i, j) for i in range(parts) for j in range(parts - i)]
    inverted = [(i, j) for i in range(parts - 1) for j in range(parts - 1 - i)]
    first = np.array([(i + 1 / 3, j + 1 / 3) for i, j in upright] + [(i + 2 / 3, j + 2 / 3) for i, j in inverted])
    first /= parts
    return np.column_stack([first, 1.0 - first.sum(axis=1)])


def _powers(points: FloatArray, count: int) -> FloatArray:
    """ξ^a η^b with a, b < count at points (n, 2)."""
    xi, eta = (np.vander(column, count, increasing=True) for column in points.T)
    return np.einsum("na,nb->nab", xi, eta).reshape(len(points), -1)
