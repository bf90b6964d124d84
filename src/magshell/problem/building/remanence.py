"""The remanence of a problem."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from contextlib import contextmanager

from magshell.errors import InputError
from magshell.magnetics.remanence import REMANENCES, Remanence, by_group
from magshell.mesh import Mesh
from magshell.mesh.geometry import centres
from magshell.problem import schema
from magshell.problem.building.located import at


def build_remanence(
    entries: tuple[schema.RemanenceTable, ...], mesh: Mesh, folder: pathlib.Path, key: str = "remanence"
) -> Remanence:
    """The remanence that the entries at a key describe together."""
    if len(entries) == 1 and entries[0].group is None:
        with _at_entry(key, 0):
            return _tried(_one_remanence(entries[0], folder), mesh)
    grouped: dict[str, Remanence] = {}
    owner: dict[int, str] = {}
    for number, entry in enumerate(entries):
        with at(f"{key}[{number}].group"):
            if entry.group is None:
                raise InputError(f"is missing; with several entries each says its element groups {_listed(mesh)}")
            for group in entry.group:
                for element in mesh.elements_of(group).tolist():
                    if element in owner:
                        raise InputError(
                            f"element {element} of '{group}' already has the remanence of '{owner[element]}'"
                        )
                    owner[element] = group
        with _at_entry(key, number):
            one = _one_remanence(entry, folder)
            grouped |= dict.fromkeys(entry.group, one)
            _tried(by_group(dict.fromkeys(entry.group, one)), mesh)
    return by_group(grouped)


@contextmanager
def _at_entry(key: str, number: int) -> Iterator[None]:
    """Locate input errors of an entry; those of the remanence itself already begin with its name."""
    try:
        yield
    except InputError as error:
        message = str(error).removeprefix("remanence: ")
        raise InputError(f"{key}[{number}]{'' if message.startswith('.') else ': '}{message}") from None


def _tried(one: Remanence, mesh: Mesh) -> Remanence:
    """The remanence, after it was evaluated at the middle of every element."""
    one(mesh, centres(mesh.points, mesh.elements)[:, None])
    return one


def _one_remanence(entry: schema.RemanenceTable, folder: pathlib.Path) -> Remanence:
    way = REMANENCES[entry.kind]
    values = way.values(entry)
    files = {key: folder / values[key] for key, about in way.keys.items() if about.kind == "FileName"}
    return way.make(**{**values, **files})


def _listed(mesh: Mesh) -> str:
    return f"({', '.join(mesh.element_groups)})" if mesh.element_groups else "(this mesh has none)"
