"""Copies of problems: one that runs by itself, with the files that it names beside it, and its digest."""

from __future__ import annotations

import hashlib
import json
import pathlib
import re
import tomllib
from typing import Any

from magshell.mesh import Mesh
from magshell.mesh.files.writing import msh
from magshell.problem.building import Problem
from magshell.problem.building.mesh import made_by_gmsh

FOLDER = "inputs"
SELECTIONS = ("element_groups", "edge_groups", "node_groups")
MESH_OF_A_COPY = ("file", "closed", "cuts")
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
    meshed = _meshed(problem)
    if not named and meshed is None:
        return problem.text, {}
    document, copies = tomlkit.parse(problem.text), dict[str, bytes]()
    if meshed is not None:
        table, content = meshed
        copies[table["file"]] = content
        for key in [key for key in document["mesh"] if key not in table]:
            document["mesh"].remove(key)
        document["mesh"].update({key: table[key] for key in MESH_OF_A_COPY if key in table})
    for key, name in named:
        if key == "mesh.file" and meshed is not None:
            continue
        source = problem.folder / name
        copy = _name(source, source.read_bytes(), copies)
        if name != copy:
            _put(document, key, copy)
    return tomlkit.dumps(document), copies


def digest(problem: Problem) -> str:
    """Digest of all that the path depends on, contents of files included; a problem and its copy have the same."""
    content = tomllib.loads(problem.text)
    meshed = _meshed(problem)
    if meshed is not None:
        table, mesh = meshed
        content["mesh"] = {**table, "file": hashlib.sha256(mesh).hexdigest()}
    for key, name in problem.file.files():
        if key != "mesh.file" or meshed is None:
            _put(content, key, hashlib.sha256((problem.folder / name).read_bytes()).hexdigest())
    text = json.dumps({key: value for key, value in content.items() if key not in FREE}, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def _meshed(problem: Problem) -> tuple[dict[str, Any], bytes] | None:
    """The table and file of a mesh that gmsh has made, so that a copy has the same mesh wherever it is."""
    if not made_by_gmsh(problem.file.mesh):
        return None
    given = tomllib.loads(problem.text)["mesh"]
    own = {key: given[key] for key in SELECTIONS if key in given}
    mesh = problem.model.shell.mesh
    groups = (mesh.element_groups, mesh.edge_groups, mesh.node_groups)
    kept = [
        {name: rows for name, rows in every.items() if name not in own.get(key, {})}
        for key, every in zip(SELECTIONS, groups, strict=True)
    ]
    elements, edges, nodes = kept
    name = f"{FOLDER}/{pathlib.Path(given.get('file', 'polygon')).stem}.msh"
    table = {**own, "file": name, "closed": True, **({"cuts": list(mesh.cuts)} if mesh.cuts else {})}
    return table, msh(Mesh(mesh.points, mesh.elements, elements, edges, nodes, mesh.cuts), "m")


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
