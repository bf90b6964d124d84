"""Checks of the arrays and the connectivity of a mesh, before those of its geometry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, MeshError, suggest
from magshell.mesh.edges import COLLAPSED, Edges, edge_keys, is_triangle
from magshell.mesh.wording import further, listing, place

Array = TypeVar("Array", bound=AnyArray)
FARTHEST = 1e12
"""Largest coordinate, m: beyond it no shell exists, and within it no product of lengths overflows."""


def float_rows(values: Any, width: int, what: str) -> FloatArray:
    """Read-only copy (n, width) of `values` as real numbers, or a MeshError with the shape it should have."""
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise MeshError(f"{what}: expected an array of numbers of shape (n, {width}): {error}.") from error
    _expect_rows(array.shape, width, what)
    return locked(array)


def integer_rows(values: Any, width: int | None, what: str) -> IntArray:
    """Read-only copy, (n, width) or for width None (n,), of `values` as whole numbers, or a MeshError."""
    try:
        given = np.asarray(values)
    except ValueError as error:
        raise MeshError(f"{what}: rows of different lengths: {error}.") from error
    if given.dtype.kind not in "iu" and given.size:
        raise MeshError(f"{what}: expected whole numbers, found values of type {given.dtype}.")
    _expect_rows(given.shape, width, what)
    return locked(np.array(given, dtype=np.int64, order="C"))


def locked(array: Array) -> Array:
    """The array itself, from now on read-only."""
    array.setflags(write=False)
    return array


def _expect_rows(shape: tuple[int, ...], width: int | None, what: str) -> None:
    expected = 1 if width is None else 2
    if shape[:1] == (0,):
        raise MeshError(f"{what}: empty; there must be at least one.")
    if len(shape) != expected or (width is not None and shape[1] != width):
        right = "(n,)" if width is None else f"(n, {width})"
        raise MeshError(f"{what}: expected an array of shape {right}, found {shape}.")


def check_numbers(points: FloatArray, elements: IntArray) -> None:
    """Refuse positions that are not finite, impossible node numbers, unused nodes, repeated elements."""
    bad = np.flatnonzero(~(np.abs(points) <= FARTHEST).all(axis=1))
    if bad.size:
        raise MeshError(
            f"Node {bad[0]} has the position {place(points[bad[0]])}: coordinates must be finite, and no larger than "
            f"{FARTHEST:g} m." + further(bad.size)
        )
    bad = np.flatnonzero(((elements < 0) | (elements >= len(points))).any(axis=1))
    if bad.size:
        row = elements[bad[0]]
        wrong = row[(row < 0) | (row >= len(points))][0]
        raise MeshError(
            f"Element {bad[0]} has node {wrong}, but nodes are numbered 0 to {len(points) - 1}." + further(bad.size)
        )
    ordered = np.sort(elements, axis=1)
    repeated = (ordered[:, 1:] == ordered[:, :-1]).sum(axis=1)
    bad = np.flatnonzero(repeated > np.where(is_triangle(elements), 2, 0))
    if bad.size:
        row = ordered[bad[0]]
        raise MeshError(
            f"Element {bad[0]} has node {row[1:][row[1:] == row[:-1]][0]} twice: its 8 nodes must differ, except in a "
            "triangle with corners a, b, c, which is the row a, b, c, c, ab, bc, c, ca, with ab the middle between a "
            "and b." + further(bad.size)
        )
    unused = np.flatnonzero(np.bincount(elements.ravel(), minlength=len(points)) == 0)
    if unused.size:
        raise MeshError(
            f"No element has node {listing(unused)}: remove unused nodes, the first is at {place(points[unused[0]])}."
        )
    _check_duplicates(elements)


def _check_duplicates(elements: IntArray) -> None:
    corners = np.sort(elements[:, :4], axis=1)
    order = np.lexsort(corners.T)
    same = np.flatnonzero((corners[order[1:]] == corners[order[:-1]]).all(axis=1))
    if same.size:
        one, other = sorted((order[same[0]], order[same[0] + 1]))
        raise MeshError(
            f"Elements {one} and {other} have the same corners, nodes {listing(dict.fromkeys(elements[one, :4]))}: "
            f"remove one of them." + further(same.size)
        )


def check_connectivity(points: FloatArray, elements: IntArray, edges: Edges) -> None:
    """Elements on an edge share its middle, which is that of no other edge; a corner is no middle."""
    _check_roles(points, elements)
    partner = edges.first_side[edges.edge_of_side]
    odd = np.flatnonzero(edges.sides[:, 2] != edges.sides[partner, 2])
    if odd.size:
        ends, side = edges.sides[odd[0]], partner[odd[0]]
        raise MeshError(
            f"Elements {side // 4} and {odd[0] // 4} share the corners {ends[0]} and {ends[1]} but "
            f"have different nodes, {edges.sides[side, 2]} and {ends[2]}, in the middle between them: "
            f"they must share that node too." + further(odd.size)
        )
    middles = edges.sides[edges.first_side, 2]
    order = np.argsort(middles, kind="stable")
    twice = np.flatnonzero(middles[order[1:]] == middles[order[:-1]])
    if twice.size:
        one, other = edges.first_side[order[twice[0]]], edges.first_side[order[twice[0] + 1]]
        raise MeshError(
            f"Elements {one // 4} and {other // 4} have node {edges.sides[one, 2]} in the middle of "
            f"two different edges, at {place(points[edges.sides[one, 2]])}." + further(twice.size)
        )


def _check_roles(points: FloatArray, elements: IntArray) -> None:
    corner_in = np.full(len(points), -1)
    corner_in[elements[:, :4].ravel()] = np.repeat(np.arange(len(elements)), 4)
    clashing = corner_in[elements[:, 4:]] >= 0
    clashing[is_triangle(elements), COLLAPSED] = False
    middle, side = np.nonzero(clashing)
    if middle.size:
        node = elements[middle[0], 4 + side[0]]
        raise MeshError(
            f"Node {node} at {place(points[node])} is a corner of element {corner_in[node]} but the middle "
            f"of an edge of element {middle[0]}: the two do not match along that edge, refine element "
            f"{middle[0]} or coarsen its neighbours." + further(middle.size)
        )


def check_groups(
    element_groups: Mapping[str, Any],
    edge_groups: Mapping[str, Any],
    node_groups: Mapping[str, Any],
    points: FloatArray,
    elements: IntArray,
    edges: Edges,
) -> tuple[dict[str, IntArray], dict[str, IntArray], dict[str, IntArray]]:
    """Groups as read-only arrays without repetitions, or a MeshError that names the group at fault."""
    kinds: dict[str, str] = {}
    for kind, names in (("element", element_groups), ("edge", edge_groups), ("node", node_groups)):
        for name in names:
            check_name(name, kind, kinds)
            kinds[name] = kind
    return (
        {
            name: _numbers(values, f"Element group '{name}'", "element", len(elements))
            for name, values in element_groups.items()
        },
        {name: _edge_rows(values, f"Edge group '{name}'", len(points), edges) for name, values in edge_groups.items()},
        {name: _numbers(values, f"Node group '{name}'", "node", len(points)) for name, values in node_groups.items()},
    )


def check_cuts(cuts: Sequence[str] | str, edge_groups: Mapping[str, IntArray]) -> tuple[str, ...]:
    """The names of cuts, or an InputError if one is no edge group."""
    names = (cuts,) if isinstance(cuts, str) else tuple(cuts)
    for name in names:
        if name not in edge_groups:
            raise InputError(f"cuts: there is no edge group '{name}'. {suggest(str(name), edge_groups)}")
    return names


def check_name(name: str, kind: str, kinds: Mapping[str, str]) -> None:
    """Refuse a group name that is empty or taken; `kinds` maps each name in use to element, edge or node."""
    if not isinstance(name, str) or not name.strip():
        raise MeshError(f"{name!r} cannot name the {kind} group: a name must be a text that is not empty.")
    if name in kinds:
        raise MeshError(
            f"Two groups have the name '{name}', one of {kinds[name]}s and one of {kind}s: every group must "
            "have a name of its own."
        )


def _numbers(values: Any, what: str, kind: str, count: int) -> IntArray:
    numbers = integer_rows(values, None, what)
    wrong = numbers[(numbers < 0) | (numbers >= count)]
    if wrong.size:
        raise MeshError(f"{what} has {kind} {listing(wrong)}, but the mesh has {kind}s 0 to {count - 1}.")
    return locked(np.unique(numbers))


def _edge_rows(values: Any, what: str, node_count: int, edges: Edges) -> IntArray:
    rows = integer_rows(values, 3, what)
    wrong = rows[(rows < 0) | (rows >= node_count)]
    if wrong.size:
        raise MeshError(f"{what} has node {listing(wrong)}, but the mesh has nodes 0 to {node_count - 1}.")
    known = edges.real
    keys, found = edge_keys(known, node_count), edge_keys(rows, node_count)
    position = np.searchsorted(keys, found).clip(max=len(keys) - 1)
    strange = np.flatnonzero((keys[position] != found) | (known[position, 2] != rows[:, 2]))
    if strange.size:
        raise MeshError(
            f"{what}: row {strange[0]}, nodes {listing(rows[strange[0]])}, is not an edge of any element; a "
            "row holds the two end nodes and then the middle node of one."
        )
    _, once = np.unique(position, return_index=True)
    unique: IntArray = rows[np.sort(once)]
    return locked(unique)
