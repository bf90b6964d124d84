r"""Dipoles in place of the magnetised body of an element: few, and many.

The moments m_i of the levels at the points i of an element stand for a density over the parent square or triangle,
μ = Σ L_i m_i / ω_i with the polynomials L_i that are 1 at one point and 0 at the others, and ω_i the weights of the
rule. A finer rule with points a and weights ω_a has the dipoles

    m_a = Σ_i P_ai m_i,   P_ai = ω_a L_i(a) / ω_i,   at   x_a = Σ_i L_i(a) x_i,

level by level. As the finer rule integrates the L_i, Σ_a P_ai = 1: the whole moment is the same. The energy
-Σ_a m_a · B(x_a) has the derivatives -B_i, with B_i = Σ_a P_ai B(x_a), by m_i, and -f_i, with
f_i = Σ_a L_i(a) ∇B(x_a)ᵀ m_a, by x_i. Torques m_i × B_i and forces f_i on the points add up to those on the dipoles,
and so do their moments: what two elements exert on each other is opposite and equal.
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
    """Of elements (e, 8, 3) in cells × cells parts: two by two dipoles in each, in those of triangles three.

    The dipoles that triangles have less than quadrilaterals have no moment.
    """
    points, weights = element.integration(coordinates)
    triangles = triangle.collapsed(coordinates)
    count = 4 * cells**2
    L, P = (np.zeros((len(coordinates), count, weights.shape[1])) for _ in range(2))
    for is_triangle in np.unique(triangles):
        some = triangles == is_triangle
        own = weights[np.argmax(some)]
        used = np.flatnonzero(own)
        if is_triangle:
            parent = points.triangles[used]
            ω = own[used] * (1.0 - parent[:, 1]) / 4.0
            finer, shares = _in_triangles(cells)
            values = finer @ np.linalg.pinv(triangle.barycentric(parent)[0])
        else:
            parent, ω = points.quadrilaterals[used], own[used]
            finer, shares = _in_squares(cells)
            degree = round(np.sqrt(len(used)))
            values = _powers(finer, degree) @ np.linalg.pinv(_powers(parent, degree))
        values, shares = values[np.arange(count) % len(values)], np.append(shares, np.zeros(count - len(shares)))
        L[np.ix_(some, np.arange(count), used)] = values
        P[np.ix_(some, np.arange(count), used)] = shares[:, None] * values / ω
    return Samples(L, P)


def _in_squares(cells: int) -> tuple[FloatArray, FloatArray]:
    """Gauss points, two by two in each cell of the parent square, and their weights."""
    points, weights = gauss_legendre(2)
    middles = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    corner = np.stack(np.meshgrid(middles, middles, indexing="ij"), axis=-1).reshape(-1, 1, 2)
    return (corner + points / cells).reshape(-1, 2), np.tile(weights / cells**2, cells**2)


def _in_triangles(cells: int) -> tuple[FloatArray, FloatArray]:
    """Barycentric coordinates of the three points of degree two in each of a triangle's similar parts, and shares."""
    upright = [[(i, j), (i + 1, j), (i, j + 1)] for i in range(cells) for j in range(cells - i)]
    inverted = [[(i + 1, j + 1), (i, j + 1), (i + 1, j)] for i in range(cells - 1) for j in range(cells - 1 - i)]
    corners = np.array([*upright, *inverted]) / cells
    first = ((0.5 * np.eye(3) + 1.0 / 6.0) @ corners).reshape(-1, 2)
    return np.column_stack([first, 1.0 - first.sum(axis=1)]), np.full(len(first), 1.0 / len(first))


def _powers(points: FloatArray, count: int) -> FloatArray:
    """ξ^a η^b with a, b < count at points (n, 2)."""
    xi, eta = (np.vander(column, count, increasing=True) for column in points.T)
    return np.einsum("na,nb->nab", xi, eta).reshape(len(points), -1)
