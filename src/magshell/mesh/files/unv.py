"""I-DEAS universal files (`.unv`), as Salome, gmsh and others write them: nodes, elements, groups with their names.

gmsh's reader is not used for them: it crashes on groups of points that gmsh itself writes, cuts names at blanks, loses
groups of nodes, and takes coordinates in any system for Cartesian ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from magshell.arrays import IntArray
from magshell.mesh.files.cells import LINE2, LINE3, QUAD4, QUAD8, TRIANGLE3, TRIANGLE6, Kind
from magshell.mesh.files.contents import Block, Contents, in_order, places
from magshell.mesh.files.lines import Lines
from magshell.units import LENGTH, shortened

_MARK = b"    -1"
_NODES = ("2411", "781", "15")
_ENTITY_WIDTH = {"2429": 2, "2430": 2, "2432": 2, "2435": 4, "2452": 4, "2467": 4, "2477": 4}
"""Numbers per member of a group, by dataset."""
_OLD = {"71": "elements", "780": "elements", "18": "coordinate systems", "2417": "groups"}
"""Datasets that hold what matters, in a form that is not read."""
_NODE, _ELEMENT = 7, 8
"""Kinds of members of groups."""
_WITH_SECTION = {11, 21, 22, 23, 24, 31, 32}
"""Elements with a line more, of cross-sections."""
_KINDS: tuple[tuple[set[int], Kind, tuple[int, ...]], ...] = (
    ({11, 21, 22, 31}, LINE2, (0, 1)),
    ({23, 24, 32}, LINE3, (0, 2, 1)),
    ({41, 51, 61, 74, 81, 91}, TRIANGLE3, (0, 1, 2)),
    ({42, 52, 62, 72, 82, 92}, TRIANGLE6, (0, 2, 4, 1, 3, 5)),
    ({44, 54, 64, 71, 84, 94}, QUAD4, (0, 1, 2, 3)),
    ({45, 55, 65, 75, 85, 95}, QUAD8, (0, 2, 4, 6, 1, 3, 5, 7)),
)
"""By the numbers of types: the kind, and where its nodes stand in the file, which goes round and round."""


@dataclass
class _Found:
    """What the datasets of a file hold."""

    nodes: list[tuple[int, int, list[float], int]] = field(default_factory=list)
    """Number, coordinate system, coordinates, line."""
    elements: dict[int, list[tuple[list[int], int]]] = field(default_factory=dict)
    """By type: number and nodes, line."""
    groups: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    """Kind and number of each member."""
    systems: dict[int, str] = field(default_factory=dict)
    """Coordinate systems that are not the file's Cartesian one: what they are."""
    unit: str | None = None


def read_unv(content: bytes, name: str) -> Contents:
    """Read the mesh of a universal file: datasets 164, 2411, 2412, 2420 and those of groups; others are skipped.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        What is wrong, with file and line; nodes in other than Cartesian coordinates; units that are not metric.
    """
    lines, found = Lines(name, content), _Found()
    marks = [number for number, line in enumerate(lines.every) if line.rstrip() == _MARK]
    if len(marks) < 2:
        lines.fail(0, "not a universal file, which has datasets between lines with -1 in columns 5 and 6")
    if len(marks) % 2:
        lines.fail(marks[-1], "a dataset is begun here and not ended: the file is cut short")
    for first, last in zip(marks[::2], marks[1::2], strict=True):
        if first + 1 == last:
            lines.fail(last, "expected the number of a dataset")
        _dataset(lines, first + 1, last, found)
    if not found.nodes:
        lines.fail(0, "has no nodes: the dataset 2411 is missing or empty")
    return _contents(lines, found)


def _dataset(lines: Lines, start: int, end: int, found: _Found) -> None:
    """Read the dataset whose number stands in line `start`."""
    number = lines.text(start)
    if number in _NODES:
        _nodes(lines, start + 1, end, found, alone=number == "15")
    elif number == "2412":
        _elements(lines, start + 1, end, found)
    elif number in _ENTITY_WIDTH:
        _groups(lines, start + 1, end, _ENTITY_WIDTH[number], found)
    elif number == "2420":
        _systems(lines, start + 1, end, found)
    elif number == "164":
        found.unit = _unit(lines, start + 1, end)
    elif number in _OLD:
        lines.fail(
            start, f"the dataset {number} ({_OLD[number]}) is of an old kind; save with dataset 2411, 2412, 2467"
        )


