"""What a model is made of, element by element, as the shell's kernels read it."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.materials import Material
from magshell.model.model import Model
from magshell.shell.body import Make, Reference, Surface, of_elements, reference_of
from magshell.shell.geometry import Sections, least_shifts


def reference_of_model(model: Model, make: Make) -> Reference:
    """The arrays of the undeformed shell, made of what `make_of` says.

    Raises
    ------
    InputError
        The shell is thicker than its curvature allows.
    """
    shell, elements = model.shell, model.shell.mesh.elements
    surface = Surface(
        elements, shell.mesh.points[elements], model.normals[elements], shell.element, shell.micro_rotation
    )
    reference = reference_of(surface, make)
    _check_thickness(least_shifts(reference.geometry, make.thickness))
    return reference


def make_of(model: Model) -> Make:
    """Thickness, material and laws of each element, from the parts of the shell."""
    parts, count = model.shell.parts, len(model.shell.mesh.elements)
    levels = max(part.levels * len(part.layers) for part in parts)
    points = parts[0].remanence.shape[1]
    thickness, z, heights = np.empty(count), np.zeros((count, levels)), np.zeros((count, levels))
    material_of, remanence = np.zeros((count, levels), dtype=np.int64), np.zeros((count, points, levels, 3))
    materials: list[Material] = []
    for part in parts:
        parent, weights = np.polynomial.legendre.leggauss(part.levels)
        of_layers = part.at_points.mean(axis=1)
        thickness[part.elements] = of_layers.sum(axis=1)
        below = -0.5 * thickness[part.elements] - part.offset_at_points.mean(axis=1)
        for number, layer in enumerate(part.layers):
            at = np.arange(number * part.levels, (number + 1) * part.levels)
            half = 0.5 * of_layers[:, number, None]
            z[np.ix_(part.elements, at)] = (below[:, None] + half) + half * parent
            heights[np.ix_(part.elements, at)] = half * weights
            material_of[np.ix_(part.elements, at)] = len(materials)
            remanence[part.elements[:, None], :, at] = part.remanence[:, None, :, number]
            below = below + of_layers[:, number]
            materials.append(layer.material)
    return Make(
        thickness=thickness,
        sections=Sections(z, heights),
        remanence=remanence,
        materials=materials,
        material_of=material_of,
        couplings=[model.coupling],
        coupling_of=np.zeros((count, levels), dtype=np.int64),
        plane_stress=model.shell.thickness_stretch == "plane-stress",
    )


def stiffest_of(make: Make) -> FloatArray:
    """Largest modulus of each element's levels (elements, levels), Pa."""
    return 2.0 * of_elements(make, "shear_modulus") + of_elements(make, "lame_lambda")


def _check_thickness(shifts: FloatArray) -> None:
    """A shell thicker than twice a radius of curvature has layers that overlap."""
    bad = np.flatnonzero((shifts <= 0.0).any(axis=(1, 2)))
    if bad.size:
        raise InputError(
            f"shell: thickness is larger than the curvature of element {bad[0]} allows (it would overlap itself inside)"
        )
