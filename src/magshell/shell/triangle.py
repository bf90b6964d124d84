r"""Functions of triangles, on the parent square.

A triangle is a row of eight nodes whose corners 3 and 4 and the mid-side between them are one node, a quadrilateral
with that side shrunk to a point: [a, b, c, c, ab, bc, c, ca]. Its parent is the square too, by the map

    L_1 = (1 - ξ)(1 - η)/4,      L_2 = (1 + ξ)(1 - η)/4,      L_3 = (1 + η)/2

to the barycentric coordinates of a, b, c. So rules and lattices on the square serve triangles as they are: with the
derivatives in ξ and η, |A_1 × A_2| dξ dη is the area. (A_1 vanishes at c, η = 1, where no rule has a point.) On the
square's centre the derivatives of the six-node functions are those of the eight-node ones for such a row.

The functions are those of six nodes, L_i (2 L_i - 1) and 4 L_i L_j, or of the corners, L_i; all of them hold on the
first of the slots of c, and the other two have none.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray

SLOTS = np.array([0, 1, 2, 4, 5, 7])
"""Places of a, b, c, ab, bc, ca in the row of eight."""
REPEATED = np.array([3, 6])
"""Places of c that have no functions."""
PAIRS = np.array([[0, 1], [1, 2], [2, 0]])
BARYCENTRIC = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]])
"""L_1, L_2, L_3 of the six nodes."""


def collapsed(coordinates: FloatArray) -> AnyArray:
    """Which elements (elements, 8, 3) are triangles: their corners 3 and 4 are one point."""
    return np.asarray((coordinates[:, 2] == coordinates[:, 3]).all(axis=1))


def barycentric(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """L_i (n, 3) at parent points (n, 2), and their derivatives (n, 2, 3)."""
    xi, eta = parent.T
    zero = np.zeros_like(xi)
    L = np.stack([(1 - xi) * (1 - eta) / 4, (1 + xi) * (1 - eta) / 4, (1 + eta) / 2], axis=1)
    along = np.stack([-(1 - eta) / 4, (1 - eta) / 4, zero], axis=1)
    across = np.stack([-(1 - xi) / 4, -(1 + xi) / 4, zero + 0.5], axis=1)
    return L, np.stack([along, across], axis=1)


def on_square(points: FloatArray, areas: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A rule with barycentric points (n, 3) and shares of the area (n,) as points and weights on the square."""
    xi = (points[:, 1] - points[:, 0]) / (points[:, 1] + points[:, 0])
    eta = 2 * points[:, 2] - 1
    # Of a triangle of unit area |A_1 × A_2| is (1 - η)/4.
    return np.stack([xi, eta], axis=1), 4 * areas / (1 - eta)


def six_nodes(L: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Quadratic functions (n, 6) at L (n, 3), and their derivatives (n, 3, 6) with respect to L_1, L_2, L_3."""
    one, other = PAIRS.T
    values = np.concatenate([L * (2 * L - 1), 4 * L[:, one] * L[:, other]], axis=1)
    derivatives = np.zeros((len(L), 3, 6))
    for i in range(3):
        derivatives[:, i, i] = 4 * L[:, i] - 1
    for node, (i, j) in enumerate(PAIRS, start=3):
        derivatives[:, i, node], derivatives[:, j, node] = 4 * L[:, j], 4 * L[:, i]
    return values, derivatives


def quadratic(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Six-node functions in the row of eight at parent points: (n, 8), and parent derivatives (n, 2, 8)."""
    L, dL = barycentric(parent)
    values, derivatives = six_nodes(L)
    return _in_slots(8, SLOTS, values, np.einsum("pai,pin->pan", dL, derivatives))


def linear(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Functions of the corners in the row's first four at parent points: (n, 4), and parent derivatives (n, 2, 4)."""
    return _in_slots(4, SLOTS[:3], *barycentric(parent))


def bubble(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """27 L_1 L_2 L_3 at parent points (n, 2), and its parent derivatives (n, 2)."""
    L, dL = barycentric(parent)
    others = L[:, [1, 2, 0]] * L[:, [2, 0, 1]]
    return 27 * L.prod(axis=1), 27 * np.einsum("pai,pi->pa", dL, others)


def _in_slots(
    width: int, slots: IntArray, values: FloatArray, derivatives: FloatArray
) -> tuple[FloatArray, FloatArray]:
    row, d_row = np.zeros((len(values), width)), np.zeros((len(values), 2, width))
    row[:, slots], d_row[:, :, slots] = values, derivatives
    return row, d_row