def _reals(lines: Lines, line: int, end: int, count: int, what: str) -> list[float]:
    parts = lines.text(line).upper().replace("D", "E").split() if line < end else []
    try:
        values = [float(part) for part in parts]
    except ValueError:
        values = []
    if len(values) < count or not np.isfinite(values[:count]).all():
        lines.fail(min(line, end), f"expected {what}, found '{shortened(lines.text(min(line, end)))}'")
    return values[:count]


def _whole(lines: Lines, line: int, end: int, least: int, what: str) -> list[int]:
    values = lines.numbers(line, what) if line < end else []
    if len(values) < least or any(abs(value) > 2**53 for value in values):
        lines.fail(min(line, end), f"expected {what}, found '{shortened(lines.text(min(line, end)))}'")
    return values


def _nodes(lines: Lines, line: int, end: int, found: _Found, alone: bool) -> None:
    while line < end:
        if alone:
            values = _reals(lines, line, end, 7, "a node: number, coordinate systems, colour and coordinates")
            number, system, position = int(values[0]), int(values[1]), values[4:]
        else:
            number, system, *_ = _whole(lines, line, end, 4, "a node: number, two coordinate systems, colour")
            position = _reals(lines, line + 1, end, 3, "three coordinates")
        found.nodes.append((number, system, position, line))
        line += 1 if alone else 2


def _elements(lines: Lines, line: int, end: int, found: _Found) -> None:
    while line < end:
        head = _whole(lines, line, end, 6, "an element: number, type, two properties, colour, number of nodes")
        number, kind, width, start = head[0], head[1], head[5], line
        line += 2 if kind in _WITH_SECTION else 1
        nodes: list[int] = []
        while len(nodes) < width:
            nodes += _whole(lines, line, end, 1, f"{width} nodes of the element {number}")
            line += 1
        if len(nodes) != width:
            lines.fail(start, f"element {number} has {len(nodes)} nodes, and says {width}")
        found.elements.setdefault(kind, []).append(([number, *nodes], start))


def _groups(lines: Lines, line: int, end: int, width: int, found: _Found) -> None:
    while line < end:
        count = _whole(lines, line, end, 8, "a group: eight numbers, the last how many members it has")[7]
        if line + 1 >= end:
            lines.fail(end, "expected the name of a group")
        name = lines.text(line + 1) or f"group-{len(found.groups) + 1}"
        line += 2
        flat: list[int] = []
        while len(flat) < width * count:
            flat += _whole(lines, line, end, width, f"members of the group '{shortened(name)}'")
            line += 1
        if count < 0 or len(flat) != width * count:
            lines.fail(line - 1, f"the group '{shortened(name)}' does not have the {count} members that it says")
        found.groups.setdefault(name, []).extend(zip(flat[::width], flat[1::width], strict=True))


def _systems(lines: Lines, line: int, end: int, found: _Found) -> None:
    line += 2  # number and name of the part
    while line < end:
        label, kind, *_ = _whole(lines, line, end, 2, "a coordinate system: number, type, colour")
        rows = [_reals(lines, line + 2 + row, end, 3, "a row of a coordinate system's matrix") for row in range(4)]
        if kind:
            found.systems[label] = {1: "cylindrical", 2: "spherical"}.get(kind, f"of type {kind}")
        elif not np.array_equal(rows, np.eye(4, 3)):
            found.systems[label] = "turned or moved"
        else:
            found.systems.setdefault(label, "")
        line += 6


def _unit(lines: Lines, line: int, end: int) -> str:
    """By the factor from metres to the file's lengths."""
    factor = _reals(lines, line + 1, end, 1, "the factor of lengths")[0]
    known = [unit for unit, metres in LENGTH.units.items() if abs(factor * float(metres) - 1.0) < 1e-9]
    if not known:
        lines.fail(
            line,
            f"lengths are in units of which {factor:g} make a metre (dataset 164), which is none of {LENGTH.allowed}; "
            "save the file in one of them",
        )
    return known[0]


