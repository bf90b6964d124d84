"""A template given by displacements: of a solve, of a file, or by a function of the position."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.remanence.inside import find
from magshell.magnetics.remanence.template import Placed
from magshell.magnetics.remanence.vectors import first_element

if TYPE_CHECKING:
    from magshell.mesh import Mesh

FLATTENED = 1e-6


class Deformed:
    """A shape with given displacements of the nodes, or given positions of the points; a `Shape`.

    Parameters
    ----------
    displacements : array_like, shape (nodes, 3), or callable
        m. A function takes undeformed positions (n, 3), m, and returns those of the template.
    """

    def __init__(self, displacements: ArrayLike | Callable[[FloatArray], ArrayLike]) -> None:
        self._positions = displacements if callable(displacements) else None
        self._u = None if callable(displacements) else np.array(displacements, dtype=float)

    def place(self, mesh: Mesh, points: FloatArray) -> Placed:
        """Material points, with the rotation R of F = R U of the mid-surface.

        Raises
        ------
        InputError
            Displacements that are not finite or not those of the mesh; a shape that crushes an element.
        """
        nodes, inside = mesh.points[mesh.elements], find(mesh, points)
        x = self._nodes(mesh)[mesh.elements]
        A, a = inside.slopes(nodes), inside.slopes(x)
        before, after = (_with_normal(slopes) for slopes in (A, a))
        asked = np.asarray(np.isfinite(points).all(axis=-1))
        scale = np.linalg.norm(A[:, :, 0], axis=-1) * np.linalg.norm(A[:, :, 1], axis=-1)
        area = np.linalg.norm(np.cross(a[:, :, 0], a[:, :, 1]), axis=-1)
        crushed = asked & ~(area > FLATTENED * scale)
        if crushed.any():
            raise InputError(
                f"remanence: the template crushes element {first_element(crushed)} to nothing; it has no rotation there"
            )
        F = np.swapaxes(
            np.linalg.solve(np.where(asked[..., None, None], before, np.eye(3)).astype(float), after), -1, -2
        )
        R = np.full(F.shape, np.nan)
        left, _, right = np.linalg.svd(F[asked])
        R[asked] = left @ right
        return Placed(inside.at(x), R)

    def _nodes(self, mesh: Mesh) -> FloatArray:
        """Positions of the nodes in this shape."""
        if self._positions is not None:
            what, given = "function returned positions of", np.asarray(self._positions(mesh.points), dtype=float)
        else:
            what, given = "displacements have", np.asarray(self._u)
        if given.shape != mesh.points.shape:
            raise InputError(
                f"remanence: the template's {what} shape {given.shape}; the mesh needs {mesh.points.shape}"
            )
        if not np.isfinite(given).all():
            node = np.flatnonzero(~np.isfinite(given).all(axis=1))[0]
            raise InputError(f"remanence: the template's position of node {node} is not finite")
        return given if self._positions is not None else mesh.points + given


def deformed(shape: Any) -> Deformed:
    """A part in a deformed state.

    Parameters
    ----------
    shape : Path, State, array_like of shape (nodes, 3), or callable
        The last step of a solve, or any state of one, on the same mesh; displacements of the nodes, m; or a function
        from undeformed positions (n, 3), m, to those of the template.
    """
    if hasattr(shape, "steps"):
        shape = shape.steps[-1].state
    return Deformed(getattr(shape, "u", shape))


def _with_normal(slopes: FloatArray) -> FloatArray:
    """Rows: two tangents and the unit normal, (elements, points, 3, 3)."""
    normal = np.cross(slopes[:, :, 0], slopes[:, :, 1])
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = normal / np.where(length > 0.0, length, 1.0)
    return np.concatenate([slopes, normal[:, :, None]], axis=2)
