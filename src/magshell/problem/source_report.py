"""Magnets, coils and other fields that vary in space, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.magnetics.fields.own import has_own
from magshell.model.model import Model
from magshell.model.own_strength import own_strength
from magshell.problem import schema
from magshell.problem.building.field import placed
from magshell.units import ANGLE, FLUX_DENSITY, FLUX_GRADIENT, LENGTH, NUMBER, show
from magshell.wording import quantity, vector


def lines(file: schema.ProblemFile) -> Iterator[tuple[str, str]]:
    """Label and text of every source, gradient, grid and coil system."""
    for key, entries in (("magnets", file.magnets), ("coils", file.coils)):
        for number, entry in enumerate(entries):
            yield f"{key}[{number}]" + (f" {entry.name}" if entry.name else ""), _source(entry, key)
    field = file.field
    if field.gradient is not None:
        rows = "; ".join(quantity(row, FLUX_GRADIENT) for row in field.gradient.tensor)
        yield "gradient", f"{rows} about {quantity(field.gradient.centre, LENGTH)}{_motion(field.gradient)}"
    if field.sampled is not None:
        yield "sampled", f"from {field.sampled.file}{_motion(field.sampled)}"
    if field.coils is not None:
        count = len(field.coils.currents[0])
        yield "coil system", f"{count} coils calibrated by {field.coils.calibration}"
    if field.spline_spacing is not None:
        yield "splines", f"spacing {show(field.spline_spacing, LENGTH)}"


def at_shell(model: Model) -> Iterator[tuple[str, str]]:
    """Largest flux density and gradient at the undeformed nodes, before the first stage and at each end."""
    points = model.shell.mesh.points
    ends = [model.field.at(now, points, second=False) for now in model.field.ends(len(model.stages))]
    strongest = max(float(np.linalg.norm(values.flux_density, axis=1).max()) for values in ends)
    steepest = max(float(np.abs(values.gradient).max()) for values in ends)
    yield "largest |B| at the shell", show(strongest, FLUX_DENSITY)
    yield "largest ∂B_i/∂x_j", show(steepest, FLUX_GRADIENT)


def own(model: Model) -> Iterator[tuple[str, str]]:
    """How strong the field of the body's own remanence is beside the applied one, and whether it acts."""
    if not model.shell.magnetised and not any(np.any(body.moment) for body in model.shell.rigid):
        return
    found, applied = own_strength(model.shell), model.largest_field
    share = f", {found.flux_density / applied:.2g} of the applied one" if applied else ""
    acts = "acts on it" if has_own(model.field) else "left out (self_field)"
    yield (
        "the body's own field",
        f"up to {show(found.flux_density, FLUX_DENSITY)} from parts farther than {show(found.beyond, LENGTH)}{share}; "
        f"{acts}",
    )


def driven(model: Model, stage: int) -> str:
    """The amounts of the field that a stage changes, each from and to which value; empty if none."""
    before, after = model.field.ends(len(model.stages))[stage : stage + 2]
    changes = zip(model.field.drives, before, after, strict=True)
    told = [f"{name} {_amount(name, one)} to {_amount(name, two)}" for name, one, two in changes if one != two]
    return "drives " + ", ".join(told) if told else ""


def _amount(name: str, value: float) -> str:
    kind = name.rpartition(".")[2]
    dimension = LENGTH if kind in ("d1", "d2", "d3") else ANGLE if kind == "angle" else NUMBER
    return f"{value:.4g}" if dimension is NUMBER else show(float(value), dimension)


def _source(entry: schema.SourceTable, key: str) -> str:
    sources = placed(entry, key)
    first = sources[0].shape.words()
    what = first if len(sources) == 1 else f"{entry.shape} of {len(sources)}, each a {first}"
    turned = ""
    if entry.orientation_axis is not None and entry.orientation:
        turned = f", turned by {show(entry.orientation, ANGLE)} about {vector(entry.orientation_axis)}"
    return f"{what}, at {quantity(entry.position, LENGTH)}{turned}{_motion(entry)}"


def _motion(entry: schema.MotionTable) -> str:
    """How it moves, in words; empty for what stays."""
    parts = []
    if entry.history is not None:
        parts.append("multiplier " + ", ".join(f"{multiplier:.4g}" for multiplier in entry.history))
    if entry.displacement is not None and np.any(entry.displacement):
        parts.append("displaced by " + ", ".join(quantity(place, LENGTH) for place in entry.displacement))
    if entry.rotation is not None and entry.rotation_axis is not None:
        angles = ", ".join(show(angle, ANGLE) for angle in entry.rotation)
        centre = "" if entry.rotation_centre is None else f" through {quantity(entry.rotation_centre, LENGTH)}"
        parts.append(f"turns by {angles} about {vector(entry.rotation_axis)}{centre}")
    return "".join(f"; {part}" for part in parts)
