"""From the integration points to the nodes: extrapolated in each element, averaged over smooth patches.

Tensors are carried from a point to a node in frames that turn with the surface normal and about nothing else, so that
what is constant along a curved surface stays so, whatever the mesh.

Stretching and bending strains are accurate at the points, and extrapolated from there. Of the transverse shear only the
mean over an element is accurate. So a linear field is laid through the mean of each element and those
of its neighbours in the patch. Both are of second order at inner nodes and at the edge.
"""

from __future__ import annotations

import weakref
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation import neighbours, points
from magshell.evaluation.extrapolation import to_nodes
from magshell.evaluation.neighbours import Neighbours, turned
from magshell.evaluation.patches import Patches, patches_of
from magshell.shell.deformed import Levels

PARALLEL = np.sin(np.radians(0.1))
"""A direction that is closer to the normal than this has no projection on the surface."""


class Recovery(NamedTuple):
    """What recovering needs of the undeformed shell.

    Attributes
    ----------
    patches : Patches
    points : ndarray, shape (elements, p, 3, 3)
        Frame at each point: its rows are two tangents of the surface and its normal.
    axes : ndarray, shape (rows, 3, 3)
        Local axes of each row of the patches, as rows.
    sources : ndarray, shape (k,)
        Node of an element, 8 e + n, that has the value at each place of the patches.
    to_axes : ndarray, shape (k, 3, 3)
        From components in the frames of the points to components in the local axes of the place's row.
    to_nodes : ndarray, shape (elements, 8, p)
        From values at the points to values at the nodes.
    neighbours : Neighbours
    faces : Levels
        Upper face, middle and lower face at the points.
    """

    patches: Patches
    points: FloatArray
    axes: FloatArray
    sources: IntArray
    to_axes: FloatArray
    to_nodes: FloatArray
    neighbours: Neighbours
    faces: Levels

    def vectors(self, values: FloatArray) -> FloatArray:
        """Components in the frames of the points (elements, p, 3) as components in the local axes (rows, 3).

        Of the rotations of transverse shear only the means of the first two are accurate.
        """
        nodal = np.matmul(self.to_nodes, values)
        nodal[..., :2] = self.neighbours.at_nodes(values[..., :2])
        there = nodal.reshape(-1, 3)[self.sources]
        return self._averaged(np.matmul(self.to_axes, there[..., None])[..., 0])

    def tensors(self, values: FloatArray) -> FloatArray:
        """Components in the frames of the points (elements, p, 3, 3) as components in the local axes (rows, 3, 3).

        The components 31, 32, 13 and 23 are those of transverse shear.
        """
        nodal = np.matmul(self.to_nodes, values.reshape(*values.shape[:2], 9)).reshape(len(values), 8, 3, 3)
        nodal[..., 2, :2] = self.neighbours.at_nodes(values[..., 2, :2])
        nodal[..., :2, 2] = self.neighbours.at_nodes(values[..., :2, 2])
        there = nodal.reshape(-1, 3, 3)[self.sources]
        return self._averaged(self.to_axes @ there @ np.swapaxes(self.to_axes, -1, -2))

    def axes_of(self, values: FloatArray) -> FloatArray:
        """Images of the axes of the frames (elements, p, 3, 3) as images of the local axes (rows, 3, 3).

        They are columns, in X1, X2, X3, and turn with the copies of elements.
        """
        nodal = np.matmul(self.to_nodes, values.reshape(*values.shape[:2], 9)).reshape(-1, 3, 3)
        turns = self.patches.around.rotation[self.patches.places // 8]
        return self._averaged(turns @ nodal[self.sources] @ np.swapaxes(self.to_axes, -1, -2))

    def _averaged(self, there: FloatArray) -> FloatArray:
        averaged = self.patches.mean @ there.reshape(len(there), -1)
        return np.asarray(averaged).reshape(-1, *there.shape[1:])


_kept: weakref.WeakKeyDictionary[Discretisation, Recovery] = weakref.WeakKeyDictionary()


def recovery_of(discretisation: Discretisation) -> Recovery:
    """What recovering needs, made once for each discretisation."""
    if discretisation not in _kept:
        _kept[discretisation] = _made(discretisation)
    return _kept[discretisation]


def _made(discretisation: Discretisation) -> Recovery:
    geometry, shell = discretisation.reference.geometry, discretisation.model.shell
    patches = patches_of(shell)
    about = patches.around
    normals = _unit(np.cross(geometry.A[:, :, 0], geometry.A[:, :, 1]))
    middle = _unit(normals.sum(axis=1))
    frame = local_axes(middle, geometry.A[:, 0, 0])
    at_points = frame[:, None] @ turned(middle[:, None], normals)
    frames = frame[about.original] @ np.swapaxes(about.rotation, -1, -2)
    number, node = np.divmod(patches.places, 8)
    at_nodes = frames[number] @ turned(frames[number, 2], patches.normals[patches.rows])
    axes = local_axes(patches.normals, np.asarray(discretisation.model.local_axis, dtype=float))
    coordinates = about.points[about.elements]
    return Recovery(
        patches,
        at_points,
        axes,
        8 * about.original[number] + node,
        axes[patches.rows] @ np.swapaxes(at_nodes, -1, -2),
        to_nodes(shell.element, coordinates[: len(frame)]),
        neighbours.found(shell.element, coordinates, frames, patches),
        points.faces(shell, geometry),
    )


def local_axes(normals: FloatArray, direction: FloatArray) -> FloatArray:
    """Axes (n, 3, 3), as rows: the direction projected on the surface, the normal times it, and the normal (n, 3).

    Where the direction is normal to the surface X3 takes its place, or X1 where that is normal too.
    """
    first = np.zeros_like(normals)
    length = np.zeros(len(normals))
    for one in (direction, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
        unit = np.broadcast_to(_unit(np.asarray(one, dtype=float)), normals.shape)
        open_ = length <= PARALLEL
        inside = unit - np.sum(unit * normals, axis=1, keepdims=True) * normals
        first[open_] = inside[open_]
        length = np.linalg.norm(first, axis=1)
    first /= length[:, None]
    return np.stack([first, np.cross(normals, first), normals], axis=1)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
