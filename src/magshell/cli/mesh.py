"""`magshell mesh`."""

from __future__ import annotations

import argparse
import json
import pathlib
from typing import TYPE_CHECKING

from magshell.cli.console import console, say
from magshell.cli.status import SOLVED
from magshell.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.mesh import Mesh
    from magshell.mesh.opening import Wishes

ABOUT = "mesh a drawing or a geometry with gmsh, or read a mesh file, and say what is in it"
EXAMPLES = """
examples:
  magshell mesh part.step --size "0.5 mm"               writes part.msh
  magshell mesh flower.geo --unit mm --size "0.7 mm" --out flower.msh
  magshell mesh outline.dxf --size "1 mm"               layers become groups
  magshell mesh plate.stl --unit mm --mid-surface       of the skin of a solid, or of a body or solid elements
  magshell mesh part.msh --unit mm                      says what is in a mesh; writes nothing
  magshell mesh part.inp --unit mm --second-order --out part.msh

A geometry (.geo, .step, .iges, .brep) is meshed by gmsh into quadrilaterals: pip install "magshell[gmsh]".
So are the outlines of a drawing (.dxf, .svg, .csv) and mid-surfaces: pip install "magshell[drawings]".
A mesh (.msh, Abaqus .inp, Nastran .bdf, .unv, .vtu, .vtk, others through pip install "magshell[meshio]") is read,
checked and, with --out, written. STEP and IGES files say the unit of their lengths; of others --unit does. What is
written says its unit itself:
    [mesh]
    file = "part.msh\""""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("file", metavar="FILE", help="a drawing, a geometry or a mesh")
    parser.add_argument("--size", metavar="LENGTH", help='side of an element, such as "0.5 mm"; not for a mesh')
    parser.add_argument("--unit", metavar="UNIT", help="of the lengths in the file: m, cm, mm or um")
    parser.add_argument(
        "--out", metavar="FILE.msh", help="the mesh to write (default for a geometry: its name, in this folder)"
    )
    parser.add_argument(
        "--second-order", action="store_true", help="raise elements of first order to second, keeping curved surfaces"
    )
    parser.add_argument(
        "--closed",
        action="store_true",
        help="the closed surface is a shell, such as a box, and not the skin of a solid",
    )
    parser.add_argument(
        "--mid-surface",
        action="store_true",
        help="mesh the mid-surface of a solid of constant thickness: a body, solid elements, or a skin",
    )
    parser.add_argument(
        "--holes", metavar="LAYER", action="append", help="a layer of a drawing whose outlines are holes; once for each"
    )
    parser.add_argument("--gap", metavar="LENGTH", help="join ends of a drawing's lines that are closer than this")
    parser.add_argument(
        "--weld",
        metavar="LENGTH",
        help="merge nodes of a mesh that are no further apart, as at an open seam",
    )
    parser.add_argument(
        "--cut", metavar="GROUP", action="append", help="edges along which the surface is cut; once for each group"
    )
    parser.add_argument(
        "--trust-script", action="store_true", help="let a .geo run programs and write files, as gmsh does"
    )


def run(given: argparse.Namespace) -> int:
    """Mesh or read, say, write."""
    from magshell.mesh import write
    from magshell.mesh.files.summary import in_words
    from magshell.mesh.opening import meshes, open_mesh

    out = console()
    source, wishes = pathlib.Path(given.file), _wishes(given)
    made = meshes(source, wishes)
    target = _target(given.out, source, made)
    if made:
        say(out, f"meshing {source.name} with gmsh ...")
        mesh = open_mesh(source, wishes)
    else:
        with out.status(f"reading {source.name} ..."):
            mesh = open_mesh(source, wishes)
    lines = in_words(mesh, mesh.origin)
    width = max(len(label) for label, _ in lines)
    say(out, source.name, style="bold")
    for label, text in lines:
        say(out, f"  {label:<{width}}  {text}")
    if target is not None:
        write(mesh, target, mesh.origin.unit)
        cuts = f", cuts = {json.dumps(mesh.cuts, ensure_ascii=False)}" if mesh.cuts else ""
        say(out, f'{target} written; in a problem file: [mesh] file = "{target.name}"{cuts}')
    return SOLVED


def say_origin(out: Console, mesh: Mesh) -> None:
    """Report the file of a mesh in one line."""
    from magshell.mesh.files import FileMesh
    from magshell.mesh.files.summary import in_a_line

    if isinstance(mesh, FileMesh):
        say(out, f"mesh: {in_a_line(mesh, mesh.origin)}")


def _wishes(given: argparse.Namespace) -> Wishes:
    from magshell.mesh.opening import Wishes
    from magshell.units import LENGTH, parse

    lengths = {}
    for option in ("size", "gap", "weld"):
        said = getattr(given, option)
        try:
            lengths[option] = None if said is None else parse(said, LENGTH)
        except InputError as error:
            raise InputError(f"--{option}: {error}") from None
    return Wishes(
        unit=given.unit,
        size=lengths["size"],
        second_order=given.second_order,
        closed=given.closed,
        mid_surface=given.mid_surface,
        holes=tuple(given.holes or ()),
        gap=lengths["gap"],
        weld=lengths["weld"],
        cuts=tuple(given.cut or ()),
        trust_script=given.trust_script,
    )


def _target(out: str | None, source: pathlib.Path, geometry: bool) -> pathlib.Path | None:
    """Where to write; files that the command did not write are not replaced."""
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
