"""CPU time of reading a .msh and an .inp of 100 000 elements: by the plain readers, by gmsh, until a mesh is checked.

python benchmarks/mesh_files.py [elements around]        half a minute; needs the extra gmsh
"""

from __future__ import annotations

import os

os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

import pathlib
import sys
import tempfile
import time
from collections.abc import Callable

import magshell as ms
from magshell.mesh.files.assembling import assemble
from magshell.mesh.files.from_gmsh import contents_of
from magshell.mesh.files.inp import read_inp
from magshell.mesh.files.msh import read_msh
from magshell.mesh.files.session import session


def timed(what: str, action: Callable[[], object]) -> object:
    """Say the CPU time of an action; return what it returns."""
    start = time.process_time()
    result = action()
    print(f"{what:<42} {time.process_time() - start:6.2f} s")
    return result


def deck(mesh: ms.mesh.Mesh) -> bytes:
    """Abaqus' input file of a mesh, with a set of all nodes and one of half the elements."""
    lines = ["*Node, nset=all"]
    lines += [f"{number}, {', '.join(map(repr, point))}" for number, point in enumerate(mesh.points.tolist(), 1)]
    lines += ["*Element, type=S8R, elset=tube"]
    lines += [f"{number}, {', '.join(map(str, row))}" for number, row in enumerate((mesh.elements + 1).tolist(), 1)]
    lines += ["*Nset, nset=part, generate", f"1, {len(mesh.points)}, 3", "*Elset, elset=half"]
    half = [str(number) for number in range(1, len(mesh.elements), 2)]
    lines += [", ".join(half[start : start + 16]) for start in range(0, len(half), 16)]
    return "\n".join([*lines, ""]).encode()


def main() -> None:
    """Print the figures."""
    around = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    mesh = ms.mesh.cylinder(0.1, 0.1, (around, around * 5 // 8))
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "tube.msh")
        timed(f"write {len(mesh.elements)} elements", lambda: ms.mesh.write(mesh, file))
        print(f"{'size of the file':<42} {file.stat().st_size / 1e6:6.1f} MB")
        contents = timed("plain reader, format 4.1", lambda: read_msh(file.read_bytes(), file.name))
        with session(file.name) as gmsh:
            timed("gmsh, format 4.1", lambda: gmsh.merge(str(file)))
            timed("  and out of gmsh", lambda: contents_of(gmsh, file.name))
            gmsh.option.setNumber("Mesh.SaveAll", 1)
            gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
            gmsh.write(str(file.with_name("old.msh")))
        old = file.with_name("old.msh")
        timed("plain reader, format 2.2", lambda: read_msh(old.read_bytes(), old.name))
        with session(old.name) as gmsh:
            timed("gmsh, format 2.2", lambda: gmsh.merge(str(old)))
        text = deck(mesh)
        print(f"{'size of the .inp':<42} {len(text) / 1e6:6.1f} MB")
        timed("plain reader, .inp", lambda: read_inp(text, "tube.inp"))
        timed("from what is read to a checked mesh", lambda: assemble(contents, file.name, "m", second_order=False))


if __name__ == "__main__":
    main()
