"""Meshes written as `.msh` files of gmsh, format 4.1."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.files import with_suffix, write_atomically
from magshell.mesh.edges import edge_keys
from magshell.mesh.files.units import length_unit
from magshell.mesh.mesh import Mesh

_TRIANGLE6, _QUAD8, _LINE3, _POINT = 9, 16, 8, 15


def write(mesh: Mesh, file: str | os.PathLike[str], unit: str = "m") -> None:
    """Write a mesh with its groups for gmsh and for `read`; the file says its unit in a comment.

    Parameters
    ----------
    mesh : Mesh
    file : path
        `.msh`.
    unit : str
        Of the lengths in the file: m, cm, mm, um.

    Raises
    ------
    InputError
        No such unit; a name that says another format.
    OSError
        The disk refuses; the message names the file.
    """
    write_atomically(with_suffix(file, ".msh"), msh(mesh, unit))


def msh(mesh: Mesh, unit: str) -> bytes:
    """The content of the file.

    Elements with the same groups make up one entity, which has these groups as its physical tags.
    """
    points = mesh.points / length_unit(unit)
    edges = _all_edges(mesh)
    nodes = np.unique(np.concatenate([np.zeros(0, np.int64), *mesh.node_groups.values()]))
    surfaces = _entities(len(mesh.elements), mesh.element_groups)
    curves = _entities(len(edges), _rows_of(edges, mesh.edge_groups, len(points)))
    places = {name: np.searchsorted(nodes, members) for name, members in mesh.node_groups.items()}
    vertices = _entities(len(nodes), places)
    # An entity of dimension 0 is one point.
    vertices = [(tags, rows[[row]]) for tags, rows in vertices for row in range(len(rows))]
    blocks: list[tuple[int, int, int, IntArray]] = []
    blocks += [(0, tag, _POINT, nodes[rows, None]) for tag, (_, rows) in enumerate(vertices, start=1)]
    blocks += [(1, tag, _LINE3, edges[rows]) for tag, (_, rows) in enumerate(curves, start=1)]
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$Comments", f"magshell: lengths in {unit}", "$EndComments"]
    lines += _physical_names(mesh)
    lines += ["$Entities", f"{len(vertices)} {len(curves)} {len(surfaces)} 0"]
    for tag, (tags, rows) in enumerate(vertices, start=1):
        lines.append(f"{tag} {_numbers(points[nodes[rows[0]]])} {len(tags)} {_integers(tags)}".rstrip())
    for entities, members in ((curves, edges), (surfaces, mesh.elements)):
        for tag, (tags, rows) in enumerate(entities, start=1):
            box = points[members[rows].ravel()]
            extent = f"{_numbers(box.min(axis=0))} {_numbers(box.max(axis=0))}"
            lines.append(f"{tag} {extent} {len(tags)} {_integers(tags)} 0".replace("  ", " "))
    lines += ["$EndEntities", "$Nodes", f"1 {len(points)} 1 {len(points)}", f"2 1 0 {len(points)}"]
    lines += [str(number) for number in range(1, len(points) + 1)]
    lines += [_numbers(point) for point in points]
    lines += ["$EndNodes"]
    lines += _elements(mesh, blocks, surfaces)
    return ("\n".join(lines) + "\n").encode()


def _elements(
    mesh: Mesh, blocks: list[tuple[int, int, int, IntArray]], surfaces: list[tuple[IntArray, IntArray]]
) -> list[str]:
    """The section `$Elements`: those of the surface first, by their numbers in the mesh."""
    count = len(mesh.elements)
    sections = []
    for tag, (_, rows) in enumerate(surfaces, start=1):
        for kind, chosen, columns in (
            (_QUAD8, rows[~mesh.triangles[rows]], list(range(8))),
            (_TRIANGLE6, rows[mesh.triangles[rows]], [0, 1, 2, 4, 5, 7]),
        ):
            if len(chosen):
                sections.append((2, tag, kind, chosen + 1, mesh.elements[chosen][:, columns]))
    number = count + 1
    for dimension, tag, kind, nodes in blocks:
        sections.append((dimension, tag, kind, np.arange(number, number + len(nodes)), nodes))
        number += len(nodes)
    lines = ["$Elements", f"{len(sections)} {number - 1} 1 {number - 1}"]
    for dimension, tag, kind, numbers, nodes in sections:
        lines.append(f"{dimension} {tag} {kind} {len(numbers)}")
        lines += [_integers(row) for row in np.column_stack([numbers, nodes + 1]).tolist()]
    return [*lines, "$EndElements"]


def _physical_names(mesh: Mesh) -> list[str]:
    kinds = ((0, mesh.node_groups), (1, mesh.edge_groups), (2, mesh.element_groups))
    names = [f'{dimension} {tag} "{name}"' for dimension, groups in kinds for tag, name in enumerate(groups, start=1)]
    return ["$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"] if names else []


def _entities(count: int, groups: Mapping[str, IntArray]) -> list[tuple[IntArray, IntArray]]:
    """Tags (from 1, in the order of the groups) and members of each set of things that are in the same groups."""
    inside = np.zeros((count, len(groups)), dtype=bool)
    for column, members in enumerate(groups.values()):
        inside[members, column] = True
    if not count:
        return []
    patterns, which = np.unique(inside, axis=0, return_inverse=True)
    return [
        (np.flatnonzero(pattern) + 1, np.flatnonzero(which.ravel() == number))
        for number, pattern in enumerate(patterns)
    ]


def _all_edges(mesh: Mesh) -> IntArray:
    """Every edge of a group once, in the order in which the groups have them."""
    rows = np.concatenate([np.zeros((0, 3), np.int64), *mesh.edge_groups.values()])
    _, first = np.unique(edge_keys(rows, len(mesh.points)), return_index=True)
    result: IntArray = rows[np.sort(first)]
    return result


def _rows_of(edges: IntArray, groups: Mapping[str, IntArray], node_count: int) -> dict[str, IntArray]:
    """Places of the edges of each group in `edges`."""
    keys = edge_keys(edges, node_count)
    order = np.argsort(keys)
    return {name: order[np.searchsorted(keys[order], edge_keys(rows, node_count))] for name, rows in groups.items()}


def _numbers(values: FloatArray) -> str:
    return " ".join(map(repr, values.tolist()))


def _integers(values: Iterable[int]) -> str:
    return " ".join(map(str, values))
