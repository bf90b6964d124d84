"""gmsh, begun and ended, with errors in words. It may crash and changes its process: call it `apart`."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from magshell.errors import InputError
from magshell.units import shortened

DEBIAN = "libglu1-mesa libgl1 libxcursor1 libxfixes3 libxft2 libxinerama1 libxrender1 libfontconfig1"
"""Packages whose libraries gmsh's wheel needs."""
INSTALL = 'pip install "magshell[gmsh]"'


def installed() -> bool:
    """Whether gmsh is there."""
    return find_spec("gmsh") is not None


def required(name: str) -> None:
    """Raise an InputError for a file if gmsh is not installed."""
    if not installed():
        raise InputError(f"{name}: needs gmsh, which is not installed: {INSTALL}")


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
        gmsh does not load, or an error of gmsh in the block, in its words.
    """
    gmsh = _loaded(name)
    for variable in [each for each in os.environ if each.startswith("GMSH")]:
        del os.environ[variable]  # gmsh would load plugins from where they say
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield gmsh
    except InputError:
        raise
    except Exception as error:  # gmsh raises Exception itself
        reason = re.sub(r"'(?:[^']*[/\\])?([^'/\\]*)', (line)", _place, " ".join(str(error).split()))
        reason = reason.replace(f"{name}, line", "line")
        raise InputError(f"{name}: gmsh cannot do it: {_bearable(reason)}") from None
    finally:
        gmsh.finalize()


def _place(found: re.Match[str]) -> str:
    """File and line as gmsh says them, without the folder."""
    return f"{found[1]}, {found[2]}"


def _bearable(text: str) -> str:
    """A message of gmsh on one line of bearable length."""
    return text if len(text) <= 200 else f"{text[:197]}..."


def _loaded(name: str) -> Any:
    try:
        import gmsh
    except OSError as error:
        raise InputError(
            f"{name}: gmsh is installed but does not load ({shortened(str(error))}); it needs libraries of the system, "
            f"on Debian and Ubuntu: apt-get install {DEBIAN}"
        ) from None
    return gmsh
