"""gmsh's `.msh` files in text, formats 4.1 and 2.2, read without gmsh."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import NamedTuple, NoReturn

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.files.cells import GMSH, GMSH_SOLIDS, GMSH_SURFACES
from magshell.mesh.files.contents import GROUPED, Block, Contents, in_order, places
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

UNIT = re.compile(r"magshell: lengths in (\S+)")
"""What files of `magshell.mesh.write` say in their comments."""
_HEAD = 4096
_SECTIONS = ("PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "Elements", "Comments")


class PlainReaderError(InputError):
    """Not a fault of the file: a format that only gmsh itself reads."""


class _Section(NamedTuple):
    first: int
    """Its first line after its name."""
    end: int
    """The line that ends it."""


Names = dict[tuple[int, int], str]
"""Name by dimension and physical tag."""


def read_msh(content: bytes, name: str) -> Contents:
    """Read a file of format 4.1 or 2.2 in text.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    PlainReaderError
        Binary, another version, or a mesh in partitions: gmsh itself can read it.
    InputError
        Anything else that is wrong; the message names file and line.
    """
    version = _version(content, name)
    lines = Lines(name, content)
    sections = _sections(lines)
    if "PartitionedEntities" in sections:
        raise PlainReaderError(f"{name}: the mesh is cut into partitions; save it whole (Mesh.PartitionSplitMeshFiles)")
    for needed in ("Nodes", "Elements"):
        if needed not in sections:
            raise InputError(f"{name}: has no section ${needed}; it is not a mesh, or it is cut short")
    names = _names(lines, sections.get("PhysicalNames"))
    read = _read_4 if version == "4.1" else _read_2
    numbers, points, blocks, solids, unread = read(lines, sections, names)
    if not len(numbers):
        raise InputError(f"{name}: the section $Nodes is empty")
    unit = _unit(lines, sections.get("Comments"))
    return Contents(points, blocks, solids=solids, unread=unread, unit=unit, order=tuple(names.values()))


def _version(content: bytes, name: str) -> str:
    """The format, if it is one that this reader reads."""
    if not content.strip():
        raise InputError(f"{name}: the file is empty")
    head = content[:_HEAD].splitlines()
    start = next((number for number, line in enumerate(head) if line.strip() == b"$MeshFormat"), None)
    if start is None or start + 1 >= len(head):
        raise InputError(
            f"{name}, line 1: not a .msh file of gmsh, which begins with $MeshFormat (found "
            f"'{shortened(head[0].decode('utf-8', 'replace'))}')"
        )
    fields = head[start + 1].decode("utf-8", "replace").split()
    if len(fields) != 3:
        raise InputError(
            f"{name}, line {start + 2}: expected version, file type and data size, such as 4.1 0 8, "
            f"found '{shortened(' '.join(fields))}'"
        )
    if fields[1] != "0":
        raise PlainReaderError(f"{name}: is a binary file; save it as text (gmsh: Mesh.Binary = 0)")
    if fields[0] not in ("4.1", "2.2"):
        raise PlainReaderError(
            f"{name}: has the format {shortened(fields[0])}; save it in format 4.1 or 2.2 (gmsh: Mesh.MshFileVersion)"
        )
    return fields[0]


def _sections(lines: Lines) -> dict[str, _Section]:
    """The sections that matter, by name."""
    found: dict[str, _Section] = {}
    opened: tuple[str, int] | None = None
    for number in [number for number, line in enumerate(lines.every) if line[:1] == b"$"]:
        mark = lines.text(number)[1:]
        if opened is None:
            if mark.startswith("End"):
                lines.fail(number, f"${shortened(mark)} ends a section that was not begun")
            opened = (mark, number)
        elif mark == f"End{opened[0]}":
            if opened[0] in found:
                lines.fail(opened[1], f"a second section ${opened[0]}; there must be one")
            if opened[0] in _SECTIONS:
                found[opened[0]] = _Section(opened[1] + 1, number)
            opened = None
        elif opened[0] != "Comments":
            lines.fail(number, f"found ${shortened(mark)} where $End{shortened(opened[0])} is expected")
    if opened is not None:
        lines.fail(
            len(lines.every) - 1,
            f"the file ends inside the section ${shortened(opened[0])}, begun in line {opened[1] + 1}: it is cut short",
        )
    return found


def _names(lines: Lines, section: _Section | None) -> Names:
    names: Names = {}
    if section is None:
        return names
    count = _count(lines, section, "the number of physical names")
    for line in range(section.first + 1, section.first + 1 + count):
        match = re.fullmatch(r'(\d+)\s+(\d+)\s+"(.*)"', lines.text(line)) if line < section.end else None
        if match is None:
            lines.fail(min(line, section.end), 'expected a dimension, a number and a name, such as 2 1 "arm"')
        names[int(match[1]), int(match[2])] = match[3]
    return names


def _unit(lines: Lines, section: _Section | None) -> str | None:
    for line in range(section.first, section.end) if section else ():
        match = UNIT.fullmatch(lines.text(line))
        if match:
            return match[1]
    return None


def _count(lines: Lines, section: _Section, what: str) -> int:
    """The number that begins a section."""
    values = lines.numbers(section.first, what) if section.first < section.end else []
    if len(values) != 1 or values[0] < 0:
        lines.fail(min(section.first, section.end), f"expected {what}")
    return int(values[0])


def group_name(dimension: int, tag: int, names: Names) -> str:
    """Name of a physical group; one without a name is called by its dimension and number."""
    return names.get((dimension, tag)) or f"{GROUPED[dimension]}-{tag}"


_Read = tuple[IntArray, FloatArray, list[Block], int, dict[str, int]]
"""Numbers of nodes, their positions, elements; how many have a volume; how many of what type cannot be used."""


def _read_4(lines: Lines, sections: dict[str, _Section], names: Names) -> _Read:
    tagged = _physical_tags(lines, sections.get("Entities"))
    numbers, points = _nodes_4(lines, sections["Nodes"])
    blocks, solids = [], 0
    unread: dict[str, int] = {}
    for dimension, tag, kind_number, first, count in _element_blocks(lines, sections["Elements"]):
        if dimension == 3:
            solids += count
            continue
        kind = GMSH.get(kind_number)
        if kind is None and dimension == 2:
            unread[str(kind_number)] = unread.get(str(kind_number), 0) + count
            continue
        if kind is None or kind.dimension != dimension:
            _unknown_kind(lines, first - 1, kind_number)
        what = f"an element's number and its {kind.nodes} nodes"
        where = range(first, first + count)
        rows = lines.rows(where, 1 + kind.nodes, int, what)
        nodes = places(numbers, rows[:, 1:], _no_such_node(lines, where))
        everything = np.arange(count)
        groups = {group_name(dimension, tag, names): everything for tag in tagged.get((dimension, tag), ())}
        blocks.append(Block(kind, rows[:, 0], nodes, groups))
    return numbers, points, blocks, solids, unread


def _physical_tags(lines: Lines, section: _Section | None) -> dict[tuple[int, int], list[int]]:
    """Physical tags of every entity, by dimension and tag; the sign, which is a sense, is dropped."""
    tags: dict[tuple[int, int], list[int]] = {}
    if section is None:
        return tags
    counts = lines.numbers(section.first, "the numbers of points, curves, surfaces and volumes")
    line = section.first + 1
    if len(counts) != 4 or min(counts) < 0 or line + sum(counts) > section.end:
        lines.fail(section.first, "expected the numbers of points, curves, surfaces and volumes that follow")
    for dimension, count in enumerate(counts):
        before = 4 if dimension == 0 else 7
        for _ in range(count):
            values = lines.numbers(line, "an entity: its tag, where it lies and its physical tags", float)
            have = int(values[before]) if len(values) > before and 0 <= values[before] < len(values) else -1
            if have < 0 or len(values) < before + 1 + have or not np.isfinite(values[: before + 1 + have]).all():
                lines.fail(line, "expected an entity: its tag, where it lies, how many physical tags it has, and they")
            tags[dimension, int(values[0])] = [abs(int(value)) for value in values[before + 1 : before + 1 + have]]
            line += 1
    return tags


def _header(lines: Lines, line: int, section: _Section, what: str) -> list[int]:
    """Four whole numbers, none of which may be absurd."""
    values = lines.numbers(line, what) if line < section.end else []
    if len(values) != 4 or values[3] < 0:
        lines.fail(min(line, section.end), f"expected {what}")
    return values


def _nodes_4(lines: Lines, section: _Section) -> tuple[IntArray, FloatArray]:
    what = "the numbers of blocks and nodes and the least and greatest node number"
    blocks, total, *_ = _header(lines, section.first, section, what)
    numbers, points, origin = [np.zeros(0, np.int64)], [np.zeros((0, 3))], [np.zeros(0, np.int64)]
    line = section.first + 1
    for _ in range(blocks):
        dimension, _, parametric, count = _header(
            lines, line, section, "dimension, entity, whether there are parameters, and number of nodes of a block"
        )
        if line + 1 + 2 * count > section.end:
            lines.fail(line, f"a block of {count} nodes, but the section $Nodes ends in line {section.end + 1}")
        where = range(line + 1, line + 1 + count)
        numbers.append(lines.rows(where, 1, int, "a node number")[:, 0])
        origin.append(np.array(where, dtype=np.int64))
        width = 3 + (min(max(dimension, 0), 3) if parametric else 0)
        where = range(line + 1 + count, line + 1 + 2 * count)
        points.append(lines.rows(where, width, float, "coordinates of a node")[:, :3])
        line += 1 + 2 * count
    return _sorted(lines, section, line, total, numbers, points, origin)


def _sorted(
    lines: Lines,
    section: _Section,
    line: int,
    total: int,
    numbers: list[IntArray],
    points: list[FloatArray],
    origin: list[IntArray],
) -> tuple[IntArray, FloatArray]:
    every = np.concatenate(numbers)
    if len(every) != total:
        lines.fail(section.first, f"says {total} nodes, but {len(every)} follow")
    if line < section.end:
        lines.fail(line, f"found '{shortened(lines.text(line))}' where $EndNodes is expected")
    where = np.concatenate(origin)
    return in_order(
        every, np.concatenate(points), lambda row: lines.fail(where[row], f"node {every[row]} is given a second time")
    )


def _element_blocks(lines: Lines, section: _Section) -> list[tuple[int, int, int, int, int]]:
    """Dimension, entity, type, first line and number of elements of each block of format 4.1."""
    what = "the numbers of blocks and elements and the least and greatest element number"
    count, total, *_ = _header(lines, section.first, section, what)
    blocks: list[tuple[int, int, int, int, int]] = []
    line = section.first + 1
    for _ in range(count):
        what = "dimension, entity, element type and number of elements of a block"
        dimension, tag, kind, elements = _header(lines, line, section, what)
        if line + 1 + elements > section.end:
            lines.fail(
                line, f"a block of {elements} elements, but the section $Elements ends in line {section.end + 1}"
            )
        blocks.append((dimension, tag, kind, line + 1, elements))
        line += 1 + elements
    found = sum(block[4] for block in blocks)
    if found != total:
        lines.fail(section.first, f"says {total} elements, but {found} follow")
    if line < section.end:
        lines.fail(line, f"found '{shortened(lines.text(line))}' where $EndElements is expected")
    return blocks


def _read_2(lines: Lines, sections: dict[str, _Section], names: Names) -> _Read:
    section = sections["Nodes"]
    count = _count(lines, section, "the number of nodes")
    _exact(lines, section, count, "nodes")
    where = range(section.first + 1, section.end)
    rows = lines.rows(where, 4, float, "a node number and three coordinates")
    origin = np.array(where, dtype=np.int64)
    whole = np.flatnonzero((rows[:, 0] != np.round(rows[:, 0])) | (np.abs(rows[:, 0]) > 2.0**53))
    if whole.size:
        lines.fail(int(origin[whole[0]]), "expected a node number and three coordinates; the number is not whole")
    numbers, points = _sorted(
        lines,
        section,
        section.end,
        count,
        [rows[:, 0].astype(np.int64)],
        [rows[:, 1:]],
        [origin],
    )
    return numbers, points, *_elements_2(lines, sections["Elements"], numbers, names)


def _elements_2(
    lines: Lines, section: _Section, numbers: IntArray, names: Names
) -> tuple[list[Block], int, dict[str, int]]:
    count = _count(lines, section, "the number of elements")
    _exact(lines, section, count, "elements")
    alike: dict[tuple[int, int], list[int]] = defaultdict(list)
    for line in range(section.first + 1, section.end):
        head = lines.every[line].split(None, 3)[1:3]
        try:
            alike[int(head[0]), int(head[1])].append(line)
        except (ValueError, IndexError):
            lines.fail(line, f"expected an element: number, type, tags, nodes; found '{shortened(lines.text(line))}'")
    blocks, solids = [], 0
    unread: dict[str, int] = {}
    for (kind_number, tags), where in alike.items():
        if kind_number in GMSH_SOLIDS:
            solids += len(where)
            continue
        if kind_number in GMSH_SURFACES:
            unread[str(kind_number)] = unread.get(str(kind_number), 0) + len(where)
            continue
        if kind_number not in GMSH or not 0 <= tags <= 100:
            _unknown_kind(lines, where[0], kind_number)
        kind = GMSH[kind_number]
        what = f"an element: number, type, number of tags, {tags} tags, {kind.nodes} nodes"
        rows = lines.rows(where, 3 + tags + kind.nodes, int, what)
        nodes = places(numbers, rows[:, 3 + tags :], _no_such_node(lines, where))
        physical = np.abs(rows[:, 3]) if tags else np.zeros(len(rows), np.int64)
        groups = {
            group_name(kind.dimension, int(tag), names): np.flatnonzero(physical == tag)
            for tag in np.unique(physical)
            if tag
        }
        blocks.append(Block(kind, rows[:, 0], nodes, groups))
    return blocks, solids, unread


def _exact(lines: Lines, section: _Section, count: int, what: str) -> None:
    found = section.end - section.first - 1
    if found != count:
        lines.fail(section.first, f"says {count} {what}, but {found} lines follow")


def _unknown_kind(lines: Lines, line: int, kind: int) -> NoReturn:
    lines.fail(
        line,
        f"element type {kind} cannot be used; there may be points, lines, triangles and quadrilaterals of first or "
        "second order (gmsh: Mesh.ElementOrder = 2)",
    )


def _no_such_node(lines: Lines, where: Sequence[int]) -> Callable[[int, int], NoReturn]:
    def fail(row: int, number: int) -> NoReturn:
        lines.fail(where[row], f"the element has node {number}, which the section $Nodes does not have")

    return fail
