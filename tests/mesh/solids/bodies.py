"""Skins of solids, as triangles."""

from __future__ import annotations

import numpy as np


def prism(upper, lower, cells):
    """Triangles of a body between two grids (n + 1, m + 1, 3), seen from outside.

    The upper grid turns left when its first and then its second number grows, seen from outside.
    """
    n, m = cells

    def sheet(grid, turned):
        a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
        faces = np.concatenate([np.stack([a, b, c], 2).reshape(-1, 3, 3), np.stack([a, c, d], 2).reshape(-1, 3, 3)])
        return faces[:, ::-1] if turned else faces

    def wall(top, bottom):
        a, b, c, d = top[:-1], top[1:], bottom[1:], bottom[:-1]
        return np.concatenate([np.stack([a, d, c], 1), np.stack([a, c, b], 1)])

    assert upper.shape == lower.shape == (n + 1, m + 1, 3)
    walls = [
        wall(upper[:, 0], lower[:, 0]),
        wall(upper[-1], lower[-1]),
        wall(upper[::-1, -1], lower[::-1, -1]),
        wall(upper[0, ::-1], lower[0, ::-1]),
    ]
    faces = np.concatenate([sheet(upper, False), sheet(lower, True), *walls])
    points, place = np.unique(np.round(faces.reshape(-1, 3), 12), axis=0, return_inverse=True)
    return points, place.reshape(-1, 3)


def plate(length=20.0, width=8.0, thickness=lambda x, y: 1.0, cells=(20, 8)):
    """A plate with its bottom at z = 0."""
    x, y = np.meshgrid(np.linspace(0, length, cells[0] + 1), np.linspace(0, width, cells[1] + 1), indexing="ij")
    top = np.vectorize(thickness, otypes=[float])(x, y)
    return prism(np.stack([x, y, top], 2), np.stack([x, y, 0 * x], 2), cells)


def arch(radius=10.0, thickness=1.0, degrees=100.0, length=8.0, cells=(24, 8)):
    """A sector of a tube about X2."""
    angle, y = np.meshgrid(
        np.radians(np.linspace(90 + degrees / 2, 90 - degrees / 2, cells[0] + 1)),
        np.linspace(0, length, cells[1] + 1),
        indexing="ij",
    )
    grids = [
        np.stack([r * np.cos(angle), y, r * np.sin(angle)], 2) for r in (radius + thickness / 2, radius - thickness / 2)
    ]
    return prism(*grids, cells)


def angle(leg=10.0, width=8.0, thickness=1.0, cells=(20, 8)):
    """A sheet with a right angle: along X1, then up along X3; its outside is below and at the far end."""
    s = np.linspace(0, 2, cells[0] + 1)
    flat, inner = leg, leg - thickness
    outside = [(t * flat, 0.0) if t <= 1 else (flat, (t - 1) * flat) for t in s]
    inside = [(t * inner, thickness) if t <= 1 else (inner, thickness + (t - 1) * (flat - thickness)) for t in s]
    y = np.linspace(0, width, cells[1] + 1)
    upper, lower = (np.array([[(x, w, z) for w in y] for x, z in line]) for line in (inside, outside))
    return prism(upper, lower, cells)


def written(file, points, triangles):
    """An STL file of them, in text with all digits."""
    lines = ["solid body"]
    for corners in points[triangles]:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
        lines += ["endloop", "endfacet"]
    file.write_text("\n".join([*lines, "endsolid"]) + "\n")
    return file
