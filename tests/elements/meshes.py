"""Meshes with moved corners."""

from __future__ import annotations

import numpy as np

import magshell as ms


def moved(mesh: ms.mesh.Mesh, amount: float) -> ms.mesh.Mesh:
    """A flat regular mesh whose inner corners are moved at random by up to `amount` of an element; straight sides."""
    points, corners = mesh.points.copy(), mesh.elements[:, :4]
    inner = np.setdiff1d(mesh.corner_nodes, mesh.boundary_edges)
    size = np.ptp(points[corners[0], :2], axis=0)
    points[inner, :2] += amount * size * np.random.default_rng(5).uniform(-1, 1, (len(inner), 2))
    points[mesh.elements[:, 4:]] = 0.5 * (points[corners] + points[np.roll(corners, -1, axis=1)])
    return ms.mesh.Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)
