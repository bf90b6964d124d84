"""gmsh in this process: begun and ended cleanly, silent, with errors in words."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from magshell.errors import InputError
from magshell.processes import let_broken_pipes_raise
from magshell.units import shortened

DEBIAN = "libglu1-mesa libgl1 libxcursor1 libxfixes3 libxft2 libxinerama1 libxrender1 libfontconfig1"
"""Packages whose libraries gmsh's wheel needs."""
INSTALL = 'pip install "magshell[gmsh]"'


def installed() -> bool:
    """Whether gmsh is there."""
    return find_spec("gmsh") is not None


@contextmanager
def session(name: str) -> Iterator[Any]:
    """The module gmsh, initialised and empty; finalised at the end.

    Parameters
    ----------
    name : str
        Of the file that it is for, for messages.

    Raises
    ------
    InputError
        gmsh is not installed, does not load or is in use, or an error of gmsh in the block, in its words.
    """
    gmsh = _loaded(name)
    if gmsh.isInitialized():
        raise InputError(f"{name}: gmsh is in use in this process; end that use first with gmsh.finalize()")
    with quiet():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    let_broken_pipes_raise()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield gmsh
    except InputError:
        raise
    except Exception as error:  # gmsh raises Exception itself
        reason = re.sub(rf"'[^']*{re.escape(name)}', ", "", " ".join(str(error).split()))
        raise InputError(f"{name}: gmsh cannot do it: {_bearable(reason)}") from None
    finally:
        gmsh.finalize()


def _bearable(text: str) -> str:
    """A message of gmsh on one line of bearable length."""
    return text if len(text) <= 200 else f"{text[:197]}..."


def _loaded(name: str) -> Any:
    try:
        import gmsh
    except ImportError:
        raise InputError(f"{name}: needs gmsh, which is not installed: {INSTALL}") from None
    except OSError as error:
        raise InputError(
            f"{name}: gmsh is installed but does not load ({shortened(str(error))}); it needs libraries of the system, "
            f"on Debian and Ubuntu: apt-get install {DEBIAN}"
        ) from None
    return gmsh


@contextmanager
def quiet() -> Iterator[None]:
    """Keep what the geometry kernel prints by itself from the terminal."""
    try:
        streams = [sys.__stdout__.fileno(), sys.__stderr__.fileno()] if sys.__stdout__ and sys.__stderr__ else []
    except (OSError, ValueError):
        streams = []
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    kept = [(stream, os.dup(stream)) for stream in streams]
    with tempfile.TemporaryFile() as nowhere:
        try:
            for stream, _ in kept:
                os.dup2(nowhere.fileno(), stream)
            yield
        finally:
            for stream, copy in kept:
                os.dup2(copy, stream)
                os.close(copy)
