"""Likely slips in a model: implausible magnitudes, and what has no effect."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.magnetics.remanence.sampled import averaged
from magshell.mesh.geometry import centres
from magshell.mesh.quality import worst
from magshell.model import coupling_limit, own_field_limit, symmetry
from magshell.model.doubts import loads, mesh_error, needles, parts, rotations, triangles
from magshell.model.doubts.asked import Asked
from magshell.model.doubts.figures import Figures, Whole, figures_of
from magshell.model.shell import Shell
from magshell.units import ANGLE, FLUX_DENSITY, LENGTH, STRESS, show
from magshell.wording import counted

LARGE, SMALL = 1.0, 1e-5
"""Extents, m, beyond which a shell in a magnetic field is implausible."""
STILL = 0.01
"""Bending load, or load of forces and moments, of a strip whose end turns by less than a third of a degree."""
KEPT = 1.5
"""Largest remanence of any magnet, T."""


def doubts(model: Asked) -> list[str]:
    """Likely slips, a sentence each; an empty list if none is found."""
    return list(_doubts(model))


def _doubts(model: Asked) -> Iterator[str]:
    figures, shell = figures_of(model), model.shell
    for part in figures.parts:
        where = "" if len(figures.parts) == 1 else f"region '{part.name}': "
        yield from (where + doubt for doubt in _of_part(part))
    yield from _of_size(model, figures)
    yield from _of_field(model, figures)
    yield from parts.doubts(shell)
    yield from coupling_limit.reached(shell, model.coupling, model.largest_field)
    yield from own_field_limit.reached(shell, model.field)
    yield from _of_places(shell)
    yield from loads.doubts(model, loads.strength(model, figures))
    yield from rotations.doubts(model)
    yield from needles.doubts(model)
    yield from symmetry.broken(model)
    if model.constraints.fixed[:, :3].all():
        yield "the supports hold every node: the displacement is given everywhere, nothing is left to move"
    yield from triangles.doubts(shell.mesh, figures.thickest, figures.radius)
    worst_corner = worst(shell.mesh)["scaled_jacobian"]
    if worst_corner.value < 0.2:
        yield f"element {worst_corner.element} is badly shaped (scaled Jacobian {worst_corner.value:.2g})"
    yield from mesh_error.doubts(model)
    if not model.probe_nodes:
        yield "there are no probes: the history will hold the load only"


def _of_part(part: Figures) -> Iterator[str]:
    """Those of one part."""
    if part.extent < 5.0 * part.thickest:
        yield f"L/h is {part.extent / part.thickest:.3g}: too thick for a shell; check shell.thickness and the mesh"
    if part.slenderness > 1e4:
        yield f"L/h is {part.slenderness:.3g}: thinner than any film; check shell.thickness and the mesh"
    if part.radius < 2.0 * part.thickest:
        yield f"R/h is {part.radius / part.thickest:.3g}: curved too tightly for its thickness"
    for modulus in sorted({part.softest, part.stiffest}):
        if modulus < 1e3:
            yield f"the shear modulus is {show(modulus, STRESS)}: softer than a gel; check material.shear_modulus"
        if modulus > 1e10:
            yield f"the shear modulus is {show(modulus, STRESS)}: stiffer than magnesium; check material.shear_modulus"
    if part.poissons_ratio > 0.4999 + 1e-9:
        yield f"Poisson's ratio is {part.poissons_ratio:.6g}: nearly incompressible, slow to converge"


def _of_size(model: Asked, figures: Whole) -> Iterator[str]:
    """A shell in a field that is as large as a house or as small as a cell."""
    if not (figures.field and model.shell.magnetised):
        return
    extent = show(figures.extent, LENGTH)
    if figures.extent > LARGE:
        yield f"the shell is {extent} long: larger than what moves in a magnetic field; check the units of length"
    if figures.extent < SMALL:
        yield f"the shell is {extent} long: smaller than a cell; check the units of length"


def _of_field(model: Asked, figures: Whole) -> Iterator[str]:
    """Magnitudes of field and remanence, and what they do together."""
    if figures.field > 5.0:
        yield f"the field is {show(figures.field, FLUX_DENSITY)}: beyond most laboratories; check field.flux_density"
    strongest = max(float(np.linalg.norm(part.remanence, axis=-1).max()) for part in model.shell.parts)
    if strongest > KEPT:
        yield f"the remanence is {show(strongest, FLUX_DENSITY)}: more than any magnet keeps"
    magnets = any(np.any(body.moment) for body in model.shell.rigid)
    if figures.field and not figures.strongest and model.shell.magnetised:
        yield "the remanence of the layers has no mean: the undeformed shape feels no couple"
    elif figures.field and not figures.strongest and not magnets:
        yield "there is a field but no remanence: the field does nothing"
    elif figures.field and not magnets and figures.couple < 1e-9 * figures.field * figures.strongest:
        alone = not model.loads and not np.any(model.constraints.values)
        stays = ", so it stays as it is" if alone else ""
        yield (
            f"the field is parallel to the remanence everywhere: the undeformed shape feels no couple{stays}. Where it "
            "should buckle, try magshell buckling, or tilt the field by 1\u00b0"
        )
    elif figures.field and not magnets and figures.bending_load < STILL:
        yield (
            f"the bending load is {figures.bending_load:.2g}: the field turns the end of a strip of this length by "
            f"{show(0.5 * figures.bending_load, ANGLE, 2)}, so the shell will hardly move; check the units, such as "
            "MPa for kPa"
        )
    elif figures.bending_load > 1e5:
        yield f"the bending load is {figures.bending_load:.2g}: far beyond any experiment; check the units"


def _of_places(shell: Shell) -> Iterator[str]:
    """Elements whose remanence is the mean of several places of a table."""
    points = centres(shell.mesh.points, shell.mesh.elements)[:, None]
    elements = averaged(shell.overall_remanence, shell.mesh, points)
    if elements.size:
        yield (
            f"remanence: {counted(len(elements), 'element')} (first element {elements[0]}) with several places of the "
            "table as near: the mean is taken. Give places at the centres of the elements"
        )