def _contents(lines: Lines, found: _Found) -> Contents:
    def twice(row: int) -> NoReturn:
        lines.fail(found.nodes[row][3], f"node {found.nodes[row][0]} is given a second time")

    for number, system, _, line in found.nodes:
        strange = found.systems.get(system, "" if system in (0, 1) else "not there")
        if strange:
            lines.fail(
                line,
                f"node {number} is given in the coordinate system {system}, which is {strange}; save the nodes in the "
                "global Cartesian one",
            )
    numbers, points = in_order(
        np.array([node[0] for node in found.nodes], dtype=np.int64), np.array([node[2] for node in found.nodes]), twice
    )
    blocks: list[Block] = []
    notes: list[str] = []
    unread: dict[str, int] = {}
    solids = 0
    names = {name: members for name, members in found.groups.items() if members}
    for number, elements in found.elements.items():
        known = next(((kind, columns) for types, kind, columns in _KINDS if number in types), None)
        if known is None:
            solids += len(elements) if 101 <= number <= 119 else 0
            if 41 <= number <= 99:
                unread[str(number)] = len(elements)
            elif not 101 <= number <= 119:
                notes.append(f"{len(elements)} elements of type {number} left out")
            continue
        kind, columns = known
        for row, line in elements:
            if len(row) != 1 + kind.nodes:
                lines.fail(line, f"element {row[0]} of type {number} has {len(row) - 1} nodes, not {kind.nodes}")
        blocks.append(_block(lines, kind, columns, elements, names, numbers))
    lost = _lost(names, numbers, blocks)
    if lost:
        notes.append(f"{lost} members of groups left out, which are not in the file")
    node_groups = _node_groups(names, numbers, blocks)
    order = tuple(names)
    return Contents(points, blocks, node_groups, solids, unread, found.unit, tuple(notes), order)


def _block(
    lines: Lines,
    kind: Kind,
    columns: tuple[int, ...],
    elements: list[tuple[list[int], int]],
    names: dict[str, list[tuple[int, int]]],
    numbers: IntArray,
) -> Block:
    rows = np.array([row for row, _ in elements], dtype=np.int64)

    def missing(row: int, number: int) -> NoReturn:
        lines.fail(elements[row][1], f"element {rows[row, 0]} has node {number}, which is not there")

    nodes = places(numbers, rows[:, 1:], missing)[:, list(columns)]
    groups = {
        name: inside
        for name, members in names.items()
        if (inside := np.flatnonzero(np.isin(rows[:, 0], _of_kind(members, _ELEMENT)))).size
    }
    return Block(kind, rows[:, 0], nodes, groups)


def _of_kind(members: list[tuple[int, int]], kind: int) -> IntArray:
    return np.array([number for what, number in members if what == kind], dtype=np.int64)


def _node_groups(
    names: dict[str, list[tuple[int, int]]], numbers: IntArray, blocks: list[Block]
) -> dict[str, IntArray]:
    """Groups of nodes; the nodes that some programs write beside the elements of a group are no group of their own."""
    groups = {}
    for name, members in names.items():
        inside = np.flatnonzero(np.isin(numbers, _of_kind(members, _NODE)))
        covered = [block.nodes[block.groups[name]].ravel() for block in blocks if name in block.groups]
        if inside.size and not (covered and np.isin(inside, np.concatenate(covered)).all()):
            groups[name] = inside
    return groups


def _lost(names: dict[str, list[tuple[int, int]]], numbers: IntArray, blocks: list[Block]) -> int:
    """How many members of groups are elements or nodes that the file does not have."""
    elements = np.concatenate([np.zeros(0, np.int64), *(block.numbers for block in blocks)])
    every = [pair for members in names.values() for pair in members]
    return int(
        (~np.isin(_of_kind(every, _NODE), numbers)).sum() + (~np.isin(_of_kind(every, _ELEMENT), elements)).sum()
    )
