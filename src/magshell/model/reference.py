"""What a model is made of, element by element, as the shell's kernels read it."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.materials import Material
from magshell.model.model import Model
from magshell.model.shell import Shell
from magshell.shell.body import Make, Reference, Surface, of_elements, reference_of
from magshell.shell.geometry import Sections, least_shifts
from magshell.shell.shear_profile import Moduli, profile
from magshell.shell.ties import RIGID, Ties


def reference_of_model(model: Model, make: Make) -> Reference:
    """The arrays of the undeformed shell, made of what `make_of` says.

    Raises
    ------
    InputError
        The shell is thicker than its curvature allows.
    """
    shell, elements, rows = model.shell, model.shell.mesh.elements, model.rows
    surface = Surface(
        elements=rows.elements,
        ties=_ties_of(model),
        points=shell.mesh.points[elements],
        normals=rows.normals[rows.elements],
        element=shell.element,
        micro_rotation=shell.micro_rotation,
    )
    reference = reference_of(surface, make)
    _check_thickness(model, least_shifts(reference.geometry, faces_of(model.shell)))
    return reference


def _ties_of(model: Model) -> Ties:
    """What ties the rows, as the kernels read it."""
    rows, shell = model.rows, model.shell
    kind, body = rows.kind[rows.elements], rows.body[rows.elements]
    host = np.tile(np.arange(8), (len(kind), 1))
    bare = (kind == RIGID) & ~shell.carriers["omega"][shell.mesh.elements]
    for element, node in np.argwhere(bare).tolist():
        able = np.flatnonzero((body[element] == body[element, node]) & ~bare[element])
        if not able.size:
            raise InputError(
                f"rigid body: node {rows.of[rows.elements[element, node]]} is a mid-side node and no corner of element "
                f"{element} belongs to the body; add the ends of its edge to the group"
            )
        host[element, node] = able[0]
    arm = np.where(rows.body[:, None] >= 0, rows.points - rows.points[rows.body], 0.0)
    return Ties(kind, host, rows.body, arm)


def make_of(model: Model) -> Make:
    """Thickness, material and laws of each element, from the parts of the shell."""
    shell, parts, count = model.shell, model.shell.parts, len(model.shell.mesh.elements)
    most, points = max(part.levels * len(part.layers) for part in parts), parts[0].remanence.shape[1]
    thickness, levels, by_level = np.empty(count), np.empty(count, dtype=np.int64), np.empty(count, dtype=bool)
    z, heights, warping = (np.zeros((count, points, most)) for _ in range(3))
    material_of, remanence = np.zeros((count, most), dtype=np.int64), np.zeros((count, points, most, 3))
    materials: list[Material] = []
    for part in parts:
        parent, weights = np.polynomial.legendre.leggauss(part.levels)
        own = part.levels * len(part.layers)
        # A level past the last of a part repeats its first, with no height.
        layer = np.append(np.repeat(np.arange(len(part.layers)), part.levels), np.zeros(most - own, dtype=np.int64))
        gauss = np.append(np.tile(np.arange(part.levels), len(part.layers)), np.zeros(most - own, dtype=np.int64))
        height = part.at_points[:, :, layer]
        bottoms = bottoms_of(part.at_points, part.offset_at_points)
        at = part.elements
        z[at] = bottoms[:, :, layer] + 0.5 * height * (1.0 + parent[gauss])
        heights[at, :, :own] = 0.5 * height[..., :own] * weights[gauss[:own]]
        thickness[at] = part.at_points.sum(axis=2).mean(axis=1)
        levels[at], by_level[at] = own, part.layered or shell.thickness_stretch == "plane-stress"
        remanence[at] = part.remanence[:, :, layer]
        material_of[at] = len(materials) + layer
        if part.layered:
            moduli = [Moduli.of(one.material) for one in part.layers]
            warping[at, :, :own] = profile(part.at_points, moduli, parent, weights)
        materials += [one.material for one in part.layers]
    return Make(
        thickness=thickness,
        sections=Sections(z, heights),
        levels=levels,
        by_level=by_level,
        warping=warping,
        remanence=remanence,
        materials=materials,
        material_of=material_of,
        couplings=[model.coupling],
        coupling_of=np.zeros((count, most), dtype=np.int64),
    )


def bottoms_of(layers: FloatArray, offset: FloatArray) -> FloatArray:
    """z (..., layers) of the bottom of each layer, from the mesh, for layers (..., layers) and offsets (...), m."""
    tops = np.cumsum(layers, axis=-1) - 0.5 * layers.sum(axis=-1, keepdims=True) - offset[..., None]
    return np.asarray(tops - layers)


def faces_of(shell: Shell) -> FloatArray:
    """z of the two faces at the integration points (elements, p, 2), from the mesh, m."""
    faces = np.empty((len(shell.mesh.elements), shell.parts[0].at_points.shape[1], 2))
    for part in shell.parts:
        half = 0.5 * part.at_points.sum(axis=2)
        faces[part.elements] = np.stack([-half, half], axis=2) - part.offset_at_points[..., None]
    return faces


def stiffest_of(make: Make) -> FloatArray:
    """Largest modulus of each element's levels (elements, levels), Pa."""
    return 2.0 * of_elements(make, "shear_modulus") + of_elements(make, "lame_lambda")


def _check_thickness(model: Model, shifts: FloatArray) -> None:
    """A shell with a face beyond a centre of curvature has layers that overlap."""
    bad = np.flatnonzero((shifts <= 0.0).any(axis=(1, 2)))
    if bad.size:
        what = "thickness is" if not any(part.offset_at_points.any() for part in model.shell.parts) else "a face lies"
        how = "larger than" if what == "thickness is" else "farther from the mesh than"
        raise InputError(
            f"shell: {what} {how} the curvature of element {bad[0]} allows (it would overlap itself inside)"
        )
