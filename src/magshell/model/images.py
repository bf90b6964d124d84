r"""Nodes that are images of others: what a part that stands for many alike shares with its neighbours.

A motion that takes the part to its neighbour takes node a on one side to b on the other, and the deformation with it:

    u_b = Q u_a,    d_b = Q d_a,    R̃_b = Q R̃_a Qᵀ,    φ_b = φ_a.

Motions follow each other at corners of cells, so that every node has one *root*, a rotation Q from it. On an axis of
rotation a = b: there u, d and the spin have their component along the axis only.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.model.repeated import Periodic, Repeated

SAME = 1e-9
"""Rotations whose components differ by less are the same."""


class Images(NamedTuple):
    """Which node of a mesh is the image of which.

    Attributes
    ----------
    root : ndarray, shape (nodes,)
        Node that each is an image of; its own number for those that are none.
    rotation : ndarray, shape (nodes, 3, 3)
        Q from its root.
    steps : ndarray, shape (nodes, periodic)
        How often each periodic motion leads from its root.
    on_axis : ndarray, shape (k,)
        Roots on an axis of rotation.
    axes : ndarray, shape (k, 3)
        Unit vectors of these axes.
    """

    root: IntArray
    rotation: FloatArray
    steps: IntArray
    on_axis: IntArray
    axes: FloatArray

    @property
    def found(self) -> IntArray:
        """Nodes that are images of others."""
        return np.flatnonzero(self.root != np.arange(len(self.root)))

    @property
    def touched(self) -> AnyArray:
        """Which nodes (nodes,) are images, or have any."""
        found = self.found
        touched = np.zeros(len(self.root), dtype=bool)
        touched[found] = touched[self.root[found]] = touched[self.on_axis] = True
        return touched

    def back(self, vectors: FloatArray, nodes: IntArray) -> FloatArray:
        """Vectors (..., 3) at nodes (...), turned back to the nodes' roots: Qᵀ v."""
        at = np.isin(nodes, self.found)
        turned = vectors.copy()
        turned[at] = np.einsum("nji,nj->ni", self.rotation[nodes[at]], vectors[at])
        return turned


class Beyond(NamedTuple):
    """Rows (n,) whose u is that of their roots (n,) and steps (n, periodic) times the jumps."""

    rows: IntArray
    roots: IntArray
    steps: IntArray


class ImageRows(NamedTuple):
    """Rows of the nodal arrays that are images of others.

    Attributes
    ----------
    rows, roots : ndarray, shape (n,)
        Rows, and those that they are images of.
    turns : ndarray, shape (n, 3, 3)
        Q.
    beyond : Beyond
        Rows of the nodes that a periodic motion leads to; those of one node share u.
    """

    rows: IntArray
    roots: IntArray
    turns: FloatArray
    beyond: Beyond

    def turn_frames(self, frame_of: IntArray, frames: FloatArray) -> FloatArray:
        """Turn the frames of images, whose numbers in `frame_of` (rows, 3) are those of their roots; returns all."""
        turned = np.abs(self.turns - np.eye(3)).max(axis=(1, 2), initial=0.0) > SAME
        rows, turns, all_frames = self.rows[turned], self.turns[turned], [frames]
        for field in range(frame_of.shape[1]):
            there = frame_of[rows, field]
            base = np.where((there >= 0)[:, None, None], frames[there] if len(frames) else np.eye(3), np.eye(3))
            frame_of[rows, field] = sum(map(len, all_frames)) + np.arange(len(rows))
            all_frames.append(base @ np.swapaxes(turns, 1, 2))
        return np.concatenate(all_frames)

    def differences(self, motion: FloatArray) -> FloatArray:
        """What a motion (rows, 3, m) of vectors does not take from a root to its image, (n, 3, m)."""
        return np.asarray(motion[self.rows] - self.turns @ motion[self.roots])


_NONE = np.empty(0, dtype=np.int64)
NO_IMAGES = ImageRows(_NONE, _NONE, np.empty((0, 3, 3)), Beyond(_NONE, _NONE, np.empty((0, 0), dtype=np.int64)))


class _Link(NamedTuple):
    """Node b is the image of node a."""

    a: int
    b: int
    rotation: FloatArray
    step: IntArray
    by: Repeated


def images_of(mesh: Mesh, repeated: Sequence[Repeated]) -> Images:
    """The images of all motions.

    Raises
    ------
    InputError
        A motion does not take its group to its image, or two of them disagree at a node.
    """
    count, periodic = len(mesh.points), [one for one in repeated if isinstance(one, Periodic)]
    root, steps = np.arange(count), np.zeros((count, len(periodic)), dtype=np.int64)
    rotation: FloatArray = np.broadcast_to(np.eye(3), (count, 3, 3))
    if not repeated:
        return Images(root, rotation, steps, np.empty(0, dtype=np.int64), np.empty((0, 3)))
    rotation, axes = rotation.copy(), {}
    links: dict[int, list[_Link]] = {}
    for one in repeated:
        Q, step = one.rotation(mesh), np.array([one is other for other in periodic], dtype=np.int64)
        for a, b in zip(*(nodes.tolist() for nodes in one.nodes(mesh)), strict=True):
            if a == b:
                axes[a] = np.linalg.svd(Q - np.eye(3))[2][2]
            else:
                links.setdefault(a, []).append(_Link(a, b, Q, step, one))
                links.setdefault(b, []).append(_Link(b, a, Q.T, -step, one))
    seen = np.zeros(count, dtype=bool)
    for start in sorted(links):
        front = [] if seen[start] else [start]
        seen[start] = True
        while front:
            for link in links[front.pop()]:
                turn, step = link.rotation @ rotation[link.a], steps[link.a] + link.step
                if not seen[link.b]:
                    seen[link.b], root[link.b], rotation[link.b], steps[link.b] = True, start, turn, step
                    front.append(link.b)
                elif np.abs(rotation[link.b] - turn).max() > SAME or np.any(steps[link.b] != step):
                    raise InputError(
                        f"{link.by.label}: node {link.b} is an image of node {start} in two ways that disagree; "
                        "check the groups"
                    )
    on_axis = np.array(sorted(axes), dtype=np.int64)
    return Images(root, rotation, steps, on_axis, np.array([axes[node] for node in on_axis]).reshape(-1, 3))
