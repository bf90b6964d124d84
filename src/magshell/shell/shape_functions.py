"""Shape functions on the parent square [-1, 1]² and Gauss–Legendre rules.

Node order: corners counter-clockwise from (-1, -1), then mid-sides starting between corners 1 and 2.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
MID_SIDES = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
NODES = np.vstack([CORNERS, MID_SIDES])


def bilinear(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Four-node functions and parent derivatives at points (n, 2).

    Returns
    -------
    values : ndarray, shape (n, 4)
    derivatives : ndarray, shape (n, 2, 4)
    """
    xi, eta = parent[:, :1], parent[:, 1:]
    xi_i, eta_i = CORNERS.T
    values = 0.25 * (1 + xi * xi_i) * (1 + eta * eta_i)
    derivatives = 0.25 * np.stack([xi_i * (1 + eta * eta_i), eta_i * (1 + xi * xi_i)], axis=1)
    return values, derivatives


def serendipity(parent: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Eight-node functions, first and second parent derivatives at points (n, 2).

    Returns
    -------
    values : ndarray, shape (n, 8)
    derivatives : ndarray, shape (n, 2, 8)
    second_derivatives : ndarray, shape (n, 3, 8)
        With respect to (xi, xi), (eta, eta), (xi, eta).
    """
    xi, eta = parent[:, :1], parent[:, 1:]
    a, b = CORNERS.T
    corner = 0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1)
    corner_xi = 0.25 * a * (1 + b * eta) * (2 * a * xi + b * eta)
    corner_eta = 0.25 * b * (1 + a * xi) * (2 * b * eta + a * xi)
    corner_xi_xi = 0.5 * (1 + b * eta) + 0 * xi
    corner_eta_eta = 0.5 * (1 + a * xi) + 0 * eta
    corner_xi_eta = 0.25 * a * b * (2 * a * xi + 2 * b * eta + 1)

    count = len(parent)
    values, derivatives, second = np.empty((count, 8)), np.empty((count, 2, 8)), np.zeros((count, 3, 8))
    values[:, :4] = corner
    derivatives[:, 0, :4], derivatives[:, 1, :4] = corner_xi, corner_eta
    second[:, 0, :4], second[:, 1, :4], second[:, 2, :4] = corner_xi_xi, corner_eta_eta, corner_xi_eta
    xi, eta = xi[:, 0], eta[:, 0]
    for node, (a_m, b_m) in enumerate(MID_SIDES, start=4):
        if a_m == 0.0:
            values[:, node] = 0.5 * (1 - xi**2) * (1 + b_m * eta)
            derivatives[:, 0, node] = -xi * (1 + b_m * eta)
            derivatives[:, 1, node] = 0.5 * b_m * (1 - xi**2)
            second[:, 0, node] = -(1 + b_m * eta)
            second[:, 2, node] = -b_m * xi
        else:
            values[:, node] = 0.5 * (1 + a_m * xi) * (1 - eta**2)
            derivatives[:, 0, node] = 0.5 * a_m * (1 - eta**2)
            derivatives[:, 1, node] = -eta * (1 + a_m * xi)
            second[:, 1, node] = -(1 + a_m * xi)
            second[:, 2, node] = -a_m * eta
    return values, derivatives, second


def quadratic_complete(parent: FloatArray, coordinates: FloatArray) -> tuple[FloatArray, FloatArray]:
    r"""Eight-node functions that hold every quadratic polynomial of the position, for each element its own.

    On a quadrilateral with straight sides, X = X_0 + a ξ + b η + c ξη, a quadratic polynomial f has the term
    ½ D²f[c, c] ξ²η² that the serendipity functions lack; they put ξ² + η² - 1 in its place, which differs from it by
    the bubble (1 - ξ²)(1 - η²). With c = α a + β b the missing coefficient follows from two that they do have,
    ½ D²f[c, c] = ½ (α D²f[a, c] + β D²f[b, c]), those of ξ²η and ξη². So

        N̂_I = N_I + ½ (α e_I + β f_I) (1 - ξ²)(1 - η²),      e_I, f_I: coefficients of ξ²η and ξη² in N_I.

    On parallelograms c = 0 and N̂ = N. Out of the plane of a and b, c is projected onto it. (The completeness of
    eight-node elements: MacNeal and Harder, Int. J. Numer. Methods Engrg. 33, 1992.)

    Parameters
    ----------
    parent : ndarray, shape (points, 2)
    coordinates : ndarray, shape (elements, 8, 3)

    Returns
    -------
    values : ndarray, shape (elements, points, 8)
    derivatives : ndarray, shape (elements, points, 2, 8)
    """
    _, d_centre, d2_centre = serendipity(np.zeros((1, 2)))
    base = np.einsum("an,enx->eax", d_centre[0], coordinates)
    twist = np.einsum("n,enx->ex", d2_centre[0, 2], coordinates)
    metric = np.einsum("eax,ebx->eab", base, base)
    share = np.linalg.solve(metric, np.einsum("eax,ex->ea", base, twist)[..., None])[..., 0]
    corners, mid_sides = 0.25 * CORNERS[:, ::-1], -0.5 * MID_SIDES[:, ::-1]
    missing = 0.5 * share @ np.vstack([corners, mid_sides]).T
    inner, d_inner = bubble(parent)
    values, derivatives, _ = serendipity(parent)
    return (
        values + inner[:, None] * missing[:, None],
        derivatives + d_inner[:, :, None] * missing[:, None, None],
    )


def bubble(parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(1 - ξ²)(1 - η²) at points (n, 2), and its parent derivatives (n, 2)."""
    xi, eta = parent.T
    return (1 - xi**2) * (1 - eta**2), np.stack([-2 * xi * (1 - eta**2), -2 * eta * (1 - xi**2)], axis=1)


def gauss_legendre(count: int) -> tuple[FloatArray, FloatArray]:
    """Tensor rule of count × count points: parent points (count², 2) and weights (count²,)."""
    points, weights = np.polynomial.legendre.leggauss(count)
    xi, eta = np.meshgrid(points, points, indexing="ij")
    return np.column_stack([xi.ravel(), eta.ravel()]), np.outer(weights, weights).ravel()
