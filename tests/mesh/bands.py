"""A band with one side."""

from __future__ import annotations

import numpy as np

from magshell.mesh import Mesh, rectangle


def moebius(around, across):
    """Möbius band of radius 4 and width 1, whose normals change sign across its first line of nodes."""
    mesh = rectangle(1.0, 1.0, (around, across))
    turn = 2.0 * np.pi * mesh.points[:, 0]
    away = (mesh.points[:, 1] - 0.5)[:, None]
    outward = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    tilt = np.cos(turn / 2)[:, None] * np.array([0, 0, 1.0]) + np.sin(turn / 2)[:, None] * outward
    ends = (nodes[np.argsort(mesh.points[nodes, 1])] for nodes in map(mesh.nodes_of, ("left", "right")))
    left, right = ends
    weld = np.arange(len(turn))
    weld[right] = left[::-1]
    kept, elements = np.unique(weld[mesh.elements], return_inverse=True)
    return Mesh((4.0 * outward + away * tilt)[kept], elements.reshape(-1, 8))
