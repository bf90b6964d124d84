"""Instances and the assembly as one mesh, and their sets and surfaces as its groups."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NoReturn, TypeVar

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.edges import SIDES
from magshell.mesh.files.cells import LINE2, LINE3, MISSING, Kind
from magshell.mesh.files.contents import Block, Contents, in_order, places
from magshell.mesh.files.inp.blocks import members
from magshell.mesh.files.inp.frames import Move
from magshell.mesh.files.inp.scope import NamedSet, Numbers, Scope, Surface
from magshell.mesh.files.inp.types import is_plane
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_LARGEST = 20_000_000
"""Nodes of all instances together."""
_FACES = {"", "SPOS", "SNEG", "POS", "NEG", "P", "N", "S1", "S2"}
"""Of shells and membranes: the whole element. S1 and S2 are CalculiX's names."""
_EDGES = {f"E{side + 1}": side for side in range(4)}
_SHELL_EDGES = _EDGES | {f"S{side + 3}": side for side in range(4)}
"""Of shells and membranes; those with S are CalculiX's names."""
_PLANE_EDGES = _EDGES | {f"S{side + 1}": side for side in range(4)}
_TRIANGLE_SIDES = (0, 1, 3)
"""Which of `SIDES` the sides of a triangle are."""


T = TypeVar("T", NamedSet, Surface)


@dataclass(frozen=True)
class Placed:
    """A scope where it is: an instance, moved, or the assembly."""

    scope: Scope
    move: Move | None = None


@dataclass(frozen=True)
class _Rows:
    """All elements of one type in a scope."""

    type_name: str
    kind: Kind
    numbers: IntArray
    nodes: IntArray
    """Rows of all nodes of the mesh."""
    groups: dict[str, IntArray] = field(default_factory=dict)


class _Numbered:
    """A scope with its nodes and elements by number."""

    def __init__(self, lines: Lines, placed: Placed, start: int) -> None:
        self.lines, self.scope, self.start = lines, placed.scope, start
        blocks = self.scope.nodes
        where = np.concatenate([np.zeros(0, dtype=np.int64), *(block.lines for block in blocks)])
        numbers = np.concatenate([np.zeros(0, dtype=np.int64), *(block.numbers for block in blocks)])

        def twice(row: int) -> NoReturn:
            lines.fail(int(where[row]), f"node {numbers[row]} is given a second time")

        points = np.concatenate([np.zeros((0, 3)), *(block.points for block in blocks)])
        self.node_numbers, points = in_order(numbers, points, twice)
        self.points: FloatArray = points if placed.move is None else placed.move(points)
        self._refuse_repeated()
        self.rows = [self._rows(name) for name in dict.fromkeys(block.type_name for block in self.scope.elements)]

    def _refuse_repeated(self) -> None:
        blocks = self.scope.every
        if not blocks:
            return
        numbers = np.concatenate([block.numbers for block in blocks])
        where = np.concatenate([block.lines for block in blocks])
        order = np.lexsort((where, numbers))
        same = np.flatnonzero(numbers[order][1:] == numbers[order][:-1])
        if same.size:
            first, second = order[same[0]], order[same[0] + 1]
            self.lines.fail(
                int(where[second]), f"element {numbers[second]} is given a second time; line {where[first] + 1} has it"
            )

    def _rows(self, type_name: str) -> _Rows:
        """The elements of a type by number."""
        blocks = [block for block in self.scope.elements if block.type_name == type_name]
        numbers = np.concatenate([block.numbers for block in blocks])
        nodes = np.concatenate([block.nodes for block in blocks])

        def missing(row: int, number: int) -> NoReturn:
            where = np.concatenate([block.lines for block in blocks])
            of = f" of '{shortened(self.scope.name)}'" if self.scope.name else ""
            self.lines.fail(int(where[row]), f"element {numbers[row]} has node {number}, which no *NODE block{of} has")

        found = places(self.node_numbers, nodes, missing)
        order = np.argsort(numbers, kind="stable")
        return _Rows(type_name, blocks[0].kind, numbers[order], self.start + found[order])

    @cached_property
    def skipped(self) -> IntArray:
        """Numbers of the elements that are left out, rising."""
        return np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *(each.numbers for each in self.scope.skipped)]))


def _distinct(numbers: Numbers) -> Numbers:
    """Each number once, rising. (`numpy.unique` hashes whole numbers, which takes ten times as long.)"""
    if isinstance(numbers, range):
        return numbers
    ordered = np.sort(numbers)
    return ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])] if len(ordered) else ordered


