"""`magshell mesh`."""

from __future__ import annotations

import argparse
import pathlib
from typing import TYPE_CHECKING

from magshell.cli.console import console, say
from magshell.cli.status import SOLVED
from magshell.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.mesh import Mesh
    from magshell.mesh.files import FileMesh

ABOUT = "mesh a geometry with gmsh, or read a mesh file, and say what is in it"
EXAMPLES = """
examples:
  magshell mesh part.step --size "0.5 mm"               writes part.msh
  magshell mesh flower.geo --unit mm --size "0.7 mm" --out flower.msh
  magshell mesh part.msh --unit mm                      says what is in a mesh; writes nothing
  magshell mesh part.inp --unit mm --second-order --out part.msh

A geometry (.geo, .step, .iges, .brep) is meshed by gmsh into quadrilaterals: pip install "magshell[gmsh]".
A mesh (.msh, Abaqus .inp, Nastran .bdf, .unv, .vtu, .vtk, others through pip install "magshell[meshio]") is read,
checked and, with --out, written. STEP and IGES files say the unit of their lengths; of others --unit does. What is
written says its unit itself:
    [mesh]
    file = "part.msh\""""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What follows the command."""
    parser.add_argument("file", metavar="FILE", help="a geometry or a mesh")
    parser.add_argument("--size", metavar="LENGTH", help='side of an element, such as "0.5 mm"; of a geometry only')
    parser.add_argument("--unit", metavar="UNIT", help="of the lengths in the file: m, cm, mm or um")
    parser.add_argument(
        "--out", metavar="FILE.msh", help="the mesh to write; of a geometry: here, by its name, without it"
    )
    parser.add_argument(
        "--second-order", action="store_true", help="raise elements of first order, curved surfaces kept"
    )
    parser.add_argument(
        "--closed", action="store_true", help="a closed surface with edges is meant, such as a box, and no solid's skin"
    )
    parser.add_argument(
        "--trust-script", action="store_true", help="let a .geo run programs and write files, as gmsh does"
    )


def run(given: argparse.Namespace) -> int:
    """Mesh or read, say, write."""
    from magshell.mesh import write
    from magshell.mesh.files.paths import GEOMETRY
    from magshell.mesh.files.summary import in_words

    out = console()
    source = pathlib.Path(given.file)
    geometry = source.suffix.lower() in GEOMETRY
    target = _target(given.out, source, geometry)
    if geometry:
        say(out, f"meshing {source.name} with gmsh ...")
        mesh = _meshed(given)
    else:
        with out.status(f"reading {source.name} ..."):
            mesh = _read(given)
    lines = in_words(mesh, mesh.origin)
    width = max(len(label) for label, _ in lines)
    say(out, source.name, style="bold")
    for label, text in lines:
        say(out, f"  {label:<{width}}  {text}")
    if target is not None:
        write(mesh, target, mesh.origin.unit)
        say(out, f'{target} written; in a problem file: [mesh] file = "{target.name}"')
    return SOLVED


def say_origin(out: Console, mesh: Mesh) -> None:
    """In one line what was read, of a mesh from a file."""
    from magshell.mesh.files import FileMesh
    from magshell.mesh.files.summary import in_a_line

    if isinstance(mesh, FileMesh):
        say(out, f"mesh: {in_a_line(mesh, mesh.origin)}")


def _meshed(given: argparse.Namespace) -> FileMesh:
    from magshell.mesh import from_cad
    from magshell.units import LENGTH, parse

    if given.second_order:
        raise InputError("--second-order: a geometry is meshed to second order anyway; leave it out")
    size = None
    if given.size is not None:
        try:
            size = parse(given.size, LENGTH)
        except InputError as error:
            raise InputError(f"--size: {error}") from None
    return from_cad(given.file, size, given.unit, given.trust_script, given.closed)


def _read(given: argparse.Namespace) -> FileMesh:
    from magshell.mesh import read

    if given.size is not None:
        raise InputError(f"--size: {given.file} is a mesh, whose elements have their size; mesh its geometry anew")
    return read(given.file, given.unit, given.second_order, given.closed)


def _target(out: str | None, source: pathlib.Path, geometry: bool) -> pathlib.Path | None:
    """Where to write; nobody's own file is lost."""
    if out is None and not geometry:
        return None
    target = pathlib.Path(out if out is not None else f"{source.stem}.msh")
    if target.suffix.lower() != ".msh":
        raise InputError(f"--out {target}: a mesh is written as .msh; name it {target.with_suffix('.msh').name}")
    if target.is_dir():
        raise InputError(f"--out {target}: is a folder; name a file in it")
    if target.exists() and source.exists() and target.samefile(source):
        raise InputError(f"--out {target}: is the file that is read; name another")
    if out is None and target.exists() and not _is_ours(target):
        raise InputError(
            f"{target}: exists already and was not made by magshell mesh; say --out {target} to replace it"
        )
    return target


def _is_ours(file: pathlib.Path) -> bool:
    """Whether the file was written by this command."""
    with file.open("rb") as content:
        return b"magshell: lengths in" in content.read(1024)
