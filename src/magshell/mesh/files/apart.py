"""Readers of other programs, in a process of their own: on a damaged file they may crash, which then ends only that."""

from __future__ import annotations

import os
import pathlib
import pickle
import subprocess
import sys

from magshell.errors import InputError
from magshell.mesh.files.contents import Contents

_PROGRAMS = {"vtk": "VTK", "gmsh": "gmsh"}


def read_apart(reader: str, path: pathlib.Path, name: str) -> Contents:
    """What a reader makes of a file.

    Parameters
    ----------
    reader : {"vtk", "gmsh"}
        `read_vtk` or `read_with_gmsh`.
    path : pathlib.Path
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        What the reader refuses, or that it has crashed.
    """
    done = subprocess.run(
        [sys.executable, "-m", "magshell.mesh.files.apart", reader, str(path), name],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(part for part in sys.path if part)},
        check=False,
    )
    try:
        found = pickle.loads(done.stdout)
    except (EOFError, pickle.UnpicklingError):
        raise InputError(f"{name}: is damaged: {_PROGRAMS[reader]} crashes on it") from None
    if isinstance(found, str):
        raise InputError(found)
    assert isinstance(found, Contents)
    return found


def _main(reader: str, path: str, name: str) -> None:
    """Read, and send what was read, or what is wrong, to standard output, on which nobody else writes."""
    with os.fdopen(os.dup(1), "wb") as answer:
        os.dup2(2, 1)
        answer.write(pickle.dumps(_read(reader, pathlib.Path(path), name)))


def _read(reader: str, path: pathlib.Path, name: str) -> Contents | str:
    from magshell.mesh.files.from_gmsh import read_with_gmsh
    from magshell.mesh.files.vtk import read_vtk

    _limit_memory()
    try:
        return {"vtk": read_vtk, "gmsh": read_with_gmsh}[reader](path, name)
    except InputError as error:
        return str(error)
    except Exception as error:
        return f"{name}: cannot be read by {_PROGRAMS[reader]}: {type(error).__name__}; it is damaged"


def _limit_memory() -> None:
    """No more than the machine has: a damaged count may ask for anything."""
    try:
        import resource

        there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        resource.setrlimit(resource.RLIMIT_AS, (there, resource.getrlimit(resource.RLIMIT_AS)[1]))
    except (ImportError, ValueError, OSError):
        return


if __name__ == "__main__":
    _main(*sys.argv[1:])
