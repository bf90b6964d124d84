"""Every other format, through meshio."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import pathlib
import re
import warnings
from typing import Any

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.files.apart import apart
from magshell.mesh.files.cells import MESHIO
from magshell.mesh.files.contents import GROUPED, Block, Contents
from magshell.units import shortened

_TAGS = ("gmsh:physical", "medit:ref", "cell_tags", "nastran:ref")
"""Cell data that stand for groups, where a format has no names for them."""
_ZONES = {**dict.fromkeys((".dat", ".tec"), rb"(?im)^\s*ZONE\b"), ".su2": rb"(?im)^\s*NDIME\b"}
"""What begins a zone of files of which meshio reads one zone."""
_NEEDED = {**dict.fromkeys(("cgns", "h5m", "hmf", "med"), "h5py"), "exodus": "netCDF4"}
"""Packages without which meshio does not read a format."""


def read_other(path: pathlib.Path, name: str, others: tuple[str, ...], seconds: int) -> Contents:
    """Read a file in one of meshio's formats, with its sets of cells and points as groups.

    Parameters
    ----------
    path : pathlib.Path
    name : str
        Of the file, for messages.
    others : tuple of str
        Endings of the files that are read without meshio, for messages.
    seconds : int
        Of CPU time that it may take.

    Raises
    ------
    InputError
        meshio is not there, does not know the format, or refuses the file.
    """
    try:
        import meshio
    except ImportError:
        raise InputError(
            f"{name}: a file '{path.suffix}' is read through meshio, which is not installed: "
            'pip install "magshell[meshio]"'
        ) from None
    needed = _needed(meshio, path.suffix.lower())
    if needed is None:
        known = {ending for ending in meshio.extension_to_filetypes if _needed(meshio, ending) == ""}
        listed = ", ".join(sorted({*others, *known}))
        raise InputError(f"{name}: files '{path.suffix}' are not known. Known are: {listed}")
    if needed:
        raise InputError(f"{name}: meshio needs {needed} to read it, which is not installed: pip install {needed}")
    zones = len(re.findall(_ZONES[path.suffix.lower()], path.read_bytes())) if path.suffix.lower() in _ZONES else 1
    if zones > 1:
        raise InputError(f"{name}: has {zones} zones, of which meshio reads one; save them as one")
    return apart(_read, path, name, program="meshio", name=name, seconds=seconds)


def _read(path: pathlib.Path, name: str) -> Contents:
    """What meshio reads; on some damaged files it finds no end."""
    import meshio

    said = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            warnings.catch_warnings(action="ignore"),
        ):
            mesh = meshio.read(path)
    except SystemExit:  # meshio's way of refusing a file that no reader takes
        raise InputError(f"{name}: meshio cannot read it: {shortened(_last(said.getvalue()))}") from None
    except Exception as error:
        reason = shortened(" ".join(str(error).split())) or type(error).__name__
        raise InputError(f"{name}: meshio cannot read it: {reason}") from None
    return contents_of_meshio(mesh, name)


def _needed(meshio: Any, ending: str) -> str | None:
    """What is missing for meshio to read such files; empty if nothing, None if it cannot, as where it only writes."""
    kinds = meshio.extension_to_filetypes.get(ending, [])
    if not kinds or ending.count(".") > 1 or not set(kinds) <= set(meshio._helpers.reader_map):
        return None
    needed = (_NEEDED[kind] for kind in kinds if kind in _NEEDED)
    return next((package for package in needed if importlib.util.find_spec(package) is None), "")


def _last(text: str) -> str:
    return ([line for line in text.splitlines() if line.strip()] or ["it is damaged, or of another kind"])[-1]


def contents_of_meshio(mesh: Any, name: str) -> Contents:
    """Points, cells and sets of a `meshio.Mesh`."""
    points = np.array(mesh.points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not np.isfinite(points).all():
        raise InputError(f"{name}: its points do not have two or three finite coordinates")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    tags = next((mesh.cell_data[key] for key in _TAGS if key in mesh.cell_data), None)
    blocks, solids, notes, start = [], 0, [], 0
    unread: dict[str, int] = {}
    for number, cells in enumerate(mesh.cells):
        kind = MESHIO.get(cells.type)
        numbers = start + np.arange(len(cells.data))
        start += len(cells.data)
        if kind is None:
            if cells.dim == 3:
                solids += len(cells.data)
            elif cells.dim == 2:
                unread[cells.type] = unread.get(cells.type, 0) + len(cells.data)
            else:
                notes.append(f"{len(cells.data)} elements of type {cells.type} left out")
            continue
        nodes = np.array(cells.data, dtype=np.int64).reshape(-1, kind.nodes)
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(points)):
            raise InputError(f"{name}: an element has a node that is not there; nodes are 0 to {len(points) - 1}")
        groups = {
            group: inside
            for group, sets in mesh.cell_sets.items()
            if len(sets) > number and (inside := _inside(sets[number], len(nodes))).size
        }
        if tags is not None and not groups:
            values = np.asarray(tags[number]).astype(np.int64)
            groups = {
                f"{GROUPED[kind.dimension]}-{tag}": np.flatnonzero(values == tag) for tag in np.unique(values) if tag
            }
        blocks.append(Block(kind, numbers, nodes, groups))
    node_groups = {group: _inside(members, len(points)) for group, members in mesh.point_sets.items()}
    return Contents(points, blocks, node_groups, solids=solids, unread=unread, notes=tuple(notes))


def _inside(members: Any, count: int) -> IntArray:
    """The numbers of a set that exist; meshio writes None where a set has no cells of a block."""
    if members is None:
        return np.zeros(0, dtype=np.int64)
    numbers = np.asarray(members).astype(np.int64).ravel()
    return numbers[(numbers >= 0) & (numbers < count)]
