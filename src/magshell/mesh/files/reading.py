"""A mesh from a file, whatever its format."""

from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from importlib.util import find_spec

from magshell.errors import InputError, MeshError
from magshell.mesh.files.apart import apart
from magshell.mesh.files.assembling import FileMesh, assemble
from magshell.mesh.files.contents import Contents
from magshell.mesh.files.paths import GEOMETRY, readable
from magshell.mesh.files.seams import ways_out, welded
from magshell.mesh.files.units import agreed

SECONDS, BYTES_PER_SECOND = 60, 200_000
"""Of CPU time that another program has for a file of any size, and the least that it reads."""


def read(
    file: str | os.PathLike[str],
    unit: str | None = None,
    second_order: bool = False,
    closed: bool = False,
    weld: float | None = None,
    cuts: Sequence[str] = (),
) -> FileMesh:
    """Read a mesh with its groups.

    Parameters
    ----------
    file : path
        gmsh's `.msh` (formats 4.1 and 2.2 in text; all others if the extra `magshell[gmsh]` is installed), Abaqus'
        `.inp`, Nastran's `.bdf`, `.nas` and `.fem`, universal files `.unv`, VTK's `.vtu`, `.vtp` and `.vtk`; with the
        extra `magshell[meshio]` also `.med` and what meshio reads, such as `.stl`, `.obj` and `.ply`.
    unit : str, optional
        Of the lengths in the file: m, cm, mm or um. Required, unless the file says it: those of `write` and of
        `magshell mesh` do, and the program's own `.vtu` files.
    second_order : bool
        Whether elements of first order are raised to second, with middles on the curved surface that they stand for;
        refused otherwise.
    closed : bool
        Whether a closed surface with sharp edges, or with two flat faces that are parallel, is meant as a shell, like
        a thin-walled box. Otherwise it is taken for the skin of a solid and refused.
    weld : float, optional
        Nodes that are no further apart, m, become one: those of a tube with an open seam, or of surfaces meshed one by
        one. Nodes that lie on each other are refused otherwise.
    cuts : sequence of str
        Groups of edges along which the surface is cut. Where nodes lie on each other there, they stay apart; where they
        do not, they are doubled, except at ends inside the surface.

    Returns
    -------
    FileMesh
        In m; `origin` says what was changed. Nodes and elements are numbered in the order of the file's numbers.
        Named surfaces, curves and points (or sets of elements, lines and nodes) are its groups; one without a name is
        called surface-3, curve-3 or point-3.

    Raises
    ------
    InputError
        No such file, an unknown format, a file that is not what it should be (with the line), no unit, elements that
        make no shell; a tolerance that merges nodes of one element; a cut along no group.
    MeshError
        What `Mesh` refuses.
    """
    path, name = pathlib.Path(file), pathlib.Path(file).name
    if path.suffix.lower() in GEOMETRY:
        raise InputError(
            f"{name}: is a geometry, not a mesh. Mesh it first: magshell mesh {name} --size LENGTH --out "
            f"{path.with_suffix('.msh').name}, and name that file"
        )
    readable(path)
    contents = contents_of(path, name)
    own, cuts = agreed(unit, contents.unit, name), (cuts,) if isinstance(cuts, str) else tuple(cuts)
    if weld is not None:
        contents = welded(contents, weld, own, cuts)
    try:
        return assemble(contents, name, own, second_order, closed, cuts)
    except MeshError as error:
        advice = f" {ways_out(contents, own)}" if "not joined" in str(error) else ""
        raise MeshError(f"{error}{advice}") from None


def contents_of(path: pathlib.Path, name: str) -> Contents:
    """What a file says, whatever its format."""
    reader = _READERS.get(path.suffix.lower())
    if reader is not None:
        return reader(path, name)
    from magshell.mesh.files.other import read_other

    own = tuple(ending for ending in _READERS if ending != ".med" or find_spec("h5py"))
    return read_other(path, name, own, seconds_for(path))


def _inp(path: pathlib.Path, name: str) -> Contents:
    from magshell.mesh.files.inp import read_inp

    return read_inp(path.read_bytes(), name)


def _unv(path: pathlib.Path, name: str) -> Contents:
    from magshell.mesh.files.unv import read_unv

    return read_unv(path.read_bytes(), name)


def _nastran(path: pathlib.Path, name: str) -> Contents:
    from magshell.mesh.files.nastran import read_nastran

    return read_nastran(path.read_bytes(), name)


def _med(path: pathlib.Path, name: str) -> Contents:
    if find_spec("h5py") is None:
        raise InputError(f'{name}: is read by h5py, which is not installed: pip install "magshell[meshio]"')
    from magshell.mesh.files.med import read_med

    return apart(read_med, path, name, program="h5py", name=name, seconds=seconds_for(path))


def _vtk(path: pathlib.Path, name: str) -> Contents:
    from magshell.mesh.files.vtk import read_vtk

    return apart(read_vtk, path, name, program="VTK", name=name, seconds=seconds_for(path))


def _msh(path: pathlib.Path, name: str) -> Contents:
    """By the plain reader, or by gmsh if that does not read the format."""
    from magshell.mesh.files.msh import PlainReaderError, read_msh
    from magshell.mesh.files.session import INSTALL, installed

    content = path.read_bytes()
    try:
        return read_msh(content, name)
    except PlainReaderError as error:
        if not content.startswith((b"$MeshFormat", b"$Comments")):  # a script to gmsh, which runs it
            raise InputError(f"{name}, line 1: not a .msh file of gmsh, which begins with $MeshFormat") from None
        if not installed():
            raise InputError(f"{error}; or let gmsh read it: {INSTALL}") from None
    from magshell.mesh.files.from_gmsh import read_with_gmsh
    from magshell.mesh.files.scripts import put_alone

    with tempfile.TemporaryDirectory() as folder:
        copy = put_alone(path, pathlib.Path(folder))
        return apart(read_with_gmsh, copy, name, program="gmsh", name=name, seconds=seconds_for(path))


def seconds_for(path: pathlib.Path) -> int:
    """What another program has to read a file: some loop for ever on a damaged one."""
    return SECONDS + path.stat().st_size // BYTES_PER_SECOND


_READERS: dict[str, Callable[[pathlib.Path, str], Contents]] = {
    ".msh": _msh,
    ".inp": _inp,
    ".unv": _unv,
    ".med": _med,
    **dict.fromkeys((".bdf", ".nas", ".fem"), _nastran),
    **dict.fromkeys((".vtu", ".vtp", ".vtk"), _vtk),
}
"""By the ending of a file; meshio reads others."""
