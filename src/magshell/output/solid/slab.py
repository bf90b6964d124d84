r"""The deformed body between its two faces.

On the director d through a node at x, the level at height z of the undeformed section lies at

    x + t d,      t = z + φ z²,

with the thickness stretch φ. The faces go through the levels at both ends of the thickness of each element, and
between them the body is ruled: straight from the lower face to the upper one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError
from magshell.evaluation.converged import Converged
from magshell.mesh import Mesh
from magshell.mesh.edges import find_edges, is_triangle
from magshell.shell import triangle
from magshell.shell.shape_functions import gauss_legendre, serendipity

# Heights that differ by less, relative to the thickest element, are one.
SAME = 1e-9
LOWER, UPPER = 0, 1
POINTS = 5


class Slab(NamedTuple):
    """Levels, and which of them each element has at its nodes.

    Attributes
    ----------
    elements : ndarray, shape (elements, 8)
        Nodes.
    levels : ndarray, shape (levels, 3)
        Positions on the directors, m: node by node, at each node from below.
    above : ndarray, shape (levels, 3)
        The same from the node, m.
    node_of : ndarray, shape (levels,)
    at : ndarray, shape (2, elements, 8)
        Level of the lower and of the upper face.
    """

    elements: IntArray
    levels: FloatArray
    above: FloatArray
    node_of: IntArray
    at: IntArray

    @property
    def faces(self) -> FloatArray:
        """Positions of lower and upper nodes (2, elements, 8, 3), m."""
        return np.asarray(self.levels[self.at])

    def thickened(self, factor: float) -> Slab:
        """The body with its thickness multiplied."""
        return self._replace(levels=self.levels + (factor - 1.0) * self.above, above=factor * self.above)

    @property
    def triangles(self) -> AnyArray:
        """Which elements are triangles (elements,)."""
        return is_triangle(self.elements)


def slab_of(reached: Converged) -> Slab:
    """The body at a converged state.

    Raises
    ------
    InputError
        More than two elements meet at an edge: there the body has no outside of its own.
    """
    mesh = reached.mesh
    if not has_outside(mesh):
        raise InputError("export: more than two elements meet at an edge; a body of such a mesh is not made yet")
    return slab(mesh.elements, mesh.points + reached.displacement, reached.director(), heights_of(reached))


def heights_of(reached: Converged) -> FloatArray:
    """Heights t (2, elements, 8) of both faces at the nodes of each element, in directors."""
    z = np.moveaxis(reached.discretisation.model.shell.faces_at_nodes, 2, 0)
    return np.asarray((1.0 + reached.element_stretch()) * (z + reached.element_phi() * z**2))


def has_outside(mesh: Mesh) -> bool:
    """Whether at most two elements meet at each edge."""
    return bool((find_edges(mesh.elements).sharing <= 2).all())


def slab(elements: IntArray, middle: FloatArray, director: FloatArray, heights: FloatArray) -> Slab:
    """The body with nodes (nodes, 3), directors (nodes, 3) and heights t (2, elements, 8) of both faces."""
    nodes = np.broadcast_to(elements, heights.shape).ravel()
    t = heights.ravel()
    order = np.lexsort((t, nodes))
    sorted_nodes, sorted_t = nodes[order], t[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (np.diff(sorted_nodes) > 0) | (np.diff(sorted_t) > SAME * np.abs(t).max())
    level = np.empty(len(order), dtype=np.int64)
    level[order] = np.cumsum(new) - 1
    node_of = sorted_nodes[new]
    above = sorted_t[new][:, None] * director[node_of]
    return Slab(elements, middle[node_of] + above, above, node_of, level.reshape(heights.shape))


def volume(body: Slab) -> float:
    """Volume between the faces, m³: exact, as the integrand is a polynomial."""
    parent, weights = gauss_legendre(POINTS)
    total, half = 0.0, 0.5 * (1.0 + np.array([-1.0, 1.0]) / np.sqrt(3.0))
    for chosen, (N, dN) in (
        (~body.triangles, serendipity(parent)[:2]),
        (body.triangles, triangle.quadratic(parent)),
    ):
        lower, upper = body.faces[:, chosen]
        rise = np.einsum("pn,enx->epx", N, upper - lower)
        for share in half:
            a = np.einsum("pan,enx->epax", dN, (1.0 - share) * lower + share * upper)
            section = np.einsum("epx,epx->ep", np.cross(a[:, :, 0], a[:, :, 1]), rise)
            total += 0.5 * float((section @ weights).sum())
    return total
