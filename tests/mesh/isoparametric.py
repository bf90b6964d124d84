"""Surface integrals over 8-node quadrilaterals, written from the textbook and apart from the package."""

from __future__ import annotations

import numpy as np

CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
MIDDLES = np.array([[0, -1], [1, 0], [0, 1], [-1, 0]])


def shape_functions(xi, eta):
    """The eight serendipity functions at a point."""
    corner = [0.25 * (1 + xi * a) * (1 + eta * b) * (xi * a + eta * b - 1) for a, b in CORNERS]
    middle = [0.5 * (1 - xi**2) * (1 + eta * b) if a == 0 else 0.5 * (1 - eta**2) * (1 + xi * a) for a, b in MIDDLES]
    return np.array(corner + middle)


def derivatives(xi, eta):
    """Their derivatives (8, 2) by complex steps."""
    step = 1e-30
    return np.stack(
        [
            shape_functions(xi + 1j * step, eta + 0j).imag / step,
            shape_functions(xi + 0j, eta + 1j * step).imag / step,
        ],
        axis=1,
    )


def quadrature(mesh, order=6):
    """Positions (elements, points, 3) and area vectors (elements, points, 3), weights included."""
    at, weight = np.polynomial.legendre.leggauss(order)
    x = mesh.points[mesh.elements]
    positions, areas = [], []
    for xi, a in zip(at, weight, strict=True):
        for eta, b in zip(at, weight, strict=True):
            tangents = np.einsum("eni,nk->eki", x, derivatives(xi, eta))
            positions.append(np.einsum("eni,n->ei", x, shape_functions(xi, eta)))
            areas.append(a * b * np.cross(tangents[:, 0], tangents[:, 1]))
    return np.stack(positions, axis=1), np.stack(areas, axis=1)


def area(mesh):
    """Area of the quadratic surface."""
    return float(np.linalg.norm(quadrature(mesh)[1], axis=2).sum())


def edge_lengths(mesh, edges):
    """Lengths (k,) of quadratic edges (k, 3)."""
    at, weight = np.polynomial.legendre.leggauss(8)
    start, end, middle = (mesh.points[edges[:, i]] for i in range(3))
    tangents = [start * (t - 0.5) + end * (t + 0.5) - 2 * t * middle for t in at]
    return sum(w * np.linalg.norm(v, axis=1) for w, v in zip(weight, tangents, strict=True))
