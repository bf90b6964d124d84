"""A mesh from a drawing."""

from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.util import find_spec

from magshell.errors import InputError
from magshell.mesh.drawings.dxf import read_dxf
from magshell.mesh.drawings.joining import Joined
from magshell.mesh.drawings.meshing import mesh_plan
from magshell.mesh.drawings.nesting import Plan, planned
from magshell.mesh.drawings.pieces import FOLLOWED, Drawing, Piece
from magshell.mesh.drawings.svg import read_svg
from magshell.mesh.drawings.table import read_table
from magshell.mesh.files.apart import apart
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import DEFAULT_ELEMENTS
from magshell.mesh.files.paths import readable
from magshell.mesh.files.seams import cut_open
from magshell.mesh.files.session import required
from magshell.mesh.files.units import length_unit

READERS: dict[str, tuple[Callable[[pathlib.Path, str], Drawing], str]] = {
    ".dxf": (read_dxf, "ezdxf"),
    ".svg": (read_svg, "svgelements"),
    ".csv": (read_table, ""),
}
"""By the ending of a file: what reads it, and the package that it needs."""
INSTALL = 'pip install "magshell[drawings]"'
SECONDS, BYTES_PER_SECOND = 60, 200_000
"""As for other programs that read files."""


def from_drawing(
    file: str | os.PathLike[str],
    size: float | None = None,
    unit: str | None = None,
    holes: Sequence[str] | None = None,
    gap: float | None = None,
    cuts: Sequence[str] = (),
) -> FileMesh:
    """Mesh the outlines of a flat drawing with gmsh (the extra `magshell[drawings]`).

    An outline is made of lines, arcs and curves that meet end to end. One inside of another on the same layer is a
    hole, one on another layer an area of its own.

    Parameters
    ----------
    file : path
        `.dxf`, `.svg`, or `.csv` with polygons.
    size : float, optional
        Length of an element's side, m; without it such that there are about 800 elements.
    unit : str, optional
        Of the lengths in the drawing, whatever it says itself.
    holes : sequence of str, optional
        Layers whose outlines are holes, wherever they are.
    gap : float, optional
        Ends of lines closer than this are joined, m; without it 1e-4 of the size of the drawing.
    cuts : sequence of str
        Edge groups along which the sheet is cut open: layers of lines inside of the outlines, or on them.

    Returns
    -------
    FileMesh
        In the plane X1-X2, facing +X3. Each layer with outlines of material is an element group, and its outlines are
        the edge group `LAYER-edges`; lines of a layer that lie on outlines of others are an edge group; holes are the
        edge groups hole-1, hole-2 and so on.

    Raises
    ------
    InputError
        gmsh, or what reads the file, is not there; no such file; no unit; lines that are no outline, with layer and
        place; no edge group to cut along.
    """
    path, name = pathlib.Path(file), pathlib.Path(file).name
    suffix = path.suffix.lower()
    if suffix not in READERS:
        raise InputError(f"{name}: is not a drawing; these are: {', '.join(READERS)}")
    readable(path)
    reader, package = READERS[suffix]
    required(name)
    for needed in (package, "shapely"):
        if needed and find_spec(needed) is None:
            raise InputError(f"{name}: needs {needed}, which is not installed: {INSTALL}")
    if package:
        seconds = SECONDS + path.stat().st_size // BYTES_PER_SECOND
        drawing = apart(reader, path, name, program=package, name=name, seconds=seconds)
    else:
        drawing = reader(path, name)
    pieces, told = _in_millimetres(drawing, unit, name)
    try:
        plan = planned(Joined(pieces, None if gap is None else 1e3 * gap), holes, cuts)
    except InputError as error:
        said = f"; {drawing.notes[0]}" if drawing.notes and not pieces else ""
        raise InputError(f"{name}: {error}{said}") from None
    mesh = meshed(plan, name, size)
    if curves := sum(not (piece.line or piece.arc) for piece in pieces):
        told += f"; {curves} splines and other curves followed to within {FOLLOWED * plan.size:.2g} mm"
    mesh = replace(mesh, origin=replace(mesh.origin, changes=(told, *drawing.notes, *mesh.origin.changes)))
    return cut_open(mesh, cuts)


def meshed(plan: Plan, name: str, size: float | None) -> FileMesh:
    """A plan meshed apart; the size in m."""
    return apart(mesh_plan, plan, name, chosen_size(size, plan.area), program="gmsh", name=name)


def chosen_size(size: float | None, area: float) -> float:
    """Size of elements, mm, from one in m, or from the area, mm².

    Raises
    ------
    InputError
        Not a positive length.
    """
    if size is None:
        return float(f"{math.sqrt(area / DEFAULT_ELEMENTS):.2g}")
    if not (math.isfinite(size) and size > 0.0):
        raise InputError(f"size = {size!r} is not allowed; it must be a positive length, in m")
    return 1e3 * size


def _in_millimetres(drawing: Drawing, unit: str | None, name: str) -> tuple[list[Piece], str]:
    """The pieces in mm, and what is said of the unit."""
    if unit is None and drawing.millimetres is None:
        raise InputError(
            f'unit: is missing: {name} does not say in which unit its lengths are. Write it, as in unit = "mm" '
            "(magshell mesh: --unit mm)"
        )
    factor = drawing.millimetres if unit is None else 1e3 * length_unit(unit)
    assert factor is not None
    told = f"the drawing's lengths are in {unit or drawing.unit}"
    if unit is None:
        told += ", as it says" if abs(factor - 1.0) < 1e-12 else f", as it says, each {factor:.6g} mm"
    elif drawing.millimetres is not None and abs(factor / drawing.millimetres - 1.0) > 1e-9:
        told += f", as unit says; the drawing says {drawing.unit} ({drawing.millimetres:.6g} mm)"
    return [replace(piece, points=factor * piece.points) for piece in drawing.pieces], told
