"""A mesh from any file: a mesh as it is, a drawing or a geometry meshed, a solid's mid-surface."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass

from magshell.errors import InputError
from magshell.mesh.drawings.reading import READERS, from_drawing
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import from_cad
from magshell.mesh.files.paths import GEOMETRY
from magshell.mesh.files.reading import read
from magshell.mesh.files.seams import cut_open
from magshell.mesh.solids.mid_surface import mid_surface

DRAWINGS = tuple(READERS)
"""Endings of drawings."""


@dataclass(frozen=True)
class Wishes:
    """Options for a file; which of them make sense depends on its kind.

    Attributes
    ----------
    unit : str or None
        Of the lengths in the file.
    size : float or None
        Of elements, m: of drawings, geometries and mid-surfaces.
    second_order, closed : bool
        As for `read`.
    mid_surface : bool
        Of the solid that the file holds.
    holes : tuple of str
        Layers of a drawing.
    gap : float or None
        Between lines of a drawing, m.
    weld : float or None
        As for `read`, m.
    cuts : tuple of str
        Edge groups along which the surface is cut.
    trust_script : bool
        As for `from_cad`.
    """

    unit: str | None = None
    size: float | None = None
    second_order: bool = False
    closed: bool = False
    mid_surface: bool = False
    holes: tuple[str, ...] = ()
    gap: float | None = None
    weld: float | None = None
    cuts: tuple[str, ...] = ()
    trust_script: bool = False


def meshes(file: str | os.PathLike[str], wishes: Wishes) -> bool:
    """Whether gmsh makes the mesh; otherwise the file holds it."""
    return wishes.mid_surface or pathlib.Path(file).suffix.lower() in (*GEOMETRY, *DRAWINGS)


def open_mesh(file: str | os.PathLike[str], wishes: Wishes) -> FileMesh:
    """The mesh of a file.

    Raises
    ------
    InputError
        What makes no sense for the file, by its key; or as `read`, `from_cad`, `from_drawing`, `mid_surface`.
    """
    if meshes(file, wishes):
        return _meshed(file, wishes)
    name = pathlib.Path(file).name
    for key in ("holes", "gap"):
        _only_if(not getattr(wishes, key), key, f"is for drawings ({', '.join(DRAWINGS)}), and {name} is none")
    _only_if(wishes.size is None, "size", f"{name} is a mesh, whose elements have their size")
    return read(file, wishes.unit, wishes.second_order, wishes.closed, wishes.weld, wishes.cuts)


def _meshed(file: str | os.PathLike[str], wishes: Wishes) -> FileMesh:
    """What gmsh makes of a drawing, a geometry or a solid."""
    name, suffix = pathlib.Path(file).name, pathlib.Path(file).suffix.lower()
    if suffix in DRAWINGS:
        for key in ("mid_surface", "second_order", "closed", "weld"):
            _only_if(not getattr(wishes, key), key, f"makes no sense for a drawing such as {name}")
        return from_drawing(file, wishes.size, wishes.unit, wishes.holes, wishes.gap, wishes.cuts)
    for key in ("holes", "gap"):
        _only_if(not getattr(wishes, key), key, f"is for drawings ({', '.join(DRAWINGS)}), and {name} is none")
    if wishes.mid_surface:
        for key in ("second_order", "closed", "weld"):
            _only_if(not getattr(wishes, key), key, "makes no sense with mid_surface")
        return cut_open(mid_surface(file, wishes.size, wishes.unit), wishes.cuts)
    _only_if(not wishes.second_order, "second_order", "is for meshes; a geometry is meshed to second order anyway")
    _only_if(wishes.weld is None, "weld", "is for meshes; the surfaces of a geometry share their edges")
    mesh = from_cad(file, wishes.size, wishes.unit, wishes.trust_script, wishes.closed)
    return cut_open(mesh, wishes.cuts)


def _only_if(fine: bool, key: str, reason: str) -> None:
    if not fine:
        raise InputError(f"{key}: {reason}; leave it out")
