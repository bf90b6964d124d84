"""From the integration points of an element to its nodes.

A function of the parent coordinates is fitted to the values at the points, with the weights of the rule: a + bξ + cη +
dξη on quadrilaterals, a linear one on triangles. It passes through the points of the default rules. Derivatives of the
displacement are best there (Barlow, Int. J. Numer. Methods Engrg. 10, 1976), so what is extrapolated is of second
order.
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import triangle
from magshell.shell.elements import ElementType
from magshell.shell.shape_functions import NODES


def to_nodes(element: ElementType, coordinates: FloatArray) -> FloatArray:
    """Matrices (elements, 8, points) that take values at the points of elements (elements, 8, 3) to their nodes.

    At the repeated nodes of triangles they are zero.
    """
    points, weights = element.integration(coordinates)
    triangles = triangle.collapsed(coordinates)
    made = np.empty((len(coordinates), 8, weights.shape[1]))
    if not triangles.all():
        fit = _fit(_bilinear(points.quadrilaterals), weights[~triangles][0])
        made[~triangles] = _bilinear(NODES) @ fit
    if triangles.any():
        at_nodes = np.zeros((8, 3))
        at_nodes[triangle.SLOTS] = triangle.BARYCENTRIC
        made[triangles] = at_nodes @ _fit(triangle.barycentric(points.triangles)[0], weights[triangles][0])
    return made


def _bilinear(parent: FloatArray) -> FloatArray:
    xi, eta = parent.T
    return np.stack([np.ones_like(xi), xi, eta, xi * eta], axis=1)


def _fit(functions: FloatArray, weights: FloatArray) -> FloatArray:
    """Coefficients (functions, points) of values at the points, by weighted least squares."""
    weighted = functions * weights[:, None]
    return np.asarray(np.linalg.solve(functions.T @ weighted, weighted.T))
