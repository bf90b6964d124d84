"""Problem files: read, check and build them, and the built-in ones."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from magshell.problem.examples import names
from magshell.problem.reading import check, find, parse, read

if TYPE_CHECKING:
    from magshell.problem.building import Problem

__all__ = ["load", "names", "read"]


def load(source: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> Problem:
    """Read a problem file, or a built-in problem by name, and build its model.

    Parameters
    ----------
    source : path or str
        A TOML file, or one of `names()`.
    changes : mapping of str to object, optional
        Other values for some keys, written as in the file: {"shell.thickness": "0.8 mm"}. A single quantity for the
        vector of a field, remanence or load is its magnitude (`magshell.problem.changes`).

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
    if changes:
        from magshell.problem.alternatives import value_of
        from magshell.problem.changes import changed

        found = changed(found, {key: value_of(data) for key, data in changes.items()})
    file = check(parse(found.text, found.name), found.name)
    from magshell.problem.building import build
    from magshell.problem.building.material import by_default, tell_once

    built = build(file, *found)
    if (note := by_default(file)) is not None:
        tell_once(f"{found.name}: {note}")
    return built
