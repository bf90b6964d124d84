"""Mirror planes in words: how the other half is magnetised, and remanences that say something else there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.remanence import REMANENCES
from magshell.mesh import Mesh
from magshell.mesh.geometry import centres
from magshell.model import symmetry
from magshell.model.reflection import TYPED, polar
from magshell.model.symmetry import MIRRORED, REVERSED, Plane
from magshell.problem.building import Problem
from magshell.units import FLUX_DENSITY
from magshell.wording import quantity

WORDS = {MIRRORED: "mirrored", REVERSED: "mirrored and reversed"}


def other_half(problem: Problem, plane: Plane) -> str:
    """How the other half is magnetised, to be added to the support; empty without field or remanence."""
    model = problem.model
    if not model.field_magnitude or not model.shell.magnetised:
        return ""
    sign = symmetry.remanence_sign(model, plane)
    return "" if sign is None else f"; the other half has the remanence {WORDS[sign]}"


def doubts(problem: Problem) -> Iterator[str]:
    """Mirror planes that the remanence of the whole part breaks."""
    entries, model = problem.file.remanence, problem.model
    if model.shell.overall_remanence is not model.shell.remanence:
        return
    if not model.field_magnitude or len(entries) != 1 or entries[0].group or not REMANENCES[entries[0].kind].in_space:
        return
    for plane in symmetry.planes(model):
        sign = symmetry.remanence_sign(model, plane)
        if sign is not None:
            yield from _of_remanence(problem, plane, sign)


def _of_remanence(problem: Problem, plane: Plane, sign: int) -> Iterator[str]:
    """A remanence of the whole part whose formula beyond the plane gives something else than the image."""
    shell, kind = problem.model.shell, problem.file.remanence[0].kind
    points = centres(shell.mesh.points, shell.mesh.elements)[:, None]
    height = float((shell.mesh.points[plane.nodes] @ plane.normal).mean())
    beyond = Mesh(_image(shell.mesh.points, plane, height), shell.mesh.elements)
    try:
        there = shell.remanence(beyond, _image(points, plane, height))[:, 0]
    except InputError:
        return
    image = sign * polar(shell.remanence(shell.mesh, points)[:, 0], plane.normal)
    gap = np.linalg.norm(there - image, axis=1)
    worst = int(np.argmax(gap))
    if gap[worst] > 2.0 * TYPED * np.linalg.norm(image, axis=1).max():
        says, needed = (
            quantity(tuple(np.where(np.abs(b) > 1e-9 * np.abs(b).max(), b, 0.0).tolist()), FLUX_DENSITY)
            for b in (there[worst], image[worst])
        )
        yield (
            f"symmetry '{plane.group}': at the image of element {worst} the remanence '{kind}' would be {says}, but "
            f"with this field the other half has it {WORDS[sign]}: {needed}. Model the whole part if that is not meant"
        )


def _image(points: FloatArray, plane: Plane, height: float) -> FloatArray:
    return polar(points, plane.normal) + 2.0 * height * plane.normal
