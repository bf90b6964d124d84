"""The closed skin of a solid: of a mesh of its skin, or of solid elements."""

from __future__ import annotations

import contextlib
import io
import pathlib
import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.files.apart import apart
from magshell.mesh.files.cells import MISSING
from magshell.mesh.files.contents import Contents
from magshell.mesh.files.orientation import agreeing
from magshell.mesh.geometry import unit
from magshell.units import shortened

SAME = 1e-7
"""Of the size: corners closer than this are one."""
_TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
_HEXAHEDRON = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_WEDGE = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_PYRAMID = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))
FACES = {
    **dict.fromkeys(("tetra", "tetra10"), _TETRAHEDRON),
    **dict.fromkeys(("hexahedron", "hexahedron20", "hexahedron27"), _HEXAHEDRON),
    **dict.fromkeys(("wedge", "wedge15", "wedge18"), _WEDGE),
    **dict.fromkeys(("pyramid", "pyramid13", "pyramid14"), _PYRAMID),
}
"""Corners of the faces of meshio's solid elements, seen from outside."""


@dataclass(frozen=True, eq=False)
class Skin:
    """Triangles that enclose a solid, seen from outside.

    Attributes
    ----------
    points : (n, 3)
    triangles : (m, 3)
    """

    points: FloatArray
    triangles: IntArray

    @cached_property
    def corners(self) -> FloatArray:
        """Positions (m, 3, 3)."""
        corners: FloatArray = self.points[self.triangles]
        return corners

    @cached_property
    def vectors(self) -> FloatArray:
        """Area times normal, (m, 3)."""
        x = self.corners
        return 0.5 * np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])

    @cached_property
    def areas(self) -> FloatArray:
        """(m,)."""
        return np.linalg.norm(self.vectors, axis=1)

    @cached_property
    def normals(self) -> FloatArray:
        """Outward, (m, 3)."""
        return unit(self.vectors)

    @cached_property
    def volume(self) -> float:
        """Of what it encloses."""
        return float((self.corners.mean(axis=1) * self.vectors).sum() / 3.0)

    @cached_property
    def size(self) -> float:
        """Diagonal of its box."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    @cached_property
    def neighbours(self) -> tuple[IntArray, IntArray]:
        """Number of the triangle beyond each side (m, 3), sides from corner 0 to 1 and so on, and of its side."""
        order, _ = _sides(self.triangles)
        one, other = order[0::2], order[1::2]
        beyond = np.empty(3 * len(self.triangles), dtype=np.int64)
        beyond[one], beyond[other] = other, one
        return (beyond // 3).reshape(-1, 3), (beyond % 3).reshape(-1, 3)


def skin_from(points: FloatArray, triangles: IntArray, name: str) -> Skin:
    """Triangles in any sense made the skin of a solid.

    Raises
    ------
    InputError
        They do not enclose one: there is a free edge, or one with more than two triangles.
    """
    from scipy.spatial import cKDTree

    used = points[np.unique(triangles)]
    size = float(np.linalg.norm(np.ptp(used, axis=0))) if len(used) else 0.0
    if not (size > 0.0 and np.isfinite(size)):
        raise InputError(f"{name}: has no triangles of some size")
    pairs = cKDTree(points).query_pairs(SAME * size, output_type="ndarray")
    first = np.arange(len(points))
    np.minimum.at(first, pairs[:, 1], pairs[:, 0])
    triangles = first[first[triangles]]
    x = points[triangles]
    area = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)
    distinct = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1) & (area > 0.0)
    triangles = triangles[distinct]
    order, sharing = _sides(triangles)
    bad = np.flatnonzero(sharing != 2)
    if bad.size:
        ends = np.repeat(np.arange(len(sharing)), sharing)
        side = order[np.flatnonzero(ends == bad[0])[0]]
        corner = triangles[side // 3, [side % 3, (side + 1) % 3]]
        place = ", ".join(f"{value:.6g}" for value in points[corner].mean(axis=0))
        has = "one triangle" if sharing[bad[0]] == 1 else f"{sharing[bad[0]]} triangles"
        raise InputError(
            f"{name}: is not the closed skin of a solid: the edge at ({place}) has {has}, and "
            f"{len(bad) - 1} others have not two; repair it, or if it is a surface, leave mid_surface out"
        )
    none = np.full(len(triangles), MISSING)
    rows = np.column_stack([triangles, triangles[:, 2], none, none, triangles[:, 2], none])
    rows, turned, against = agreeing(rows)
    if against:
        raise InputError(f"{name}: is not the skin of a solid: the surface has one side only")
    skin = Skin(points, rows[:, :3])
    if turned:
        skin = Skin(points, _outward(skin))
    return Skin(points, skin.triangles[:, ::-1]) if skin.volume < 0.0 else skin


def _sides(triangles: IntArray) -> tuple[IntArray, IntArray]:
    """Numbers 3 t + s of the sides, those on one edge in a row, and how many these are."""
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys = ends[:, 0] * (int(triangles.max(initial=0)) + 1) + ends[:, 1]
    return np.argsort(keys, kind="stable"), np.unique(keys, return_counts=True)[1]


def _outward(skin: Skin) -> IntArray:
    """Triangles turned so that every connected part has a positive volume."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    beyond, _ = skin.neighbours
    count = len(skin.triangles)
    graph = coo_matrix((np.ones(3 * count), (np.repeat(np.arange(count), 3), beyond.ravel())), shape=2 * (count,))
    _, part = connected_components(graph, directed=False)
    volume = np.bincount(part, (skin.corners.mean(axis=1) * skin.vectors).sum(axis=1))
    triangles = skin.triangles.copy()
    inward = volume[part] < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return triangles


