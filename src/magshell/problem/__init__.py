"""Problem files: read, check and build them, and the built-in ones."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from magshell.problem.examples import names
from magshell.problem.reading import check, find, parse, read

if TYPE_CHECKING:
    from magshell.problem.building import Problem

__all__ = ["load", "names", "read"]


def load(source: str | os.PathLike[str]) -> Problem:
    """Read a problem file, or a built-in problem by name, and build its model.

    Parameters
    ----------
    source : path or str
        A TOML file, or one of `names()`.

    Returns
    -------
    Problem
        With `model` and `settings`, ready for `magshell.solve`.

    Raises
    ------
    InputError
        One line per error, each with file and key.
    """
    found = find(source)
    file = check(parse(found.text, found.name), found.name)
    from magshell.problem.building import build

    return build(file, *found)
