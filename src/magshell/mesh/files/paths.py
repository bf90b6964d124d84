"""Checks of the files that are to be read."""

from __future__ import annotations

import pathlib

from magshell.errors import InputError, suggest

GEOMETRY = (".geo", ".geo_unrolled", ".step", ".stp", ".iges", ".igs", ".brep")
"""Formats that hold shapes and no mesh."""


def readable(path: pathlib.Path) -> None:
    """Refuse a path where there is no file that can be read.

    Raises
    ------
    InputError
        No such file (with the nearest name in that folder), a folder, or one that may not be read.
    """
    try:
        with path.open("rb"):
            return
    except FileNotFoundError:
        folder = path.parent
        try:
            there = [file.name for file in folder.iterdir() if file.is_file()] if folder.is_dir() else []
        except OSError:
            there = []
        raise InputError(f"{path}: there is no such file. {suggest(path.name, there)}") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder; name a file in it") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def textual(path: pathlib.Path) -> None:
    """Refuse a file that does not begin with text, since gmsh may read it for minutes.

    Raises
    ------
    InputError
        It is none.
    """
    with path.open("rb") as file:
        if b"\0" in file.read(4096):
            raise InputError(f"{path.name}: is not a text file; a geometry ({', '.join(GEOMETRY)}) is one")