def skin_of_contents(contents: Contents, path: pathlib.Path, name: str, seconds: int) -> Skin:
    """The skin that a file holds, or that of its solid elements."""
    if contents.solids:
        points, triangles = apart(_boundary, path, name, program="meshio", name=name, seconds=seconds)
        return skin_from(points, triangles, name)
    faces = [block.kind.rows(block.nodes)[:, :4] for block in contents.blocks if block.kind.dimension == 2]
    if not faces:
        raise InputError(f"{name}: has neither solid elements nor a skin of triangles or quadrilaterals")
    return skin_from(contents.points, _split(np.concatenate(faces)), name)


def _split(quads: IntArray) -> IntArray:
    """Triangles (k, 3) of rows (n, 4), of which a triangle has its last corner twice."""
    both = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    triangles: IntArray = both[(both != np.roll(both, 1, axis=1)).all(axis=1)]
    return triangles


def _boundary(path: pathlib.Path, name: str) -> tuple[FloatArray, IntArray]:
    """Points, and triangles of the faces that only one solid element has."""
    try:
        import meshio
    except ImportError:
        raise InputError(
            f'{name}: solid elements are read through meshio, which is not installed: pip install "magshell[meshio]"'
        ) from None
    said = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            warnings.catch_warnings(action="ignore"),
        ):
            mesh = meshio.read(path)
    except SystemExit:
        raise InputError(f"{name}: meshio cannot read its solid elements") from None
    except Exception as error:
        raise InputError(f"{name}: meshio cannot read it: {shortened(' '.join(str(error).split()))}") from None
    quads: list[IntArray] = []
    for cells in mesh.cells:
        for face in FACES.get(cells.type, ()):
            corners = np.asarray(cells.data, dtype=np.int64)[:, list(face)]
            quads.append(corners if len(face) == 4 else np.column_stack([corners, np.full(len(corners), MISSING)]))
    if not quads:
        raise InputError(f"{name}: meshio finds no tetrahedra, hexahedra, wedges or pyramids in it")
    every = np.concatenate(quads)
    _, first, sharing = np.unique(np.sort(every, axis=1), axis=0, return_index=True, return_counts=True)
    points = np.asarray(mesh.points, dtype=np.float64)
    outer = every[np.sort(first[sharing == 1])]
    outer[:, 3] = np.where(outer[:, 3] == MISSING, outer[:, 2], outer[:, 3])
    return points, _split(outer)
