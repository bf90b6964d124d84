r"""Fields of dipoles on each other, summed directly.

Dipoles come in groups; the groups are the elements of a shell, and magnets. A dipole m at the distance r has the field

    B_i = (μ0/4π) (3 (m·r) r_i / r⁵ - m_i / r³),
    ∂B_i/∂x_j = (μ0/4π) (3 ((m·r) δ_ij + r_i m_j + m_i r_j) / r⁵ - 15 (m·r) r_i r_j / r⁷),

and no group acts on itself. Each pair of dipoles is visited once and both get the other's field, so action and reaction
are equal to round-off. Sums have a fixed order.

Groups are known by few dipoles or by many, with the same moment in all. Of groups nearer than `NEAR` sizes the many
act on each other, of those farther than `FAR` the few, in between both, with weights that add up to one and have two
continuous derivatives.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.compiled import Kernel, inline

FACTOR = 1e-7
"""μ0/4π, N/A²."""
NEAR, FAR = 2.0, 2.5
CLOSEST = 0.15
"""Least distance between dipoles of groups that do not touch, over the width of the wider one."""
COMPONENTS = 9
"""B1, B2, B3 and ∂B_i/∂x_j of ij = 11, 12, 13, 22, 23, 33."""


class Groups(NamedTuple):
    """Dipoles in groups.

    Attributes
    ----------
    few, many : ndarray, shape (groups, n, 3)
        Positions, m.
    few_moments, many_moments : ndarray, shape (groups, n, 3)
        A m².
    centres : ndarray, shape (groups, 3)
    sizes, widths : ndarray, shape (groups,)
        Largest distance within, and area over it, m; 0 of magnets.
    nodes : ndarray, shape (elements, n)
        Of the groups that are elements, the first ones. Elements with a node in common touch each other.
    excluded : ndarray of bool, shape (magnets, elements)
        Elements that do not see a magnet, nor it them.
    """

    few: FloatArray
    many: FloatArray
    few_moments: FloatArray
    many_moments: FloatArray
    centres: FloatArray
    sizes: FloatArray
    widths: FloatArray
    nodes: IntArray
    excluded: AnyArray


@inline
def _share(distance: float, size: float) -> float:
    """Weight of the many."""
    if distance >= FAR * size:
        return 0.0
    if distance <= NEAR * size:
        return 1.0
    t = (distance / size - NEAR) / (FAR - NEAR)
    return 1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)


@inline
def _pairs(
    x: FloatArray, m: FloatArray, y: FloatArray, n: FloatArray, factor: float, at_x: FloatArray, at_y: FloatArray
) -> float:
    """Add what dipoles m at x and n at y (k, 3) make at each other, times a factor; the least distance squared."""
    least = np.inf
    for i in range(len(x)):
        x0, x1, x2 = x[i, 0], x[i, 1], x[i, 2]
        m0, m1, m2 = m[i, 0], m[i, 1], m[i, 2]
        b0, b1, b2, g00, g01, g02, g11, g12, g22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(len(y)):
            r0, r1, r2 = x0 - y[j, 0], x1 - y[j, 1], x2 - y[j, 2]
            n0, n1, n2 = n[j, 0], n[j, 1], n[j, 2]
            square = r0 * r0 + r1 * r1 + r2 * r2
            least = min(least, square)
            inverse = 1.0 / square
            third = factor * inverse * np.sqrt(inverse)
            fifth = 3.0 * third * inverse
            nr, mr = n0 * r0 + n1 * r1 + n2 * r2, m0 * r0 + m1 * r1 + m2 * r2
            along, back = fifth * nr, fifth * mr
            b0 += along * r0 - third * n0
            b1 += along * r1 - third * n1
            b2 += along * r2 - third * n2
            at_y[j, 0] += back * r0 - third * m0
            at_y[j, 1] += back * r1 - third * m1
            at_y[j, 2] += back * r2 - third * m2
            quartic, other = 5.0 * along * inverse, 5.0 * back * inverse
            g00 += along + 2.0 * fifth * r0 * n0 - quartic * r0 * r0
            g01 += fifth * (r0 * n1 + n0 * r1) - quartic * r0 * r1
            g02 += fifth * (r0 * n2 + n0 * r2) - quartic * r0 * r2
            g11 += along + 2.0 * fifth * r1 * n1 - quartic * r1 * r1
            g12 += fifth * (r1 * n2 + n1 * r2) - quartic * r1 * r2
            g22 += along + 2.0 * fifth * r2 * n2 - quartic * r2 * r2
            at_y[j, 3] -= back + 2.0 * fifth * r0 * m0 - other * r0 * r0
            at_y[j, 4] -= fifth * (r0 * m1 + m0 * r1) - other * r0 * r1
            at_y[j, 5] -= fifth * (r0 * m2 + m0 * r2) - other * r0 * r2
            at_y[j, 6] -= back + 2.0 * fifth * r1 * m1 - other * r1 * r1
            at_y[j, 7] -= fifth * (r1 * m2 + m1 * r2) - other * r1 * r2
            at_y[j, 8] -= back + 2.0 * fifth * r2 * m2 - other * r2 * r2
        at_x[i, 0] += b0
        at_x[i, 1] += b1
        at_x[i, 2] += b2
        at_x[i, 3] += g00
        at_x[i, 4] += g01
        at_x[i, 5] += g02
        at_x[i, 6] += g11
        at_x[i, 7] += g12
        at_x[i, 8] += g22
    return least


@inline
def _touch(one: IntArray, other: IntArray) -> bool:
    for a in range(len(one)):
        for b in range(len(other)):
            if one[a] == other[b]:
                return True
    return False


@Kernel
def add_fields(groups: Groups, at_few: FloatArray, at_many: FloatArray) -> tuple[int, int]:
    """Add the fields (groups, n, 9) of all other groups; returns two groups that are too near to each other, or -1.

    What is at the few and at the many has to be averaged over each and added up.
    """
    elements, centres = len(groups.nodes), groups.centres
    near, nearest = (-1, -1), CLOSEST
    for e in range(len(groups.few)):
        for f in range(e):
            if e >= elements and f < elements and groups.excluded[e - elements, f]:
                continue
            square = 0.0
            for i in range(3):
                square += (centres[e, i] - centres[f, i]) ** 2
            share = _share(np.sqrt(square), max(groups.sizes[e], groups.sizes[f]))
            if share > 0.0:
                least = _pairs(
                    groups.many[e],
                    groups.many_moments[e],
                    groups.many[f],
                    groups.many_moments[f],
                    share * FACTOR,
                    at_many[e],
                    at_many[f],
                )
                apart = np.sqrt(least) / max(groups.widths[e], groups.widths[f])
                if apart < nearest and (e >= elements or not _touch(groups.nodes[e], groups.nodes[f])):
                    near, nearest = (e, f), apart
            if share < 1.0:
                _pairs(
                    groups.few[e],
                    groups.few_moments[e],
                    groups.few[f],
                    groups.few_moments[f],
                    (1.0 - share) * FACTOR,
                    at_few[e],
                    at_few[f],
                )
    return near


def flux_density_at(place: FloatArray, positions: FloatArray, moments: FloatArray, beyond: float) -> FloatArray:
    """B (3,) at a place of the dipoles (n, 3) that are farther than a distance from it."""
    r = place - positions
    distance = np.linalg.norm(r, axis=1)
    far = distance > beyond
    r, m, distance = r[far], moments[far], distance[far, None]
    along = np.sum(m * r, axis=1, keepdims=True)
    return np.asarray(FACTOR * np.sum(3.0 * along * r / distance**5 - m / distance**3, axis=0))
