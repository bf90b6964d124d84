"""The remanence of a problem."""

from __future__ import annotations

import pathlib

import numpy as np

from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.magnetics.remanence import Remanence
from magshell.mesh import Mesh
from magshell.problem import schema
from magshell.problem.building.located import at


def build_remanence(entries: tuple[schema.Remanence, ...], mesh: Mesh, folder: pathlib.Path) -> Remanence:
    """The remanence that the entries describe together."""
    if len(entries) == 1 and entries[0].group is None:
        return _one_remanence(entries[0])
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
                grouped[group] = _one_remanence(entry)
    return remanence.by_group(grouped)


def _one_remanence(entry: schema.Remanence) -> Remanence:
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


def _listed(mesh: Mesh) -> str:
    return f"({', '.join(mesh.element_groups)})" if mesh.element_groups else "(this mesh has none)"
