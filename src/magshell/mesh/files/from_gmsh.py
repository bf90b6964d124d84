"""The current model of gmsh as the contents of a file."""

from __future__ import annotations

import pathlib
from dataclasses import replace
from typing import Any, NoReturn

import numpy as np

from magshell.errors import InputError
from magshell.mesh.files.cells import GMSH
from magshell.mesh.files.contents import GROUPED, Block, Contents, in_order, places
from magshell.mesh.files.session import session


def read_with_gmsh(path: pathlib.Path, name: str) -> Contents:
    """Read a `.msh` file through gmsh: binary files, other versions, partitions.

    Parameters
    ----------
    path : pathlib.Path
        With nothing beside it: gmsh runs what stands in a file of options there.
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        gmsh is not there, or refuses the file.
    """
    with session(name) as gmsh:
        gmsh.merge(str(path))
        return contents_of(gmsh, name)


def contents_of(gmsh: Any, name: str) -> Contents:
    """Nodes, elements and physical groups of gmsh's current model; what is in no group only if it is of the surface."""

    def twice(row: int) -> NoReturn:
        raise InputError(f"{name}: node {tags[row]} is there twice")

    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    if not len(tags):
        raise InputError(f"{name}: has no mesh")
    numbers, every = in_order(np.array(tags, dtype=np.int64), np.array(coordinates).reshape(-1, 3), twice)

    def missing(row: int, number: int) -> NoReturn:
        raise InputError(f"{name}: an element has node {number}, which is not there")

    blocks: list[Block] = []
    unread: dict[str, int] = {}
    for dimension, entity in gmsh.model.getEntities():
        if dimension == 3:
            continue
        names = _group_names(gmsh, dimension, entity)
        for kind_number, elements, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity), strict=True):
            if dimension < 2 and not names:
                continue
            kind = GMSH.get(int(kind_number))
            if kind is None:
                called = f"{kind_number} ({gmsh.model.mesh.getElementProperties(kind_number)[0]})"
                unread[called] = unread.get(called, 0) + len(elements)
                continue
            rows = places(numbers, np.array(nodes, dtype=np.int64).reshape(-1, kind.nodes), missing)
            everything = np.arange(len(elements))
            blocks.append(Block(kind, np.array(elements, dtype=np.int64), rows, dict.fromkeys(names, everything)))
    solids = sum(len(each) for each in gmsh.model.mesh.getElements(3)[1])
    groups = gmsh.model.getPhysicalGroups()
    order = tuple(gmsh.model.getPhysicalName(dimension, tag) for dimension, tag in groups)
    used = np.unique(np.concatenate([block.nodes.ravel() for block in blocks])) if blocks else np.zeros(0, np.int64)
    blocks = [replace(block, nodes=np.searchsorted(used, block.nodes)) for block in blocks]
    return Contents(every[used], blocks, solids=solids, unread=unread, order=order)


def _group_names(gmsh: Any, dimension: int, entity: int) -> list[str]:
    """Names of the physical groups of an entity; of one without a name, its dimension and number."""
    tags = [abs(int(tag)) for tag in gmsh.model.getPhysicalGroupsForEntity(dimension, entity)]
    return [gmsh.model.getPhysicalName(dimension, tag) or f"{GROUPED[dimension]}-{tag}" for tag in tags]
