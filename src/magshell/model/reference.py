"""What a model is made of, element by element, as the shell's kernels read it."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.model.model import Model
from magshell.shell.body import Make, Reference, Surface, of_elements, reference_of
from magshell.shell.geometry import Sections, least_shifts

# Gauss points through the thickness.
LEVELS = 2


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
    """Thickness, material and laws of each element, from the regions of the shell."""
    regions, count = model.shell.regions, len(model.shell.mesh.elements)
    parent, weights = np.polynomial.legendre.leggauss(LEVELS)
    thickness, material_of = np.empty(count), np.empty((count, LEVELS), dtype=np.int64)
    for number, region in enumerate(regions):
        thickness[region.elements], material_of[region.elements] = region.thickness, number
    half = 0.5 * thickness[:, None]
    remanence = model.shell.remanence_at_points
    return Make(
        thickness=thickness,
        sections=Sections(half * parent, half * weights),
        remanence=np.broadcast_to(remanence[:, :, None], (*remanence.shape[:2], LEVELS, 3)),
        materials=[region.material for region in regions],
        material_of=material_of,
        couplings=[model.coupling],
        coupling_of=np.zeros((count, LEVELS), dtype=np.int64),
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
