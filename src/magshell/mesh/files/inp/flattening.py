"""Instances and the assembly as one mesh, and their sets and surfaces as its groups."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TypeVar

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.edges import SIDES
from magshell.mesh.files.cells import LINE2, LINE3, MISSING, Kind
from magshell.mesh.files.contents import Block, Contents
from magshell.mesh.files.inp.blocks import members
from magshell.mesh.files.inp.keywords import folded
from magshell.mesh.files.inp.numbering import Numbered, Placed, Rows, among, distinct
from magshell.mesh.files.inp.scope import NamedSet, Numbers, Surface
from magshell.mesh.files.inp.types import is_plane
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_LARGEST = 20_000_000
"""Nodes of all instances together."""
_NAMED = 12
"""Types of elements that a message names."""
_FACES = {"", "SPOS", "SNEG", "POS", "NEG", "P", "N", "S1", "S2"}
"""Of shells and membranes: the whole element. S1 and S2 are CalculiX's names."""
_EDGES = {f"E{side + 1}": side for side in range(4)}
_SHELL_EDGES = _EDGES | {f"S{side + 3}": side for side in range(4)}
"""Of shells and membranes; those with S are CalculiX's names."""
_PLANE_EDGES = _EDGES | {f"S{side + 1}": side for side in range(4)}
_TRIANGLE_SIDES = (0, 1, 3)
"""Which of `SIDES` the sides of a triangle are."""


T = TypeVar("T", NamedSet, Surface)


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
    numbered: dict[str, Numbered] = {}
    start = 0
    for name, placed in every.items():
        numbered[name] = Numbered(lines, placed, start)
        start += len(numbered[name].points)
    skipped = Counter[str]()
    unknown = Counter[str]()
    for placed in every.values():
        unknown.update(placed.scope.unknown)
        for block in placed.scope.skipped:
            skipped[block.type_name] += len(block.numbers)
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
    left = [f"{number} elements of type {name} left out" for name, number in skipped.items()]
    return Contents(
        np.concatenate([each.points for each in numbered.values()]),
        [*blocks, *edges],
        node_groups,
        solids=sum(placed.scope.solids for placed in every.values()),
        unread=_listed(unknown),
        notes=(*left, *notes),
    )


def _listed(types: Counter[str]) -> dict[str, int]:
    """So many that a message can name them."""
    first = dict(list(types.items())[:_NAMED])
    rest = types.total() - sum(first.values())
    return first | ({"others": rest} if rest else {})


