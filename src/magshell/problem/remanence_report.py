"""What the report says of a remanence: its sense, in words."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from magshell.magnetics.remanence.sampled import averaged
from magshell.mesh.geometry import centres
from magshell.problem import schema
from magshell.problem.building import Problem
from magshell.units import ANGLE, LENGTH, show
from magshell.wording import counted, vector


def doubts(problem: Problem) -> Iterator[str]:
    """Elements that have no place of their own."""
    shell = problem.model.shell
    points = centres(shell.mesh.points, shell.mesh.elements)[:, None]
    elements = averaged(shell.remanence, shell.mesh, points)
    if elements.size:
        yield (
            f"remanence: {counted(len(elements), 'element')} (first element {elements[0]}) with several places of the "
            "table as near: the mean is taken. Give places at the centres of the elements"
        )


def sense(entry: schema.Remanence) -> str:
    """Where an entry points."""
    match entry:
        case schema.ConstantRemanence():
            along = np.array(entry.direction if entry.vector is None else entry.vector)
            length = np.linalg.norm(along)
            return f"constant, along {vector(along / length)}" if length else "constant"
        case schema.MeridionalRemanence():
            mirrored = ", mirrored at the equator" if entry.mirrored else ""
            return f"meridional, away from the pole {vector(entry.axis)}{mirrored}"
        case schema.CircumferentialRemanence():
            return f"circumferential, about the axis {vector(entry.axis)}{_towards(entry.towards)}"
        case schema.RadialRemanence():
            return f"radial, {'towards' if entry.inward else 'away from'} the axis {vector(entry.axis)}"
        case schema.TangentialRemanence():
            return f"in the surface, along {vector(entry.direction)}"
        case schema.CurveRemanence():
            return f"along the curve {entry.curve}{_towards(entry.towards)}"
        case schema.ProfileRemanence():
            return _profile(entry)
        case schema.FileRemanence():
            return f"from {entry.file}"
        case schema.RolledRemanence() | schema.FoldedRemanence() | schema.DeformedRemanence():
            return f"magnetised along {vector(entry.direction)} while {_shape(entry)}"


def _shape(entry: schema.RolledRemanence | schema.FoldedRemanence | schema.DeformedRemanence) -> str:
    match entry:
        case schema.RolledRemanence():
            return f"rolled to the radius {show(entry.radius, LENGTH)} towards {vector(entry.towards)}"
        case schema.DeformedRemanence():
            return f"deformed as {entry.displacements} says"
    angles = ", ".join(show(fold.angle, ANGLE) for fold in entry.folds)
    return f"folded along {counted(len(entry.folds), 'line')} by {angles}"


def _profile(entry: schema.ProfileRemanence) -> str:
    first, last = entry.positions[0], entry.positions[-1]
    words = f"over {show(first, LENGTH)} to {show(last, LENGTH)} along {vector(entry.along)}"
    turned = max(entry.angle) - min(entry.angle)
    if turned:
        words += f", turning by {show(turned, ANGLE)}"
        if turned > 2.0 * math.pi:
            words += f" ({turned / (2.0 * math.pi):.4g} turns)"
    return words


def _towards(direction: tuple[float, float, float] | None) -> str:
    return f", towards {vector(direction)}" if direction else ""
