"""From the contents of a file to a mesh: checked, turned, raised, without unused nodes; and a record of the changes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError, MeshError
from magshell.mesh.checks import check_cuts
from magshell.mesh.cuts import opened
from magshell.mesh.edges import edge_keys, find_edges
from magshell.mesh.files.cells import MISSING
from magshell.mesh.files.contents import Contents
from magshell.mesh.files.names import named
from magshell.mesh.files.orientation import agreeing
from magshell.mesh.files.raising import raise_order
from magshell.mesh.files.skins import skin_of_a_solid
from magshell.mesh.mesh import Mesh
from magshell.units import LENGTH

Groups = dict[str, IntArray]


@dataclass(frozen=True)
class Origin:
    """Where a mesh comes from and what was done to it.

    Attributes
    ----------
    file : str
        Name of the file.
    unit : str
        Of the lengths in the file.
    changes : tuple of str
        What is not as the file says: turned, raised, left out.
    thickness : float or None
        Of the solid whose mid-surface it is, m.
    """

    file: str
    unit: str
    changes: tuple[str, ...] = ()
    thickness: float | None = None


@dataclass(frozen=True, eq=False, repr=False)
class FileMesh(Mesh):
    """A mesh that was read from a file; `origin` says how."""

    origin: Origin = field(kw_only=True)


def assemble(
    contents: Contents, name: str, unit: str, second_order: bool, closed: bool = False, cuts: Sequence[str] = ()
) -> FileMesh:
    """The mesh that a file holds.

    Parameters
    ----------
    contents : Contents
    name : str
        Of the file, for messages.
    unit : str
        Of its lengths.
    second_order : bool
        Whether elements of first order get middles.
    closed : bool
        Whether a closed surface with sharp edges or parallel faces is meant, and not the skin of a solid.
    cuts : sequence of str
        Groups of edges along which the surface is cut, or to be cut.

    Raises
    ------
    InputError
        Solids and their skins, elements that cannot be used, no surface, elements of first order that are not to be
        raised; no such group to cut along.
    MeshError
        What `Mesh` refuses.
    """
    changes = list(contents.notes)
    rows, element_groups = _surface(contents, name, changes)
    rows = _triangles_from_quads(rows)
    rows, element_groups = _without_repetitions(rows, element_groups, changes)
    rows, turned, against = agreeing(rows)
    if turned:
        changes.append(f"{turned} of {len(rows)} elements turned, so that the normals of neighbours agree")
    if against:
        changes.append(f"the surface has one side only: its normals change sign across {against} edges")
    points = contents.points
    if not closed:
        _no_skin(skin_of_a_solid(points, rows), name, len(rows))
    node_groups = _node_groups(contents)
    if (rows == MISSING).any():
        _may_be_raised(rows, name, second_order)
        before, raised = len(points), raise_order(points, rows)
        points, rows = raised.points, raised.rows
        node_groups = _with_middles(node_groups, rows, before, changes)
        sharp = f", {raised.creases} edges are creases" if raised.creases else ""
        changes.append(
            f"raised to second order: {raised.middles} mid-side nodes, {raised.curved} of them off the straight "
            f"line{sharp}"
        )
    edge_groups = _edge_groups(contents, rows, len(points), changes)
    used, compact = np.unique(rows, return_inverse=True)
    if len(used) < len(points):
        changes.append(f"{len(points) - len(used)} nodes left out, which no element has")
    new = np.full(len(points), MISSING)
    new[used] = np.arange(len(used))
    node_groups = _left(
        {group: kept[kept >= 0] for group, nodes in node_groups.items() for kept in (new[nodes],)},
        "node of an element",
        changes,
    )
    element_groups, edge_groups, node_groups = (
        _ordered(groups, contents.order) for groups in (element_groups, edge_groups, node_groups)
    )
    names, renamed = named((element_groups, edge_groups, node_groups))
    changes += renamed
    mesh = (
        points[used] * float(LENGTH.units[unit]),
        compact.reshape(rows.shape),
        {names[1, group]: new[edges] for group, edges in edge_groups.items()},
        {names[2, group]: nodes for group, nodes in node_groups.items()},
    )
    points, rows, edge_groups, node_groups = opened(*mesh, check_cuts(cuts, mesh[2]))
    if len(points) > len(used):
        changes.append(f"cut open along {' and '.join(cuts)}: {len(points) - len(used)} nodes doubled")
    try:
        return FileMesh(
            points,
            rows,
            {names[0, group]: rows_ for group, rows_ in element_groups.items()},
            edge_groups,
            node_groups,
            cuts,
            origin=Origin(name, unit, tuple(changes)),
        )
    except MeshError as error:
        raise MeshError(f"{name}: {error}") from None


def _stacked(contents: Contents, dimension: int, width: int) -> tuple[IntArray, Groups]:
    """Rows and groups of all elements of a dimension, by rising number."""
    blocks = [block for block in contents.blocks if block.kind.dimension == dimension]
    rows = [np.zeros((0, width), dtype=np.int64), *(block.kind.rows(block.nodes) for block in blocks)]
    numbers = np.concatenate([np.zeros(0, dtype=np.int64), *(block.numbers for block in blocks)])
    order = np.argsort(numbers, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    members: dict[str, list[IntArray]] = {}
    start = 0
    for block in blocks:
        for group, inside in block.groups.items():
            members.setdefault(group, []).append(rank[start + inside])
        start += len(block.numbers)
    return np.concatenate(rows)[order], {group: np.sort(np.concatenate(each)) for group, each in members.items()}


def _surface(contents: Contents, name: str, changes: list[str]) -> tuple[IntArray, Groups]:
    if contents.solids:
        raise InputError(
            f"{name}: has {contents.solids} solid elements (tetrahedra, hexahedra, ...). A shell is the mesh of a "
            "mid-surface, and its thickness is a number in the problem file: draw and mesh that surface instead; of a "
            "sheet of one thickness, mid_surface = true (magshell mesh: --mid-surface) finds it."
        )
    if contents.unread:
        listed = ", ".join(f"{count} of type {kind}" for kind, count in contents.unread.items())
        raise InputError(
            f"{name}: has elements of types that cannot be used: {listed}. Without them the surface would have holes. "
            "There may be triangles and quadrilaterals of first or second order: mesh with these, or delete the "
            "elements if they are no part of the shell."
        )
    rows, groups = _stacked(contents, 2, 8)
    if not len(rows):
        there = {block.kind.name: 0 for block in contents.blocks}
        for block in contents.blocks:
            there[block.kind.name] += len(block.numbers)
        listed = ", ".join(f"{count} {kind}" for kind, count in there.items()) or "no elements"
        raise InputError(
            f"{name}: has no triangles or quadrilaterals ({listed}). Mesh the surface (gmsh -2), and if there are "
            "physical groups, give the surface one: gmsh saves only elements of physical groups."
        )
    return rows, groups


def _no_skin(reason: str, name: str, count: int) -> None:
    if reason:
        raise InputError(
            f"{name}: is the skin of a solid: {count} elements are a closed surface, and {reason}. A shell is the mesh "
            "of a mid-surface, and its thickness is a number in the problem file: export that surface; of a sheet of "
            "one thickness, mid_surface = true (magshell mesh: --mid-surface) finds it. If the closed surface is the "
            "shell, as of a thin-walled box, write closed = true (magshell mesh: --closed)."
        )


def _triangles_from_quads(rows: IntArray) -> IntArray:
    """Quadrilaterals with a side of no length as triangles, which some programs write so."""
    result = rows.copy()
    for side in range(4):
        following = (side + 1) % 4
        middle = rows[:, 4 + side]
        closed = (rows[:, side] == rows[:, following]) & ((middle == MISSING) | (middle == rows[:, side]))
        turned = np.roll(np.arange(4), 2 - side)
        result[closed] = rows[closed][:, [*turned, *(turned + 4)]]
        result[closed, 6] = result[closed, 2]
    return result


def _without_repetitions(rows: IntArray, groups: Groups, changes: list[str]) -> tuple[IntArray, Groups]:
    """Elements that stand in the file several times, as for several groups, once."""
    _, first, same = np.unique(np.sort(rows[:, :4], axis=1), axis=0, return_index=True, return_inverse=True)
    if len(first) == len(rows):
        return rows, groups
    kept = np.sort(first)
    place = np.searchsorted(kept, first[same.ravel()])
    changes.append(f"{len(rows) - len(kept)} elements left out, which were there before")
    return rows[kept], {group: np.unique(place[inside]) for group, inside in groups.items()}


def _may_be_raised(rows: IntArray, name: str, second_order: bool) -> None:
    if second_order:
        return
    count = int((rows == MISSING).any(axis=1).sum())
    raise InputError(
        f"{name}: {count} of {len(rows)} elements are of first order; the shell needs the nodes in the middle of their "
        "sides. Let the program that made the mesh make them (gmsh: Mesh.ElementOrder = 2 and "
        "Mesh.SecondOrderIncomplete = 1), or write second_order = true (magshell mesh: --second-order): they are then "
        "put on the curved surface that the elements approximate."
    )


def _with_middles(groups: Groups, rows: IntArray, before: int, changes: list[str]) -> Groups:
    """Node groups with the new middles (numbers from `before`) between two of their nodes."""
    edges = find_edges(rows)
    sides = edges.real[edges.real[:, 2] >= before]
    result = {}
    for group, nodes in groups.items():
        inside = np.isin(sides[:, :2], nodes).all(axis=1)
        result[group] = np.concatenate([nodes, sides[inside, 2]])
    if groups:
        changes.append("new mid-side nodes joined the node groups that have both ends of their edge")
    return result


def _edge_groups(contents: Contents, rows: IntArray, node_count: int, changes: list[str]) -> Groups:
    """Edges of the elements that the lines of the file lie on, in the sense of the lines."""
    lines, members = _stacked(contents, 1, 3)
    edges = find_edges(rows)
    known = edges.real
    keys = edge_keys(known, node_count)
    wanted = edge_keys(lines, node_count)
    place = np.searchsorted(keys, wanted).clip(max=len(keys) - 1)
    there = keys[place] == wanted
    on_edges = np.column_stack([lines[:, :2], known[place, 2]])
    groups = {group: on_edges[inside[there[inside]]] for group, inside in members.items()}
    lost = sum(int((~there[inside]).sum()) for inside in members.values())
    if lost:
        changes.append(f"{lost} lines left out of groups, as they are on no edge of an element")
    return _left(groups, "edge of an element", changes)


def _node_groups(contents: Contents) -> Groups:
    """Groups of points that are elements, and those of nodes."""
    points, members = _stacked(contents, 0, 1)
    groups = {group: points[inside, 0] for group, inside in members.items()}
    for group, nodes in contents.node_groups.items():
        groups[group] = np.union1d(groups[group], nodes) if group in groups else nodes
    return groups


def _ordered(groups: Groups, order: tuple[str, ...]) -> Groups:
    first = {name: groups[name] for name in order if name in groups}
    return first | groups


def _left(groups: Groups, what: str, changes: list[str]) -> Groups:
    """The groups that still hold something."""
    empty: Iterable[str] = [group for group, members in groups.items() if not len(members)]
    changes += [f"group '{group}' left out, as it has no {what}" for group in empty]
    return {group: members for group, members in groups.items() if len(members)}
