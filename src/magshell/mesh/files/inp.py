"""Abaqus input files: nodes, shell elements, node and element sets.

meshio's reader is not used for them: it loses an element set that two blocks of elements share, the nodes of every
`*NODE` block but the last, sets written with `GENERATE` over several lines, and refuses element types in lower case.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.files.cells import LINE2, LINE3, QUAD4, QUAD8, QUAD9, TRIANGLE3, TRIANGLE6, Kind
from magshell.mesh.files.contents import Block, Contents, in_order, places
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_TYPES: tuple[tuple[str, Kind | None], ...] = (
    (r"(STRI65|(M3D|CPS|CPE|DS)6\w*)", TRIANGLE6),
    (r"((S|M3D|CPS|CPE|DS)8\w*)", QUAD8),
    (r"(S9R5|M3D9R?)", QUAD9),
    (r"(STRI3|(S|SFM3D|M3D|R3D|CPS|CPE|DS)3\w*)", TRIANGLE3),
    (r"((S|SFM3D|M3D|R3D|CPS|CPE|DS)4\w*)", QUAD4),
    (r"(T[23]D3\w*|B[23]2\w*)", LINE3),
    (r"(T[23]D2\w*|B[23][13]\w*|R[23]D2)", LINE2),
    (r"(S?C3D\d+\w*|CSS8|SC[68]R\w*)", None),
)
"""Kind by type of element; None: it has a volume."""
_LARGEST_SET = 10_000_000


@dataclass
class _Elements:
    """A block `*ELEMENT`."""

    kind: Kind
    rows: IntArray
    """Number and nodes."""
    lines: list[int]


@dataclass
class _Found:
    """What the blocks of a file hold."""

    nodes: list[tuple[int, list[float], int]] = field(default_factory=list)
    """Number, coordinates, line."""
    elements: list[_Elements] = field(default_factory=list)
    node_sets: dict[str, list[int | str]] = field(default_factory=lambda: defaultdict(list))
    element_sets: dict[str, list[int | str]] = field(default_factory=lambda: defaultdict(list))
    """Numbers, or names of other sets."""
    solids: int = 0
    parts: int = 0
    skipped: dict[str, int] = field(default_factory=dict)
    """Element types that are no surface, line or solid, and how many elements they have."""


def read_inp(content: bytes, name: str) -> Contents:
    """Read the mesh of an Abaqus input file.

    Sets become groups: of elements, of edges (where they hold lines), of nodes. Everything else is skipped.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        What is wrong, with file and line.
    """
    lines = Lines(name, content)
    found = _Found()
    number = 0
    while number < len(lines.every):
        if not lines.every[number].startswith(b"*") or lines.every[number].startswith(b"**"):
            number += 1
            continue
        number = _block(lines, number, found)
    if not found.nodes:
        raise InputError(f"{name}: has no *NODE block with nodes; it is not an Abaqus input file, or it has no mesh")
    return _contents(lines, found)


def _block(lines: Lines, start: int, found: _Found) -> int:
    """Read the block whose keyword stands in line `start`; return the line after it."""
    words = [word.strip() for word in lines.text(start)[1:].split(",")]
    body = start + 1
    while words[-1] == "" and len(words) > 1 and body < len(lines.every):  # a keyword line may be continued
        words = words[:-1] + [word.strip() for word in lines.text(body).split(",")]
        body += 1
    end = body
    while end < len(lines.every) and (not lines.every[end].startswith(b"*") or lines.every[end].startswith(b"**")):
        end += 1
    given = {key.strip().upper(): value.strip().strip('"') for key, _, value in (word.partition("=") for word in words)}
    rows = [line for line in range(body, end) if lines.every[line].strip() and lines.every[line][:2] != b"**"]
    match " ".join(words[0].upper().split()):
        case "NODE":
            _nodes(lines, rows, given, found)
        case "ELEMENT":
            _elements(lines, start, rows, given, found)
        case "NSET":
            found.node_sets[_set_name(lines, start, given, "NSET")] += _members(lines, rows, given)
        case "ELSET":
            found.element_sets[_set_name(lines, start, given, "ELSET")] += _members(lines, rows, given)
        case "PART":
            found.parts += 1
            if found.parts > 1:
                lines.fail(start, "a second *PART; a file may hold one part: export the parts one by one, or joined")
        case "INSTANCE" if rows:
            lines.fail(rows[0], "the instance is moved; move the part itself, or export it flat, without instances")
        case "INCLUDE":
            lines.fail(start, "*INCLUDE is not followed; put the included file in its place")
    return end


def _nodes(lines: Lines, rows: list[int], given: dict[str, str], found: _Found) -> None:
    for line in rows:
        parts = [part.strip() for part in lines.text(line).split(",") if part.strip()]
        try:
            number, position = int(parts[0]), [float(part) for part in parts[1:4]]
        except (ValueError, IndexError):
            number, position = 0, []
        if len(position) not in (2, 3) or not np.isfinite(position).all() or abs(number) > 2**53:
            lines.fail(line, f"expected a node number and three coordinates, found '{shortened(lines.text(line))}'")
        found.nodes.append((number, [*position, 0.0][:3], line))
        if "NSET" in given:
            found.node_sets[given["NSET"]].append(number)


def _elements(lines: Lines, start: int, rows: list[int], given: dict[str, str], found: _Found) -> None:
    type_name = given.get("TYPE", "").upper()
    known = [kind for pattern, kind in _TYPES if re.fullmatch(pattern, type_name)]
    flat: list[int] = []
    where: list[int] = []
    for line in rows:
        for part in lines.text(line).split(","):
            if part.strip():
                flat.append(_whole(lines, line, part, "element and node numbers"))
                where.append(line)
    if not known or known[0] is None:
        if known:
            found.solids += len(rows)
        elif rows:
            found.skipped[type_name or "without a type"] = len(rows)
        return
    kind = known[0]
    width = 1 + kind.nodes
    if len(flat) % width:
        lines.fail(
            start,
            f"the elements of type {type_name} need {width} numbers each (their own and {kind.nodes} nodes), "
            f"but {len(flat)} numbers follow",
        )
    array = np.array(flat, dtype=np.int64).reshape(-1, width)
    found.elements.append(_Elements(kind, array, where[::width]))
    if "ELSET" in given:
        found.element_sets[given["ELSET"]] += array[:, 0].tolist()


def _set_name(lines: Lines, start: int, given: dict[str, str], key: str) -> str:
    if not given.get(key):
        lines.fail(start, f"the set has no name: write *{key}, {key}=NAME")
    return given[key]


def _members(lines: Lines, rows: list[int], given: dict[str, str]) -> list[int | str]:
    """Numbers of a set, and names of sets in it."""
    members: list[int | str] = []
    for line in rows:
        parts = [part.strip() for part in lines.text(line).split(",") if part.strip()]
        if "GENERATE" not in given:
            members += [
                _whole(lines, line, part.rpartition(".")[2], "a number")
                if re.fullmatch(r"([\w-]+\.)?\d+", part)
                else part.strip('"')
                for part in parts
            ]
            continue
        values = [_whole(lines, line, part, "first, last and increment") for part in parts]
        if len(values) == 2:
            values.append(1)
        if len(values) != 3 or values[2] <= 0 or (values[1] - values[0]) / values[2] > _LARGEST_SET:
            lines.fail(line, f"expected first, last and increment, found '{shortened(lines.text(line))}'")
        members += range(values[0], values[1] + 1, values[2])
    return members


def _whole(lines: Lines, line: int, text: str, what: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = 2**62
    if abs(value) > 2**53:
        lines.fail(line, f"expected {what}, found '{shortened(text)}'")
    return value


def _contents(lines: Lines, found: _Found) -> Contents:
    def twice(row: int) -> NoReturn:
        lines.fail(found.nodes[row][2], f"node {found.nodes[row][0]} is given a second time")

    numbers, points = in_order(
        np.array([node[0] for node in found.nodes], dtype=np.int64), np.array([node[1] for node in found.nodes]), twice
    )
    members = {name: _flat(name, found.element_sets, lines.name, set()) for name in found.element_sets}
    blocks = []
    for block in found.elements:

        def missing(row: int, number: int, block: _Elements = block) -> NoReturn:
            lines.fail(block.lines[row], f"element {block.rows[row, 0]} has node {number}, which no *NODE block has")

        own = block.rows[:, 0]
        groups = {name: rows for name, inside in members.items() if (rows := np.flatnonzero(np.isin(own, inside))).size}
        blocks.append(Block(block.kind, own, places(numbers, block.rows[:, 1:], missing), groups))
    node_groups = {}
    for name in found.node_sets:
        inside = _flat(name, found.node_sets, lines.name, set())
        node_groups[name] = np.flatnonzero(np.isin(numbers, inside))
    notes = tuple(f"{count} elements of type {name} left out" for name, count in found.skipped.items())
    return Contents(points, blocks, node_groups, solids=found.solids, notes=notes)


def _flat(name: str, sets: dict[str, list[int | str]], file: str, above: set[str]) -> list[int]:
    """All numbers of a set and of the sets in it."""
    by_capitals = {other.upper(): other for other in sets}
    numbers: list[int] = []
    for member in sets[name]:
        if isinstance(member, int):
            numbers.append(member)
            continue
        other = by_capitals.get(member.upper())
        if other is None or other in above | {name}:
            fault = "which there is not" if other is None else "which holds it in turn"
            raise InputError(f"{file}: the set '{name}' holds the set '{shortened(member)}', {fault}")
        numbers += _flat(other, sets, file, above | {name})
    return numbers