def _among(known: IntArray, numbers: Numbers) -> IntArray:
    """Where the numbers that are known stand in `known`; both rise."""
    if isinstance(numbers, range):
        first, last = np.searchsorted(known, [numbers.start, numbers.stop])
        inside = np.arange(first, last)
        return inside[(known[inside] - numbers.start) % numbers.step == 0]
    if not len(known):
        return np.zeros(0, dtype=np.int64)
    found = np.searchsorted(known, numbers).clip(max=len(known) - 1)
    return found[known[found] == numbers]


def flattened(lines: Lines, instances: Mapping[str, Placed], assembly: Placed, notes: list[str]) -> Contents:
    """One mesh of the instances, in their order, and the assembly's own nodes and elements.

    Raises
    ------
    InputError
        A node or an element twice in a scope, an element without its nodes.
    """
    every = {**instances, "": assembly}
    total = sum(len(block.numbers) for placed in every.values() for block in placed.scope.nodes)
    if total > _LARGEST:
        raise InputError(f"{lines.name}: all instances have {total} nodes together; {_LARGEST} can be read")
    numbered: dict[str, _Numbered] = {}
    start = 0
    for name, placed in every.items():
        numbered[name] = _Numbered(lines, placed, start)
        start += len(numbered[name].points)
    skipped = Counter[str]()
    unknown = Counter[str]()
    for placed in every.values():
        unknown.update(placed.scope.unknown)
        skipped.update({shortened(each.type_name): len(each.numbers) for each in placed.scope.skipped})
    groups = _Groups(lines, numbered, notes)
    node_groups = groups.of_nodes()
    groups.of_elements()
    edges = groups.of_surfaces(node_groups)
    blocks, count = [], 0
    for each in numbered.values():
        numbers = np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *(rows.numbers for rows in each.rows)]))
        for rows in each.rows:
            blocks.append(Block(rows.kind, count + np.searchsorted(numbers, rows.numbers), rows.nodes, rows.groups))
        count += len(numbers)
    left = [f"{number} elements of type {name} left out" for name, number in skipped.items() if name not in unknown]
    return Contents(
        np.concatenate([each.points for each in numbered.values()]),
        [*blocks, *edges],
        node_groups,
        solids=sum(placed.scope.solids for placed in every.values()),
        unread=dict(unknown),
        notes=(*left, *notes),
    )


