"""Rotations in a picture of the problem: of groups that are turned, held sections, the field, magnets and coils."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import MagnetField, UniformField
from magshell.mesh.geometry import unit
from magshell.model.support import frame_about
from magshell.output.marks import SUPPORTS, Mark, Solids
from magshell.output.sources import REACH, pieces
from magshell.output.style import ACCENT

if TYPE_CHECKING:
    from magshell.model.model import Model

RADIUS = 0.11
"""Of an arc, over the size of the part."""
CLEAR = 1.2
"""Of an arc about magnets or coils, over their reach from its axis."""


def turn_marks(model: Model, size: float) -> list[Mark]:
    """An arc about the axis, with the angle, for each support that turns what it holds."""
    marks = []
    for number, support in enumerate(model.supports):
        spins = [one.value * one.direction for one in support.conditions() if one.field == "omega" and one.value]
        if not spins:
            continue
        spin = np.sum(spins, axis=0)
        angle = float(np.linalg.norm(spin))
        axis = spin / angle
        frame = frame_about(axis)
        mark = _arc(
            "", SUPPORTS[number % len(SUPPORTS)], _centre(model, support.group), axis, frame[1], angle, RADIUS * size
        )
        marks.append(mark)
    return marks


def field_turns(model: Model, arrows: Sequence[Mark], size: float) -> list[Mark]:
    """An arc for each stage that turns a uniform field, about the tail of its arrows."""
    if not arrows:
        return []
    tail = arrows[0].places[0] - 0.5 * arrows[0].vectors[0]
    return [
        _arc(f"field turns by {degrees(angle)} in stage {stage + 1}", ACCENT, tail, axis, start, angle, RADIUS * size)
        for stage, axis, start, angle in _turned(model)
    ]


def source_turns(model: Model, part: FloatArray, size: float) -> list[Mark]:
    """An arc for each stage that turns magnets or coils, about their axis and around them.

    Its centre is the point of the axis that moves with them.

    Those far from the points (n, 3) of the part are left out, as their sources are.
    """
    middle = 0.5 * (part.min(axis=0) + part.max(axis=0))
    marks = []
    for field in getattr(model.field, "fields", [model.field]):
        if not isinstance(field, MagnetField) or field.motion.rotation_axis is None:
            continue
        axis = np.asarray(field.motion.rotation_axis)
        for stage, (before, after) in enumerate(pairwise(field.ends(len(model.stages)))):
            angle, pivot = float((after - before)[-1]), field.pivot(before)
            if angle and np.linalg.norm(pivot - middle) < REACH * size:
                words = f"{field.name} turns by {degrees(angle)} in stage {stage + 1}"
                around = CLEAR * _reach(field, before, pivot, axis)
                radius = max(RADIUS * size, around if around < REACH * size else 0.0)
                marks.append(_arc(words, ACCENT, pivot, axis, frame_about(axis)[1], angle, radius))
    return marks


def _reach(field: MagnetField, amounts: FloatArray, pivot: FloatArray, axis: FloatArray) -> float:
    """The largest distance of sources from an axis through a point."""
    arms = np.concatenate([np.asarray(piece.surface.points, dtype=float) for piece in pieces(field, amounts)]) - pivot
    return float(np.linalg.norm(arms - np.outer(arms @ axis, axis), axis=1).max())


def _turned(model: Model) -> Iterator[tuple[int, FloatArray, FloatArray, float]]:
    """Stage, axis, direction at its start and angle of each turn."""
    for field in getattr(model.field, "fields", [model.field]):
        if not isinstance(field, UniformField) or field.rotation is None:
            continue
        angles = field.ends(len(model.stages))[:, 1]
        for stage, (before, after) in enumerate(pairwise(angles)):
            flux = field.turned(before)
            across = flux - (flux @ field.axis) * field.axis
            if after != before and np.linalg.norm(across) > 1e-9 * field.magnitude:
                yield stage, field.axis, unit(across[None])[0], float(after - before)


def _arc(
    name: str, colour: str, centre: FloatArray, axis: FloatArray, start: FloatArray, angle: float, radius: float
) -> Mark:
    mark = Mark(name, colour, Solids.TURNS, centre[None], radius * axis[None], start=start, angle=angle)
    if name:
        return mark
    middle = mark.arc[len(mark.arc) // 2]
    return Mark(
        name, colour, Solids.TURNS, centre[None], radius * axis[None], start=start, angle=angle,
        letters=[(degrees(abs(angle)), centre + 1.25 * (middle - centre), (0.0, 0.0))],
    )  # fmt: skip


def _centre(model: Model, group: str) -> FloatArray:
    mesh = model.shell.mesh
    for body in model.shell.rigid:
        if body.name == group:
            return body.reference_point(mesh)
    return np.asarray(mesh.points[model.shell.nodes_of(group)].mean(axis=0))


def degrees(angle: float) -> str:
    """An angle for people."""
    return f"{np.degrees(angle):.4g}°"
