"""A rule of thumb for the discretisation error of a mesh, before anything is solved.

The relative error of the largest displacement is taken as the sum of three shares:

* bending, 1.5 % (a √q / L)^1.5 with the element size a in the direction of bending, the extent L and the load
  q = 12 τ (L/h)² / E, at least 1, of the largest couple τ on the most flexible part: under large loads the bending sits
  in layers as long as L/√q;
* curvature, 0.4 % (a² / R h)^1.5 with the smallest radius of curvature R, for the edge disturbances of curved shells;
* width, 3 % (2 ν)² / N⁵ with N elements from edge to edge, since nearly incompressible strips also curl across.

It holds for the element type `quadratic`. The numbers are fitted to the convergence studies of `docs/how-accurate.md`;
`docs/make_mesh_study.py` compares them with refined meshes of the built-in problems. What supports prescribe and what
acts on rigid bodies is not counted.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import UniformField
from magshell.mesh import Mesh
from magshell.mesh.across import elements_across
from magshell.mesh.geometry import centres, diagonal_normals, unit
from magshell.model.doubts.asked import Asked
from magshell.model.doubts.figures import VACUUM_PERMEABILITY, figures_of
from magshell.model.doubts.loads import strength
from magshell.model.supports import mirror_planes
from magshell.shell.elements import QUADRATIC

STEPS = (0.001, 0.003, 0.01, 0.03, 0.1)
"""Errors that are told: each stands for all from the one before it."""
COARSE = STEPS[-1]
"""Error from which on a mesh is called coarse."""
MOST = 0.9
"""Share of the elements that are no larger than the size that counts."""


def expected_error(model: Asked) -> float | None:
    """Expected relative error of the largest displacement; None for an element type that the rule does not hold for."""
    shell, mesh = model.shell, model.shell.mesh
    if shell.element.name not in (QUADRATIC.name, getattr(QUADRATIC.with_triangles, "name", "")):
        return None
    figures = figures_of(model)
    area = float(np.linalg.norm(diagonal_normals(mesh.points[mesh.elements]), axis=1).sum())
    loads = strength(model, figures).overall * figures.extent**2 / area
    couple = figures.field * figures.strongest / VACUUM_PERMEABILITY * figures.thickest
    couples = 12.0 * couple * figures.extent**2 / figures.most_flexible.bending_stiffness
    load = max(couples, loads, 1.0)
    size = float(np.quantile(_along_the_bending(model), MOST))
    largest = float(np.quantile(_sides(mesh).max(axis=1), MOST))
    mirrored = np.zeros(len(mesh.points), dtype=bool)
    for plane in mirror_planes(model.supports, shell.rigid):
        mirrored[shell.nodes_of(plane.group)] = True
    ratio = max(part.poissons_ratio for part in figures.parts)
    bending = 0.015 * (size * math.sqrt(load) / figures.extent) ** 1.5
    curvature = 0.004 * (largest**2 / (figures.radius * figures.thickest)) ** 1.5
    width = 0.03 * (2.0 * ratio) ** 2 / elements_across(mesh, mirrored) ** 5
    return bending + curvature + width


def doubts(model: Asked) -> Iterator[str]:
    """Whether the mesh is coarse."""
    error = expected_error(model)
    if error is not None and error > COARSE:
        yield f"the mesh is coarse: its expected error is {in_words(error)}. Take smaller elements"


def in_words(error: float | None) -> str:
    """An expected error as `magshell check` tells it: the next larger one of `STEPS`."""
    if error is None:
        return "not known for this element type"
    larger = [step for step in STEPS if error <= step]
    share = f"up to about {100.0 * larger[0]:g} %" if larger else f"more than {100.0 * STEPS[-1]:g} %"
    return f"{share} of the largest displacement (rule of thumb)"


def _along_the_bending(model: Asked) -> FloatArray:
    """Extent (elements,) of each element in the direction in which the field's couple bends it, or the largest, m."""
    shell, mesh, field = model.shell, model.shell.mesh, model.field
    largest = _sides(mesh).max(axis=1)
    if not isinstance(field, UniformField) or not field.magnitude:
        return largest
    remanence = shell.overall_remanence(mesh, centres(mesh.points, mesh.elements)[:, None])[:, 0]
    x = mesh.points[mesh.elements]
    bending = np.cross(unit(diagonal_normals(x)), np.cross(remanence, field.vector))
    size = np.linalg.norm(bending, axis=1)
    extent = np.ptp(np.einsum("eci,ei->ec", x[:, :4], unit(bending)), axis=1)
    bent = size > 0.1 * size.max()
    return np.asarray(extent[bent]) if bent.any() else largest


def _sides(mesh: Mesh) -> FloatArray:
    """Straight lengths (elements, 4) of the sides, m."""
    corners = mesh.points[mesh.elements[:, :4]]
    lengths: FloatArray = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    return lengths
