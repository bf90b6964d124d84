"""The mid-surface of a curved sheet that is given by triangles."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.drawings.reading import chosen_size
from magshell.mesh.files.apart import apart
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import ATTEMPTS, best, set_size
from magshell.mesh.files.cells import MISSING
from magshell.mesh.files.normals import side_normals
from magshell.mesh.files.session import session
from magshell.mesh.solids.facing import along_all, facing
from magshell.mesh.solids.locating import locator_of
from magshell.mesh.solids.pairing import Sides
from magshell.mesh.solids.skin import Skin

FOLD = 40.0
"""Degrees: where triangles meet at a greater angle gmsh sees an edge."""
GROUP = "sheet"


class Facets(NamedTuple):
    """Triangles that stand for a smooth surface.

    Attributes
    ----------
    points : (n, 3)
        mm.
    triangles : (m, 3)
    normals : (m, 3, 3)
        Of the smooth surface at the corners; those of one point differ where it has an edge.
    """

    points: FloatArray
    triangles: IntArray
    normals: FloatArray


def curved_mesh(skin: Skin, sides: Sides, name: str, size: float | None) -> FileMesh:
    """The mid-surface of a sheet, meshed by gmsh; lengths of the skin in mm, the size in m."""
    facets = _midway(skin, sides)
    area = float(skin.areas[sides.upper].sum())
    return apart(_meshed, facets, name, chosen_size(size, area), program="gmsh", name=name)


def _midway(skin: Skin, sides: Sides) -> Facets:
    """The upper side moved inward by half the thickness."""
    used, compact = np.unique(skin.triangles[sides.upper], return_inverse=True)
    points, triangles = skin.points[used], compact.reshape(-1, 3)
    none = np.full(len(triangles), MISSING)
    rows = np.column_stack([triangles, triangles[:, 2], none, none, triangles[:, 2], none])
    ends = side_normals(points, rows).normals.reshape(-1, 4, 2, 3)
    normals = ends[:, [0, 1, 3], 0]
    away = along_all(normals.reshape(-1, 3), triangles.ravel(), len(points))
    return Facets(points - 0.5 * sides.thickness * away, triangles, normals)


def _meshed(facets: Facets, name: str, size: float) -> FileMesh:
    with session(name) as gmsh:
        surface = gmsh.model.addDiscreteEntity(2)
        tags = np.arange(1, len(facets.points) + 1)
        gmsh.model.mesh.addNodes(2, surface, tags, facets.points.ravel())
        gmsh.model.mesh.addElementsByType(surface, 2, [], facets.triangles.ravel() + 1)
        angle = np.radians(FOLD)
        gmsh.model.mesh.classifySurfaces(angle, True, True, angle)
        gmsh.model.mesh.createGeometry()
        gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)], name=GROUP)
        set_size(gmsh, size, "mm", "")
        mesh = best(gmsh, name, "mm", False, ATTEMPTS)
    cell, weights = _on(facets, 1e3 * mesh.points)
    normals = np.einsum("kc,kci->ki", weights, facets.normals[cell])
    return facing(replace(mesh, points=1e-3 * _smooth(facets, cell, weights)), normals)


def _smooth(facets: Facets, cell: IntArray, weights: FloatArray) -> FloatArray:
    """Points of flat triangles on the smooth surface that these stand for.

    Over each triangle it is the cubic of Vlachos et al., "Curved PN triangles" (2001), which has the normals at the
    corners.
    """
    x, n = facets.points[facets.triangles[cell]], facets.normals[cell]
    result = np.einsum("kc,kci->ki", weights**3, x)
    middle = np.zeros_like(result)
    for i in range(3):
        for j in range(3):
            if i != j:
                rise = ((x[:, j] - x[:, i]) * n[:, i]).sum(axis=1, keepdims=True)
                control = (2.0 * x[:, i] + x[:, j] - rise * n[:, i]) / 3.0
                result += 3.0 * (weights[:, i] ** 2 * weights[:, j])[:, None] * control
                middle += control / 6.0
    middle += 0.5 * (middle - x.mean(axis=1))
    smooth: FloatArray = result + 6.0 * weights.prod(axis=1)[:, None] * middle
    return smooth


def _on(facets: Facets, points: FloatArray) -> tuple[IntArray, FloatArray]:
    """The nearest triangle of each point, and its area coordinates there."""
    from vtkmodules.vtkCommonCore import mutable

    locator = locator_of(facets.points, facets.triangles)
    cell = np.zeros(len(points), dtype=np.int64)
    near, number, part, square = [0.0] * 3, mutable(0), mutable(0), mutable(0.0)
    for row, point in enumerate(points.tolist()):
        locator.FindClosestPoint(point, near, number, part, square)
        cell[row] = int(number)
    x = facets.points[facets.triangles[cell]]
    one, other, away = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0], points - x[:, 0]
    normal = np.cross(one, other)
    square_of = (normal**2).sum(axis=1)
    second = (np.cross(away, other) * normal).sum(axis=1) / square_of
    third = (np.cross(one, away) * normal).sum(axis=1) / square_of
    weights = np.column_stack([1.0 - second - third, second, third]).clip(0.0, 1.0)
    return cell, weights / weights.sum(axis=1, keepdims=True)
