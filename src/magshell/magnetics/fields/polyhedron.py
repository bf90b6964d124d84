"""Magnets of flat faces, as magpylib has them: `Tetrahedron` and `TriangularMesh`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.magnetics.fields.magnets import POLARISATION, Magnet


@dataclass(frozen=True, eq=False)
class Polyhedron(Magnet):
    """A closed surface of triangles.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        m.
    triangles : array_like of int, shape (m, 3)
        Numbers of their vertices.
    polarisation : array_like, shape (3,)
        T.
    """

    vertices: ArrayLike
    triangles: ArrayLike
    polarisation: ArrayLike
    kind: ClassVar[str] = "polyhedron"
    keys: ClassVar = {"polarisation": POLARISATION}

    def __post_init__(self) -> None:
        self._numbers("vertices", (None, 3))
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.vertices, axis=1).max())

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import TriangularMesh

        return [(1.0, TriangularMesh(vertices=self.vertices, faces=self.triangles, polarization=self.polarisation))]

    def _signed(self, points: FloatArray) -> FloatArray:
        import pyvista

        found = pyvista.PolyData(points).compute_implicit_distance(self.surface())
        return np.asarray(found["implicit_distance"], dtype=float)

    def distance(self, points: FloatArray) -> FloatArray:
        return np.abs(self._signed(points))

    def inside(self, points: FloatArray) -> AnyArray:
        return np.asarray(self._signed(points) < 0.0)

    def surface(self) -> Any:
        import pyvista

        triangles = np.asarray(self.triangles)
        faces = np.insert(triangles, 0, 3, axis=1).ravel()
        surface = pyvista.PolyData(np.asarray(self.vertices, dtype=float), faces)
        return surface.compute_normals(auto_orient_normals=True, split_vertices=False, cell_normals=True)

    def words(self) -> str:
        return f"polyhedron of {len(np.asarray(self.triangles))} triangles, {self.given}"
