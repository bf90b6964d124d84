"""Copies of problems: one that runs by itself, with the files that it names beside it, and its digest."""

from __future__ import annotations

import hashlib
import json
import pathlib
import re
import tomllib
from typing import Any

from magshell.problem.building import Problem

FOLDER = "inputs"
# What the path does not depend on, or may change on the way.
FREE = ("title", "description", "results", "solver")


def alone(problem: Problem) -> tuple[str, dict[str, bytes]]:
    """The problem's text with the names of copies of its files in the folder `inputs`; the copies by these names.

    Comments and layout stay as they are.

    Raises
    ------
    OSError
        A file has gone.
    """
    import tomlkit

    named = problem.file.files()
    if not named:
        return problem.text, {}
    document, copies = tomlkit.parse(problem.text), dict[str, bytes]()
    for key, name in named:
        source = problem.folder / name
        copy = _name(source, source.read_bytes(), copies)
        if name != copy:
            _put(document, key, copy)
    return tomlkit.dumps(document), copies


def digest(problem: Problem) -> str:
    """Of all that the path depends on, the content of files included: that of a problem is that of its copy."""
    content = tomllib.loads(problem.text)
    for key, name in problem.file.files():
        _put(content, key, hashlib.sha256((problem.folder / name).read_bytes()).hexdigest())
    text = json.dumps({key: value for key, value in content.items() if key not in FREE}, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def _name(source: pathlib.Path, content: bytes, copies: dict[str, bytes]) -> str:
    """A name for a copy, which is added; files with the same name and other content get a number."""
    number, copy = 1, f"{FOLDER}/{source.name}"
    while copies.setdefault(copy, content) != content:
        number += 1
        copy = f"{FOLDER}/{source.stem}-{number}{source.suffix}"
    return copy


def _put(content: Any, key: str, value: str) -> None:
    """Put a value at a key such as `remanence[1].file`."""
    *way, last = [int(part) if part.isdigit() else part for part in re.split(r"\.|\[|\]\.?", key) if part]
    for part in way:
        content = content[part]
    content[last] = value
