"""Which fields live on which nodes, and where they are integrated: the paper's element."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.shape_functions import bilinear, gauss_legendre, serendipity


class Interpolation(NamedTuple):
    """Shape functions at the integration points.

    Attributes
    ----------
    parent, weights : ndarray, shape (points, 2) and (points,)
        Rule on the parent square.
    du : ndarray, shape (points, 2, 8)
        Parent derivatives of the functions of u, on all nodes.
    rest, d_rest : ndarray, shape (points, 4) and (points, 2, 4)
        Functions of φ and q, on the corners, and their parent derivatives (w: see `director_functions`).
    """

    parent: FloatArray
    weights: FloatArray
    du: FloatArray
    rest: FloatArray
    d_rest: FloatArray


def interpolation(parent: FloatArray, weights: FloatArray) -> Interpolation:
    """u on 8 nodes, w, φ and rotation on the 4 corners, at given points."""
    rest, d_rest = bilinear(parent)
    return Interpolation(*(np.ascontiguousarray(a) for a in (parent, weights, serendipity(parent)[1], rest, d_rest)))


def surface_rule() -> Interpolation:
    """The element's rule: 2 × 2 Gauss points."""
    return interpolation(*gauss_legendre(2))
