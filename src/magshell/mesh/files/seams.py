"""Seams and cuts of mesh files: nodes that lie on each other, merged or meant."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.cuts import cut
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.contents import Block, Contents
from magshell.mesh.files.units import length_unit
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.unmatched import coincident
from magshell.mesh.welding import merged


def welded(contents: Contents, tolerance: float, unit: str, cuts: Collection[str]) -> Contents:
    """A file whose nodes that are no further apart than a tolerance are one.

    Parameters
    ----------
    contents : Contents
    tolerance : float
        m.
    unit : str
        Of the lengths in the file.
    cuts : collection of str
        Groups of lines whose nodes stay apart, and those that lie on them.

    Raises
    ------
    InputError
        Not a positive length; one that merges nodes of one element.
    """
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"weld: {tolerance!r} is not allowed; it must be a positive length, in m")
    points, reach = contents.points, tolerance / length_unit(unit)
    apart = np.zeros(len(points), dtype=bool)
    for name in cuts:
        apart[_nodes(contents, name)] = True
    keeper = merged(points, reach, apart)
    for block in contents.blocks:
        bad = np.flatnonzero(_repeated(keeper[block.nodes]) > _repeated(block.nodes))
        if bad.size:
            x = points[block.nodes[bad[0]]]
            where = ", ".join(f"{value:.6g}" for value in x.mean(axis=0))
            raise InputError(
                f"weld: {reach:.6g} {unit} merges nodes of one element, at ({where}) {unit}; it must be smaller than "
                "the distance between any two nodes of an element"
            )
    kept, number = np.unique(keeper, return_inverse=True)
    count = len(points) - len(kept)
    what = f"{count} nodes welded to others," if count else "nothing welded: there are no two nodes"
    return replace(
        contents,
        points=points[kept],
        blocks=[replace(block, nodes=number[block.nodes]) for block in contents.blocks],
        node_groups={name: np.unique(number[nodes]) for name, nodes in contents.node_groups.items()},
        notes=(*contents.notes, f"{what} within {reach:.6g} {unit}"),
    )


def cut_open(mesh: FileMesh, cuts: Sequence[str]) -> FileMesh:
    """A mesh that gmsh made, cut open along edge groups, which its origin tells.

    Raises
    ------
    InputError
        As `magshell.mesh.cut`.
    """
    names = (cuts,) if isinstance(cuts, str) else tuple(cuts)
    if not names:
        return mesh
    made = cut(mesh, names)
    told = f"cut open along {' and '.join(names)}: {len(made.points) - len(mesh.points)} nodes doubled"
    return replace(made, origin=replace(mesh.origin, changes=(*mesh.origin.changes, told)))


def ways_out(contents: Contents, unit: str) -> str:
    """What to do about nodes that lie on each other: weld them, or name the groups along which they do."""
    nodes = coincident(contents.points)
    names = dict.fromkeys(name for block in _lines(contents) for name in block.groups)
    along = [name for name in names if np.isin(_nodes(contents, name), nodes).mean() > 0.5]
    said = along or ["NAME"]
    named = "" if along else ", with the NAME of a group of edges along it"
    size = float(np.linalg.norm(np.ptp(contents.points, axis=0)))
    reach = f"{float(f'{2.0 * COINCIDENT * size:.0e}'):g} {unit}"
    return (
        f'If these are one node, weld = "{reach}" joins them (magshell mesh: --weld "{reach}"); if the surface is cut '
        f"there, cuts = {json.dumps(said, ensure_ascii=False)} keeps them apart "
        f"({' '.join(f'--cut {json.dumps(name, ensure_ascii=False)}' for name in said)}){named}."
    )


def _nodes(contents: Contents, name: str) -> IntArray:
    """Nodes of the lines of a group."""
    found = [block.nodes[block.groups[name]].ravel() for block in _lines(contents) if name in block.groups]
    return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *found]))


def _lines(contents: Contents) -> list[Block]:
    return [block for block in contents.blocks if block.kind.dimension == 1]


def _repeated(nodes: IntArray) -> IntArray:
    """How often rows (k, nodes) have a node again."""
    flat = np.sort(nodes, axis=1)
    count: IntArray = (flat[:, 1:] == flat[:, :-1]).sum(axis=1)
    return count
