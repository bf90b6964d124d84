"""The mid-surface of a body of a CAD file: one side as gmsh has it, moved by half the thickness along its normals."""

from __future__ import annotations

import pathlib
from dataclasses import replace
from typing import Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.drawings.reading import chosen_size
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import ATTEMPTS, best, name_entity, use_size
from magshell.mesh.files.session import session
from magshell.mesh.solids.facing import along_all, facing
from magshell.mesh.solids.pairing import Sides, sides_of
from magshell.mesh.solids.skin import Skin, skin_from

DIVISIONS = 25
"""Of the size of a body: triangles that its thickness is measured with."""
AROUND = 48
"""Triangles around a full turn."""
_FACE = "face of the body "


def mid_surface_of_body(
    path: pathlib.Path, name: str, size: float | None, unit: str, millimetres: float
) -> tuple[FileMesh, Sides]:
    """Mesh the mid-surface of the bodies of a geometry; gmsh is to be in a process of its own.

    Parameters
    ----------
    path : pathlib.Path
    name : str
        Of the file, for messages.
    size : float or None
        Of elements, m.
    unit : str
        Of the file.
    millimetres : float
        Its length.
    """
    with session(name) as gmsh:
        gmsh.open(str(path))
        gmsh.model.occ.synchronize()
        bodies = gmsh.model.getEntities(3)
        if not bodies:
            raise InputError(f"{name}: holds no solid; if it is a surface, leave mid_surface out")
        skin, face = _triangulated(gmsh, millimetres, name)
        sides = sides_of(skin, face, name)
        upper = np.unique(face[sides.upper]).tolist()
        outward = {tag: _outward(gmsh, skin, np.flatnonzero(face == tag)[0], tag, millimetres) for tag in upper}
        sides = _measured(gmsh, sides, face, outward, millimetres)
        gmsh.model.mesh.clear()
        gmsh.model.removeEntities(bodies)
        others = [pair for pair in gmsh.model.getEntities(2) if pair[1] not in upper]
        gmsh.model.removeEntities(others, recursive=True)
        if not gmsh.model.getPhysicalGroups(2) and not gmsh.model.getPhysicalGroups(1):
            for dimension in (2, 1):
                for _, entity in gmsh.model.getEntities(dimension):
                    name_entity(gmsh, dimension, entity)
        for tag in upper:
            gmsh.model.addPhysicalGroup(2, [tag], name=f"{_FACE}{tag}")
        area = float(skin.areas[sides.upper].sum())
        use_size(gmsh, chosen_size(size, area) / millimetres, area / millimetres**2, unit)
        mesh = best(gmsh, name, unit, False, ATTEMPTS)
        return _moved(gmsh, mesh, sides, outward, 1e-3 * millimetres), sides


def _triangulated(gmsh: Any, millimetres: float, name: str) -> tuple[Skin, IntArray]:
    """The skin of all bodies, mm, and the number of the face of each triangle."""
    low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    option = gmsh.option.setNumber
    option("Mesh.MeshSizeMax", float(np.linalg.norm(high - low)) / DIVISIONS)
    option("Mesh.MeshSizeFromCurvature", AROUND)
    option("Mesh.RecombineAll", 0)
    option("Mesh.ElementOrder", 1)
    option("Mesh.Algorithm", 6)
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(max(tags)) + 1, dtype=np.int64)
    place[np.asarray(tags, dtype=np.int64)] = np.arange(len(tags))
    triangles, face = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    for _, tag in gmsh.model.getBoundary(gmsh.model.getEntities(3), oriented=False):
        nodes = gmsh.model.mesh.getElementsByType(2, tag)[1]
        own = place[np.asarray(nodes, dtype=np.int64)].reshape(-1, 3)
        triangles.append(own)
        face.append(np.full(len(own), tag))
    points = millimetres * np.reshape(coordinates, (-1, 3))
    every, owner = np.concatenate(triangles), np.concatenate(face)
    skin = skin_from(points, every, name)
    if len(skin.triangles) != len(every):
        raise InputError(f"{name}: has faces so narrow that their thickness cannot be measured")
    return skin, owner


def _outward(gmsh: Any, skin: Skin, triangle: int, tag: int, millimetres: float) -> float:
    """1, or -1 where gmsh's normal of a face points into the body."""
    centre = skin.corners[triangle].mean(axis=0) / millimetres
    normal, _ = _normals(gmsh, tag, centre[None])
    return float(np.sign(normal[0] @ skin.normals[triangle]))


def _normals(gmsh: Any, tag: int, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Normals of a face nearest to points (n, 3), and the nearest points."""
    nearest, parameters = gmsh.model.getClosestPoint(2, tag, points.ravel())
    return np.reshape(gmsh.model.getNormal(tag, parameters), (-1, 3)), np.reshape(nearest, (-1, 3))


def _measured(gmsh: Any, sides: Sides, face: IntArray, outward: dict[int, float], millimetres: float) -> Sides:
    """The thickness between the true faces, at the corners of the triangles."""
    lower = np.unique(face[sides.lower]).tolist()
    found = []
    for tag in outward:
        _, coordinates, _ = gmsh.model.mesh.getNodes(2, tag, includeBoundary=True)
        points = np.reshape(coordinates, (-1, 3))
        ways = [np.linalg.norm(_normals(gmsh, other, points)[1] - points, axis=1) for other in lower]
        every = millimetres * np.array(ways)
        nearest = np.abs(every - sides.thickness).argmin(axis=0)
        found.append(every[nearest, np.arange(len(points))])
    distance = np.concatenate(found)
    distance = distance[np.abs(distance - sides.thickness) <= 0.02 * sides.thickness]
    if not len(distance):
        return sides
    return sides._replace(
        thickness=float(np.median(distance)), least=float(distance.min()), greatest=float(distance.max()), coarse=0.0
    )


def _moved(gmsh: Any, mesh: FileMesh, sides: Sides, outward: dict[int, float], metres: float) -> FileMesh:
    """The mesh of the upper side, m, moved inward by half the thickness."""
    normals, nodes = [], []
    for tag, sign in outward.items():
        own = mesh.nodes_of(f"{_FACE}{tag}")
        normals.append(sign * _normals(gmsh, tag, mesh.points[own] / metres)[0])
        nodes.append(own)
    every, where = np.concatenate(normals), np.concatenate(nodes)
    away = along_all(every, where, len(mesh.points))
    groups = {name: own for name, own in mesh.element_groups.items() if not name.startswith(_FACE)}
    changes = tuple(change for change in mesh.origin.changes if _FACE not in change)
    points = mesh.points - 0.5e-3 * sides.thickness * away
    moved = replace(mesh, points=points, element_groups=groups, origin=replace(mesh.origin, changes=changes))
    return facing(moved, away)