class _Groups:
    """The groups that sets and surfaces become."""

    def __init__(self, lines: Lines, numbered: Mapping[str, _Numbered], notes: list[str]) -> None:
        self.lines, self.numbered, self.notes = lines, numbered, notes
        self.scopes = {name: each.scope for name, each in numbered.items() if name}
        self.taken: set[tuple[int, str]] = set()
        """Dimension and name of the groups there are."""

    def of_nodes(self) -> dict[str, IntArray]:
        """Node sets as rows of all nodes."""
        groups = {}
        for owner, name, found in self._named({name: each.scope.node_sets for name, each in self.numbered.items()}):
            rows, lost = self._nodes([(part or owner, numbers) for (part, _), numbers in found.pieces.items()])
            self._tell(lost, name)
            groups[self._free(0, name)] = rows
        return groups

    def _nodes(self, pieces: list[tuple[str, Numbers]]) -> tuple[IntArray, int]:
        """Rows of the nodes, and how many there are not."""
        rows, lost = [np.zeros(0, dtype=np.int64)], 0
        for part, numbers in pieces:
            each = self.numbered[part]
            found = _among(each.node_numbers, distinct := _distinct(numbers))
            lost += len(distinct) - len(found)
            rows.append(each.start + found)
        return np.asarray(_distinct(np.concatenate(rows))), lost

    def of_elements(self) -> None:
        """Element sets as groups of the rows."""
        sets = {name: each.scope.element_sets for name, each in self.numbered.items()}
        for owner, name, found in self._named(sets):
            chosen, skipped, lost = self._elements(
                [(part or owner, numbers) for (part, _), numbers in found.pieces.items()]
            )
            self._tell(lost, name)
            if not chosen:
                why = "it holds only elements that are left out" if skipped else "it has no element"
                self.notes.append(f"group '{shortened(name)}' left out, as {why}")
            names = {
                dimension: self._free(dimension, name) for dimension in {rows.kind.dimension for rows, _ in chosen}
            }
            for rows, inside in chosen:
                rows.groups[names[rows.kind.dimension]] = inside

    def _elements(self, pieces: list[tuple[str, Numbers]]) -> tuple[list[tuple[_Rows, IntArray]], int, int]:
        """Rows of the elements, how many are left out, and how many there are not."""
        collected: dict[int, tuple[_Rows, list[IntArray]]] = {}
        skipped = lost = 0
        for part, numbers in pieces:
            each = self.numbered[part]
            distinct = _distinct(numbers)
            out = len(_among(each.skipped, distinct))
            lost += len(distinct) - out
            skipped += out
            for rows in each.rows:
                inside = _among(rows.numbers, distinct)
                lost -= len(inside)
                if len(inside):
                    collected.setdefault(id(rows), (rows, []))[1].append(inside)
        return (
            [(rows, np.asarray(_distinct(np.concatenate(inside)))) for rows, inside in collected.values()],
            skipped,
            lost,
        )

    def of_surfaces(self, node_groups: dict[str, IntArray]) -> list[Block]:
        """Surfaces as groups of nodes, of the rows, and of edges, which are returned."""
        blocks: list[Block] = []
        surfaces = {name: each.scope.surfaces for name, each in self.numbered.items()}
        for owner, name, surface in self._named(surfaces):
            pieces = [
                (face, line, [(part or owner, numbers) for part, numbers in self._members(owner, surface, text, line)])
                for text, face, line in surface.members
                if text
            ]
            if surface.of_nodes:
                node_groups[self._free(0, name)] = np.unique(
                    np.concatenate([np.zeros(0, np.int64), *(self._nodes(each)[0] for *_, each in pieces)])
                )
                continue
            faces: dict[int, tuple[_Rows, list[IntArray]]] = {}
            edges: list[IntArray] = []
            unread: set[str] = set()
            for face, _, each in pieces:
                for rows, inside in self._elements(each)[0]:
                    plane = is_plane(rows.type_name)
                    side = (_PLANE_EDGES if plane else _SHELL_EDGES).get(face)
                    if rows.kind.dimension == 2 and side is not None and side < _sides(rows.kind):
                        edges.append(_edges(rows, inside, side))
                    elif rows.kind.dimension == 2 and face in _FACES and not plane:
                        faces.setdefault(id(rows), (rows, []))[1].append(inside)
                    else:
                        unread.add(shortened(face) or "without a face")
            if unread:
                self.notes.append(f"surface '{shortened(name)}': left out {', '.join(sorted(unread))}")
            if faces:
                free = self._free(2, name)
                for rows, lists in faces.values():
                    rows.groups[free] = np.unique(np.concatenate(lists))
            if edges:
                blocks += _edge_blocks(np.concatenate(edges), self._free(1, name))
            if not faces and not edges and not unread:
                self.notes.append(f"group '{shortened(name)}' left out, as it has no element")
        return blocks

    def _members(self, owner: str, surface: Surface, text: str, line: int) -> list[tuple[str, Numbers]]:
        kind = "NSET" if surface.of_nodes else "ELSET"
        return members(self.lines, line, text, "", self.numbered[owner].scope, {} if owner else self.scopes, kind)

    def _named(self, every: Mapping[str, Mapping[str, T]]) -> Iterator[tuple[str, str, T]]:
        """Scope, name and value of all sets or surfaces, the assembly's under their own names."""
        count = Counter(key for named in every.values() for key in named)
        for owner, named in every.items():
            for key, each in named.items():
                scope = self.numbered[owner].scope
                yield owner, each.name if not owner or count[key] == 1 else f"{scope.name}.{each.name}", each

    def _free(self, dimension: int, name: str) -> str:
        """A name that no other group of this dimension has."""
        free, number = name, 2
        while (dimension, free) in self.taken:
            free, number = f"{name}-{number}", number + 1
        self.taken.add((dimension, free))
        if free != name:
            self.notes.append(f"a second group '{shortened(name)}' is called '{shortened(free)}'")
        return free

    def _tell(self, lost: int, name: str) -> None:
        if lost:
            self.notes.append(f"{lost} members of group '{shortened(name)}' left out, which there are not")


def _sides(kind: Kind) -> int:
    return 3 if kind.row[2] == kind.row[3] else 4


def _edges(rows: _Rows, inside: IntArray, side: int) -> IntArray:
    """End, end and middle (n, 3) of a side of some elements."""
    own = SIDES[_TRIANGLE_SIDES[side] if _sides(rows.kind) == 3 else side]
    return rows.kind.rows(rows.nodes[inside])[:, own]


def _edge_blocks(edges: IntArray, name: str) -> Iterator[Block]:
    """Blocks of lines, each once, of first and second order."""
    _, first = np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_index=True)
    edges = edges[np.sort(first)]
    for kind, chosen in ((LINE2, edges[:, 2] == MISSING), (LINE3, edges[:, 2] != MISSING)):
        count = int(chosen.sum())
        if count:
            yield Block(kind, np.arange(count), edges[chosen][:, : kind.nodes], {name: np.arange(count)})
