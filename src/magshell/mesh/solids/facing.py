"""Elements turned to face as a solid's side does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import is_triangle
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.orientation import TURNED_QUAD, TURNED_TRIANGLE
from magshell.mesh.geometry import diagonal_normals

PARALLEL = 1e-3
"""Normals whose moments have no greater ratio are one and the same."""


def facing(mesh: FileMesh, normals: FloatArray) -> FileMesh:
    """The mesh with each connected part turned to the side of given normals (nodes, 3)."""
    own = diagonal_normals(mesh.points[mesh.elements[:, :4]])
    agree = (own * normals[mesh.elements[:, :4]].sum(axis=1)).sum(axis=1)
    elements = mesh.elements.copy()
    triangle = is_triangle(elements)
    for part in mesh.parts:
        if agree[part].sum() < 0.0:
            for chosen, order in ((part[~triangle[part]], TURNED_QUAD), (part[triangle[part]], TURNED_TRIANGLE)):
                elements[chosen] = elements[chosen][:, order]
    return mesh if np.array_equal(elements, mesh.elements) else replace(mesh, elements=elements)


def along_all(normals: FloatArray, nodes: IntArray, count: int) -> FloatArray:
    """The least vectors (count, 3) whose component along each normal (k, 3) of a node, `nodes` (k,), is 1."""
    moments, sums = np.zeros((count, 3, 3)), np.zeros((count, 3))
    np.add.at(moments, nodes, normals[:, :, None] * normals[:, None, :])
    np.add.at(sums, nodes, normals)
    found: FloatArray = np.einsum("nij,nj->ni", np.linalg.pinv(moments, rcond=PARALLEL, hermitian=True), sums)
    return found
