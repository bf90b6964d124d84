"""Triangles that are too long: they lock in membrane strains."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.mesh import Mesh
from magshell.units import LENGTH, show

# A thin strip that bends by about a radian loses 1 to 2 % where its triangles are twice as long as the root of radius
# times thickness, about 10 % at four times (`bent-triangles` on the element page).
LONG = 1.5


def doubts(mesh: Mesh, thickness: float, radius: float) -> Iterator[str]:
    """A warning if triangles are long against √(radius of curvature × thickness).

    Parameters
    ----------
    mesh : Mesh
    thickness, radius : float
        m; the smallest radius of the undeformed surface, which the shell may bend to the radius of its size.
    """
    corners = mesh.points[mesh.elements[mesh.triangles][:, :3]]
    if not len(corners):
        return
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    side, bent = float(np.median(longest)), mesh.size < radius
    suited = np.sqrt(min(radius, mesh.size) * thickness)
    if side > LONG * suited:
        where = "bends to a radius of its size" if bent else "is curved"
        yield (
            f"triangles have sides of {show(side, LENGTH)}, {side / suited:.1f} times √(radius × thickness): "
            f"where the shell {where} they are too stiff, by 1 to 2 % at twice, by about 10 % at four times; "
            f"take quadrilaterals, or triangles of at most {show(suited, LENGTH)}"
        )
