"""The remanence of a problem."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.magnetics.remanence import Remanence
from magshell.mesh import Mesh
from magshell.mesh.geometry import centres
from magshell.problem import schema
from magshell.problem.building.located import at
from magshell.problem.schema.remanence import Template


def build_remanence(entries: tuple[schema.Remanence, ...], mesh: Mesh, folder: pathlib.Path) -> Remanence:
    """The remanence that the entries describe together."""
    if len(entries) == 1 and entries[0].group is None:
        with _at_entry(0):
            return _tried(_one_remanence(entries[0], folder), mesh)
    grouped: dict[str, Remanence] = {}
    owner: dict[int, str] = {}
    for number, entry in enumerate(entries):
        with at(f"remanence[{number}].group"):
            if entry.group is None:
                raise InputError(f"is missing; with several entries each says its element groups {_listed(mesh)}")
            for group in entry.group:
                for element in mesh.elements_of(group).tolist():
                    if element in owner:
                        raise InputError(
                            f"element {element} of '{group}' already has the remanence of '{owner[element]}'"
                        )
                    owner[element] = group
        with _at_entry(number):
            one = _one_remanence(entry, folder)
            grouped |= dict.fromkeys(entry.group, one)
            _tried(remanence.by_group(dict.fromkeys(entry.group, one)), mesh)
    return remanence.by_group(grouped)


@contextmanager
def _at_entry(number: int) -> Iterator[None]:
    """What the entry is wrong about, located; the words of the remanence itself begin with its name already."""
    try:
        yield
    except InputError as error:
        message = str(error).removeprefix("remanence: ")
        raise InputError(f"remanence[{number}]{'' if message.startswith('.') else ': '}{message}") from None


def _tried(one: Remanence, mesh: Mesh) -> Remanence:
    """The remanence, once it has been asked at the middle of every element."""
    one(mesh, centres(mesh.points, mesh.elements)[:, None])
    return one


def _one_remanence(entry: schema.Remanence, folder: pathlib.Path) -> Remanence:
    match entry:
        case schema.ConstantRemanence():
            if entry.vector is not None:
                return remanence.constant(entry.vector)
            direction = np.array(entry.direction)
            return remanence.constant((entry.magnitude or 0.0) * direction / np.linalg.norm(direction))
        case schema.MeridionalRemanence():
            return remanence.meridional(entry.magnitude, entry.axis, entry.mirrored)
        case schema.CircumferentialRemanence():
            return remanence.circumferential(entry.magnitude, entry.axis, entry.towards)
        case schema.RadialRemanence():
            return remanence.radial(entry.magnitude, entry.axis, entry.through, entry.inward)
        case schema.TangentialRemanence():
            return remanence.tangential(entry.magnitude, entry.direction)
        case schema.CurveRemanence():
            return remanence.along_curve(entry.curve, entry.magnitude, entry.towards)
        case schema.ProfileRemanence():
            return remanence.profile(
                entry.magnitude, entry.positions, entry.along, entry.direction, entry.angle, entry.towards, entry.origin
            )
        case schema.FileRemanence():
            return remanence.from_file(folder / entry.file, entry.flux_density_unit, entry.length_unit, entry.tolerance)
        case schema.RolledRemanence() | schema.FoldedRemanence() | schema.DeformedRemanence():
            return remanence.template(_shape(entry, folder), entry.magnitude, entry.direction)


def _shape(entry: Template, folder: pathlib.Path) -> remanence.Shape:
    match entry:
        case schema.RolledRemanence():
            return remanence.rolled(entry.radius, entry.through, entry.along, entry.towards)
        case schema.DeformedRemanence():
            return remanence.displaced_from_file(folder / entry.displacements, entry.length_unit)
    folds = []
    for number, fold in enumerate(entry.folds):
        try:
            folds.append(remanence.Fold(fold.through, fold.along, fold.towards, fold.angle, fold.radius))
        except InputError as error:
            raise InputError(f".folds[{number}]: {str(error).removeprefix('remanence: ')}") from None
    return remanence.folded(*folds)


def _listed(mesh: Mesh) -> str:
    return f"({', '.join(mesh.element_groups)})" if mesh.element_groups else "(this mesh has none)"
