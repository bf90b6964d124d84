"""The field of a problem: its uniform part, magnets and coils grouped by how they move, gradient, grid, coil system,
and the field of the body itself.
"""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from magshell.errors import InputError
from magshell.magnetics.fields import (
    COILS,
    MAGNETS,
    CoilSystem,
    Field,
    GradientField,
    MagnetField,
    Motion,
    SelfField,
    Source,
    UniformField,
    read_grid,
)
from magshell.magnetics.fields.motion import rotation
from magshell.problem import schema
from magshell.problem.building.located import at


def build_field(file: schema.ProblemFile, folder: pathlib.Path) -> Field:
    """The field that a problem file describes; one part alone is not a sum.

    Raises
    ------
    InputError
        Located in the file.
    """
    table = file.field
    parts = [*_of_sources(file), *_others(table, folder)]
    uniform = UniformField(table.vector, table.stops, table.history, table.rotation_axis, table.rotation)
    if uniform.magnitude or not parts:
        parts.insert(0, uniform)
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def placed(entry: schema.SourceTable, key: str) -> tuple[Source, ...]:
    """The sources of an entry of `magnets` or `coils`, in their places before the first stage."""
    kind = {"magnets": MAGNETS, "coils": COILS}[key][entry.shape]
    turn = np.eye(3)
    if entry.orientation_axis is not None and entry.orientation is not None:
        axis = np.asarray(entry.orientation_axis)
        turn = rotation(axis / np.linalg.norm(axis), entry.orientation)
    sources = kind.sources(**{name: getattr(entry, name) for name in kind.keys})
    return tuple(source.moved(turn, np.asarray(entry.position)) for source in sources)


def _of_sources(file: schema.ProblemFile) -> Iterator[Field]:
    """A field for all magnets and coils that move alike and are switched alike."""
    groups: dict[tuple[Any, ...], tuple[Motion, str, list[Source]]] = {}
    entries = {"magnets": file.magnets, "coils": file.coils}
    for key, tables in entries.items():
        for number, entry in enumerate(tables):
            with at(f"{key}[{number}]"):
                centre = entry.rotation_centre if entry.rotation_centre is not None else entry.position
                motion = _motion(entry, centre if entry.rotation is not None else None)
                how = (entry.name, entry.history, entry.displacement, entry.rotation_axis, entry.rotation)
                alike = (*how, centre if entry.rotation is not None else None)
                groups.setdefault(alike, (motion, entry.name or key, []))[2].extend(placed(entry, key))
    for motion, name, sources in groups.values():
        yield MagnetField(sources, motion, file.field.spline_spacing, name)


def _others(table: schema.FieldTable, folder: pathlib.Path) -> Iterator[Field]:
    if table.gradient is not None:
        one = table.gradient
        with at("field.gradient"):
            yield GradientField(one.tensor, (0.0, 0.0, 0.0), one.centre, _motion(one), one.name or "gradient")
    if table.sampled is not None:
        grid = table.sampled
        with at("field.sampled"):
            file = folder / grid.file
            yield read_grid(file, grid.flux_density_unit, grid.length_unit, _motion(grid), grid.name or "sampled")
    if table.coils is not None:
        system = table.coils
        with at("field.coils"):
            if len({len(row) for row in system.currents}) > 1:
                raise InputError("currents: every stage needs as many currents as the first")
            calibration = _calibration(folder / system.calibration)
            yield CoilSystem(calibration, system.currents, system.centre, system.name or "coils")
    if table.self_field:
        yield SelfField()


def _motion(table: Any, centre: tuple[float, float, float] | None = None) -> Motion:
    centre = table.rotation_centre if centre is None else centre
    return Motion(table.history, table.displacement, table.rotation_axis, table.rotation, centre)


def _calibration(file: pathlib.Path) -> Any:
    """Rows of plain numbers, separated by commas."""
    try:
        return np.loadtxt(file, delimiter=",", ndmin=2, encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{file}: there is no such file") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{file.name}: is not a table of numbers separated by commas: {error}") from None
