"""How well shaped the elements of a mesh are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.mesh.edges import is_triangle
from magshell.mesh.geometry import chord_lengths, diagonal_normals, scaled_jacobians, unit
from magshell.mesh.mesh import Mesh


class Quality(NamedTuple):
    """Measures of every element, each (elements,) and dimensionless."""

    scaled_jacobian: FloatArray
    """Least sine of the angle between the edges at a corner over that of the best shape: 1 for a rectangle or an
    equilateral triangle, towards 0 unusable."""
    aspect_ratio: FloatArray
    """Longest side over shortest side: 1 for a square."""
    warp: FloatArray
    """Distance of the corners from their mean plane over the root of their area: 0 if plane."""


class Worst(NamedTuple):
    """An element and its measure."""

    element: int
    value: float


def measure(mesh: Mesh) -> Quality:
    """Measures of all elements."""
    x = mesh.points[mesh.elements[:, :4]]
    lengths = chord_lengths(mesh.points, mesh.elements)
    normals = diagonal_normals(x)
    # The mean plane halves the distance between the two diagonals.
    apart = 0.25 * np.abs(((x[:, 0] - x[:, 1] + x[:, 2] - x[:, 3]) * unit(normals)).sum(axis=1))
    return Quality(
        scaled_jacobian=scaled_jacobians(mesh.points, mesh.elements).min(axis=1)
        / np.where(is_triangle(mesh.elements), np.sin(np.pi / 3), 1.0),
        aspect_ratio=lengths.max(axis=1) / lengths.min(axis=1),
        warp=apart / np.sqrt(np.linalg.norm(normals, axis=1)),
    )


def worst(mesh: Mesh) -> dict[str, Worst]:
    """The worst element by each measure: least scaled Jacobian, greatest aspect ratio, greatest warp."""
    quality = measure(mesh)
    numbers = {
        "scaled_jacobian": int(np.argmin(quality.scaled_jacobian)),
        "aspect_ratio": int(np.argmax(quality.aspect_ratio)),
        "warp": int(np.argmax(quality.warp)),
    }
    return {name: Worst(element, float(getattr(quality, name)[element])) for name, element in numbers.items()}
