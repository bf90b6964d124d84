"""The mid-surface of a solid from any kind of file."""

from __future__ import annotations

import os
import pathlib
import tempfile
from dataclasses import replace
from importlib.util import find_spec

from magshell.errors import InputError
from magshell.mesh.drawings.reading import INSTALL
from magshell.mesh.files.apart import apart
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import CONVERTED, KNOWS_ITS_UNIT
from magshell.mesh.files.paths import GEOMETRY, readable
from magshell.mesh.files.reading import contents_of, seconds_for
from magshell.mesh.files.scripts import put_alone
from magshell.mesh.files.session import required
from magshell.mesh.files.units import agreed, length_unit
from magshell.mesh.solids.cad import mid_surface_of_body
from magshell.mesh.solids.curved import curved_mesh
from magshell.mesh.solids.flat import flat_mesh, is_flat
from magshell.mesh.solids.pairing import Sides, sides_of
from magshell.mesh.solids.skin import Skin, skin_of_contents

TOLD = 1e-6
"""Of the thickness: smaller differences are round-off, or that of files of single precision."""


def mid_surface(file: str | os.PathLike[str], size: float | None = None, unit: str | None = None) -> FileMesh:
    """Mesh the mid-surface of a solid of constant thickness with gmsh (the extra `magshell[drawings]`).

    Parameters
    ----------
    file : path
        A body in `.step`, `.stp`, `.iges`, `.igs`, `.brep` or `.geo`; or a mesh, of solid elements or of the closed
        skin (`.stl`), in any format that `read` knows.
    size : float, optional
        Length of an element's side, m; without it such that there are about 800 elements.
    unit : str, optional
        Of the lengths in the file, unless it says it.

    Returns
    -------
    FileMesh
        Facing up, or outward; its `origin` says the thickness. Of a flat plate the outline is that of its sides.

    Raises
    ------
    InputError
        A thickness that varies, with the place; a solid with no two opposite sides; what is no solid.
    """
    path, name = pathlib.Path(file), pathlib.Path(file).name
    readable(path)
    required(name)
    if find_spec("shapely") is None:
        raise InputError(f"{name}: needs shapely, which is not installed: {INSTALL}")
    if path.suffix.lower() in GEOMETRY:
        mesh, sides = _of_body(path, name, size, unit)
    else:
        contents = contents_of(path, name)
        own = agreed(unit, contents.unit, name)
        skin = skin_of_contents(contents, path, name, seconds_for(path))
        skin = Skin(1e3 * length_unit(own) * skin.points, skin.triangles)
        sides = sides_of(skin, None, name)
        make = flat_mesh if is_flat(skin, sides) else curved_mesh
        mesh = make(skin, sides, name, size)
        mesh = replace(mesh, origin=replace(mesh.origin, unit=own))
    origin = replace(mesh.origin, changes=(_told(sides), *mesh.origin.changes), thickness=1e-3 * sides.thickness)
    return replace(mesh, origin=origin)


def _of_body(path: pathlib.Path, name: str, size: float | None, unit: str | None) -> tuple[FileMesh, Sides]:
    suffix = path.suffix.lower()
    if suffix in KNOWS_ITS_UNIT and unit is not None:
        raise InputError(f"unit: {name} says itself in which unit its lengths are; leave the unit out")
    own = CONVERTED if suffix in KNOWS_ITS_UNIT else agreed(unit, None, name)
    with tempfile.TemporaryDirectory() as folder:
        copy = put_alone(path, pathlib.Path(folder))
        return apart(mid_surface_of_body, copy, name, size, own, 1e3 * length_unit(own), program="gmsh", name=name)


def _told(sides: Sides) -> str:
    """The thickness in words."""
    told = f"the mid-surface of a solid {sides.thickness:.6g} mm thick"
    if sides.greatest - sides.least > TOLD * sides.thickness:
        told += f" ({sides.least:.6g} to {sides.greatest:.6g} mm)"
    if sides.coarse > TOLD * sides.thickness:
        told += f"; its flat triangles are up to {sides.coarse:.2g} mm off the curved surface put through their corners"
    return told