class _Groups:
    """The groups that sets and surfaces become."""

    def __init__(self, lines: Lines, numbered: Mapping[str, Numbered], notes: list[str]) -> None:
        self.lines, self.numbered, self.notes = lines, numbered, notes
        self.scopes = {name: each.scope for name, each in numbered.items() if name}
        self.taken: set[tuple[int, str]] = set()
        """Dimension and name of the groups there are."""

    def of_nodes(self) -> dict[str, IntArray]:
        """Node sets as rows of all nodes."""
        groups = {}
        for owner, name, found in self._named({name: each.scope.node_sets for name, each in self.numbered.items()}):
            rows, lost = self._nodes([(part or owner, numbers) for part, numbers in found.members()])
            self._tell(lost, name)
            groups[self._free(0, name)] = rows
        return groups

    def _nodes(self, pieces: list[tuple[str, Numbers]]) -> tuple[IntArray, int]:
        """Rows of the nodes, and how many there are not."""
        rows, lost = [np.zeros(0, dtype=np.int64)], 0
        for part, numbers in pieces:
            each = self.numbered[part]
            found = among(each.node_numbers, wanted := distinct(numbers))
            lost += len(wanted) - len(found)
            rows.append(each.start + found)
        return np.asarray(distinct(np.concatenate(rows))), lost

    def of_elements(self) -> None:
        """Element sets as groups of the rows."""
        sets = {name: each.scope.element_sets for name, each in self.numbered.items()}
        for owner, name, found in self._named(sets):
            chosen, skipped, lost = self._elements([(part or owner, numbers) for part, numbers in found.members()])
            self._tell(lost, name)
            if not chosen:
                why = "it holds only elements that are left out" if skipped else "it has no element"
                self.notes.append(f"group '{shortened(name)}' left out, as {why}")
            names = {
                dimension: self._free(dimension, name) for dimension in {rows.kind.dimension for rows, _ in chosen}
            }
            for rows, inside in chosen:
                rows.groups[names[rows.kind.dimension]] = inside

    def _elements(self, pieces: list[tuple[str, Numbers]]) -> tuple[list[tuple[Rows, IntArray]], int, int]:
        """Rows of the elements, how many are left out, and how many there are not."""
        collected: dict[int, tuple[Rows, list[IntArray]]] = {}
        skipped = lost = 0
        for part, numbers in pieces:
            each = self.numbered[part]
            wanted = distinct(numbers)
            out = len(among(each.skipped, wanted))
            lost += len(wanted) - out
            skipped += out
            for rows in each.rows:
                inside = among(rows.numbers, wanted)
                lost -= len(inside)
                if len(inside):
                    collected.setdefault(id(rows), (rows, []))[1].append(inside)
        return (
            [(rows, np.asarray(distinct(np.concatenate(inside)))) for rows, inside in collected.values()],
            skipped,
            lost,
        )

    def of_surfaces(self, node_groups: dict[str, IntArray]) -> list[Block]:
        """Surfaces as groups of nodes, of the rows, and of edges, which are returned."""
        blocks: list[Block] = []
        for owner, name, surface in self._named({owner: each.scope.surfaces for owner, each in self.numbered.items()}):
            pieces = [
                (face, [(part or owner, numbers) for part, numbers in self._members(owner, surface, text, line)])
                for text, face, line in surface.members
                if text
            ]
            if surface.of_nodes:
                rows = [np.zeros(0, dtype=np.int64), *(self._nodes(each)[0] for _, each in pieces)]
                node_groups[self._free(0, name)] = np.unique(np.concatenate(rows))
            else:
                blocks += self._surface(name, pieces)
        return blocks

    def _surface(self, name: str, pieces: list[tuple[str, list[tuple[str, Numbers]]]]) -> Iterator[Block]:
        """The group of the elements whose faces a surface has; the edges it has."""
        faces: dict[int, tuple[Rows, list[IntArray]]] = {}
        edges: list[IntArray] = []
        unread: set[str] = set()
        for face, inside_ in pieces:
            for rows, inside in self._elements(inside_)[0]:
                plane = is_plane(rows.type_name)
                side = (_PLANE_EDGES if plane else _SHELL_EDGES).get(face)
                if rows.kind.dimension == 2 and side is not None and side < _sides(rows.kind):
                    edges.append(_edges(rows, inside, side))
                elif rows.kind.dimension == 2 and face in _FACES and not plane:
                    faces.setdefault(id(rows), (rows, []))[1].append(inside)
                else:
                    unread.add(f"{rows.kind.name} with {_quoted_face(face)}")
        if unread:
            self.notes.append(f"surface '{shortened(name)}': left out {', '.join(sorted(unread))}")
        elif not faces and not edges:
            self.notes.append(f"group '{shortened(name)}' left out, as it has no element")
        free = self._free(2, name) if faces else ""
        for rows, lists in faces.values():
            rows.groups[free] = np.unique(np.concatenate(lists))
        if edges:
            yield from _edge_blocks(np.concatenate(edges), self._free(1, name))

    def _members(self, owner: str, surface: Surface, text: str, line: int) -> list[tuple[str, Numbers]]:
        kind = "NSET" if surface.of_nodes else "ELSET"
        return members(self.lines, line, text, "", self.numbered[owner].scope, {} if owner else self.scopes, kind)

    def _named(self, every: Mapping[str, Mapping[str, T]]) -> Iterator[tuple[str, str, T]]:
        """Scope, name and value of all sets or surfaces, the assembly's under their own names."""
        count = Counter(folded(each.name) for named in every.values() for each in named.values())
        for owner, named in every.items():
            for each in named.values():
                alone = not owner or count[folded(each.name)] == 1
                yield owner, each.name if alone else f"{self.numbered[owner].scope.name}.{each.name}", each

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


def _quoted_face(face: str) -> str:
    return f"face '{shortened(face)}'" if face else "no face"


def _sides(kind: Kind) -> int:
    return 3 if kind.row[2] == kind.row[3] else 4


def _edges(rows: Rows, inside: IntArray, side: int) -> IntArray:
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
