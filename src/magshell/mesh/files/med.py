"""MED files (`.med`) of Salome and Code_Aster: HDF5 with elements by type and groups by families.

gmsh's reader is not used for them: it takes coordinates in any system for Cartesian ones, skips types that it does not
know, and loses groups of nodes. h5py reads the file itself.
"""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.files.cells import LINE2, LINE3, POINT, QUAD4, QUAD8, QUAD9, TRIANGLE3, TRIANGLE6, TRIANGLE7
from magshell.mesh.files.contents import Block, Contents
from magshell.units import LENGTH, shortened

_KINDS = {
    "PO1": POINT,
    "SE2": LINE2,
    "SE3": LINE3,
    "TR3": TRIANGLE3,
    "TR6": TRIANGLE6,
    "TR7": TRIANGLE7,
    "QU4": QUAD4,
    "QU8": QUAD8,
    "QU9": QUAD9,
}
_SOLIDS = ("TE", "HE", "PE", "PY", "OCT", "POE")
_SURFACES = ("TR", "QU", "POG")
_SYSTEMS = {1: "cylindrical", 2: "spherical"}
_UNIT_WIDTH = 16


def read_med(path: pathlib.Path, name: str) -> Contents:
    """Read the mesh of a MED file; groups of elements and nodes become groups.

    Parameters
    ----------
    path : pathlib.Path
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        Not a MED file, several meshes or steps in it, a structured grid, coordinates that are not Cartesian.
    """
    import h5py

    try:
        file = h5py.File(path, "r")
    except OSError:
        raise InputError(f"{name}: is not a MED file, which is one of HDF5, or it is damaged") from None
    with file:
        called, mesh, step = _the_mesh(file, name)
        points = _points(mesh, step, name)
        families = {kind: _families(file, called, kind) for kind in ("ELEME", "NOEUD")}
        blocks, unread, notes, solids, start = [], {}, [], 0, 1
        for kind_name, group in step.get("MAI", {}).items():
            count = int(group.attrs.get("CGS", 0)) and _count(group)
            kind = _KINDS.get(kind_name)
            if kind is not None:
                rows = _rows(group, kind.nodes, len(points), f"{name}: an element of type {kind_name}")
                belongs = _belongs(group, len(rows))
                groups = _grouped(families["ELEME"], belongs)
                blocks.append(Block(kind, start + np.arange(len(rows)), rows, groups))
                start += len(rows)
            elif kind_name.startswith(_SOLIDS):
                solids += count
            elif kind_name.startswith(_SURFACES):
                unread[kind_name] = count
            else:
                notes.append(f"{count} elements of type {kind_name} left out")
        node_groups = _grouped(families["NOEUD"], _belongs(step["NOE"], len(points)))
        unit = _unit(mesh, name)
    return Contents(points, blocks, node_groups, solids, unread, unit, tuple(notes))


def _the_mesh(file: Any, name: str) -> tuple[str, Any, Any]:
    """Name, group and step of the only mesh of a file."""
    meshes = file.get("ENS_MAA")
    if meshes is None:
        raise InputError(f"{name}: has no mesh, or is not a MED file")
    if len(meshes) != 1:
        raise InputError(f"{name}: holds {len(meshes)} meshes ({', '.join(meshes)}); save the one that is meant")
    called, mesh = next(iter(meshes.items()))
    if int(mesh.attrs.get("TYP", 0)):
        raise InputError(f"{name}: holds a structured grid; save it as unstructured")
    system = int(mesh.attrs.get("REP", 0))
    if system:
        raise InputError(
            f"{name}: coordinates are {_SYSTEMS.get(system, f'of kind {system}')}; save the mesh in Cartesian ones"
        )
    steps = [step for step in mesh.values() if "NOE" in step]
    if len(steps) != 1:
        raise InputError(f"{name}: the mesh has {len(steps)} steps (or is of a version before 3); save one step of it")
    return called, mesh, steps[0]


def _points(mesh: Any, step: Any, name: str) -> FloatArray:
    width = int(mesh.attrs.get("ESP", 3))
    flat = np.array(step["NOE/COO"], dtype=np.float64)
    if width not in (2, 3) or flat.size % width or not flat.size or not np.isfinite(flat).all():
        raise InputError(f"{name}: its {flat.size} coordinates are not two or three finite ones for each node")
    return np.pad(flat.reshape(width, -1).T, ((0, 0), (0, 3 - width)))


def _count(group: Any) -> int:
    """How many elements a type has; polygons are told by where each begins."""
    return int(group["INN"].shape[0]) - 1 if "INN" in group else int(group["NOD"].attrs["NBR"])


def _rows(group: Any, width: int, points: int, what: str) -> IntArray:
    """Nodes of elements, from 0: the file has the first nodes of all, then the second ones."""
    flat = np.array(group["NOD"], dtype=np.int64)
    if flat.size % width:
        raise InputError(f"{what} does not have {width} nodes")
    if flat.size and (flat.min() < 1 or flat.max() > points):
        raise InputError(f"{what} has a node that is not there; nodes are 1 to {points}")
    return flat.reshape(width, -1).T - 1


def _belongs(group: Any, count: int) -> IntArray:
    """Number of each one's family; 0 is in no group."""
    numbers = np.array(group["FAM"], dtype=np.int64).ravel() if "FAM" in group else np.zeros(count, dtype=np.int64)
    return numbers if len(numbers) == count else np.zeros(count, dtype=np.int64)


def _families(file: Any, mesh: str, kind: str) -> dict[int, list[str]]:
    """Names of the groups of each family of elements or nodes."""
    families = {}
    for family in file.get(f"FAS/{mesh}/{kind}", {}).values():
        names = family["GRO/NOM"][()].astype(np.uint8) if "GRO/NOM" in family else np.zeros((0, 80), np.uint8)
        families[int(family.attrs["NUM"])] = [
            row.tobytes().partition(b"\0")[0].decode("utf-8", "replace").strip() for row in names.reshape(-1, 80)
        ]
    return families


def _grouped(families: dict[int, list[str]], belongs: IntArray) -> dict[str, IntArray]:
    groups: dict[str, IntArray] = {}
    for number, names in families.items():
        inside = np.flatnonzero(belongs == number)
        for name in names if inside.size else ():
            groups[name] = np.union1d(groups[name], inside) if name in groups else inside
    return groups


def _unit(mesh: Any, name: str) -> str | None:
    """Of the axes, if the file says it."""
    said = mesh.attrs.get("UNI", b"")
    text = said.decode("utf-8", "replace") if isinstance(said, bytes) else str(said)
    units = {text[start : start + _UNIT_WIDTH].strip("\0 ") for start in range(0, len(text), _UNIT_WIDTH)} - {""}
    if not units:
        return None
    if len(units) > 1 or not units <= set(LENGTH.units):
        raise InputError(f"{name}: lengths are in {shortened(', '.join(sorted(units)))}; allowed are {LENGTH.allowed}")
    return units.pop()
