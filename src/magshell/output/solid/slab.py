r"""The deformed body between its two faces.

On the director d through a node at x, the level at height z of the undeformed section lies at

    x + t d,      t = z + φ z²,

with the thickness stretch φ. The faces go through the levels at both ends of the thickness of each element, and
between them the body is ruled: straight from the lower face to the upper one. Where sheets meet at a kink the faces are
mitred; other sheets at a joint, and those beside a hinge, are closed bodies of their own, which overlap there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.converged import Converged
from magshell.mesh.edges import is_triangle
from magshell.output.joints import Joints, joints_of
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
        Poles: neighbours that share one share their levels there (`magshell.output.joints`).
    levels : ndarray, shape (levels, 3)
        Positions, m: pole by pole, at each pole from below.
    above : ndarray, shape (levels, 3)
        The same from the node, m.
    holder : ndarray, shape (levels,)
        A place in `at` (flat) that has the level.
    at : ndarray, shape (2, elements, 8)
        Level of the lower and of the upper face.
    """

    elements: IntArray
    levels: FloatArray
    above: FloatArray
    holder: IntArray
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
    """The body at a converged state."""
    mesh = reached.mesh
    joints, middle = joints_of(reached.discretisation.model.shell), (mesh.points + reached.displacement)[mesh.elements]
    t = heights_of(reached)
    faces = joints.faces(middle, reached.element_directors(), t)
    return slab(joints, faces, faces - middle, (1.0 + reached.element_stretch()) * t)


def heights_of(reached: Converged) -> FloatArray:
    """Heights t (2, elements, 8) of both faces at the nodes of each element, in directors."""
    z = np.moveaxis(reached.discretisation.model.shell.faces_at_nodes, 2, 0)
    return np.asarray(z + reached.element_phi() * z**2)


def slab(joints: Joints, faces: FloatArray, above: FloatArray, heights: FloatArray) -> Slab:
    """The body with faces at given positions.

    Parameters
    ----------
    joints : Joints
    faces, above : ndarray, shape (2, elements, 8, 3)
        Lower and upper face, m: positions, and from the nodes.
    heights : ndarray, shape (2, elements, 8)
        Of both, m; equal heights at a pole are one level.
    """
    largest = np.abs(heights).max()
    ends = np.where(joints.upside, -largest, largest) * np.array([-1.0, 1.0])[:, None, None]
    t = np.where(joints.mitred, ends, heights).ravel()
    poles = np.broadcast_to(joints.poles, heights.shape).ravel()
    order = np.lexsort((t, poles))
    new = np.ones(len(order), dtype=bool)
    new[1:] = (np.diff(poles[order]) > 0) | (np.diff(t[order]) > SAME * largest)
    level = np.empty(len(order), dtype=np.int64)
    level[order] = np.cumsum(new) - 1
    holder = order[new]
    return Slab(
        joints.poles,
        faces.reshape(-1, 3)[holder],
        above.reshape(-1, 3)[holder],
        holder,
        level.reshape(heights.shape),
    )


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
