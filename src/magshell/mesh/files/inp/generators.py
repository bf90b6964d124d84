"""Keywords that make nodes and elements of others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.files.inp.blocks import new_set, positions
from magshell.mesh.files.inp.frames import arc, move, parabola, straight
from magshell.mesh.files.inp.keywords import Keyword, lookup, parameters, real, reals, shown, split, whole
from magshell.mesh.files.inp.scope import Elements, NamedSet, Nodes, Scope, flat
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_LARGEST = 5_000_000
"""More generated nodes or elements than this in a part are a slip."""


def generate_nodes(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*NGEN`: nodes between two, on a straight line, a circular arc or a parabola."""
    given = parameters(lines, keyword, ("LINE", "NSET", "SYSTEM"))
    curve = given.get("LINE", "").upper()
    if curve not in ("", "C", "P"):
        lines.fail(keyword.line, f"LINE={shortened(curve)} is not read; C (arc) and P (parabola) are")
    for line in keyword.rows:
        fields = split(lines.text(line))
        first, last, step = _wholes(lines, line, fields[:3], "two nodes and an increment", (None, None, 1))
        step = abs(step) if last >= first else -abs(step)
        if step == 0 or (last - first) % step or abs((last - first) // step) > _LARGEST:
            lines.fail(line, f"from node {first} to node {last} it is not a whole number of increments {abs(step)}")
        numbers = np.arange(first, last + step, step)
        shares = np.linspace(0.0, 1.0, len(numbers))[1:-1]
        start, end = (_position(lines, line, scope, node) for node in (first, last))
        if not curve:
            points: FloatArray | None = straight(start, end, shares)
        else:
            third = _third(lines, line, fields, given, scope)
            points = (arc if curve == "C" else parabola)(start, end, third, shares)
            if any(fields[7:]):
                lines.fail(line, "an arc given by its normal (180° or more) is not read; make it of two arcs")
        if points is None:
            lines.fail(line, "there is no arc of less than 180° about this centre from the first to the second node")
        _add_nodes(lines, line, scope, numbers[1:-1], points)
        if "NSET" in given:
            new_set(lines, keyword, given["NSET"], scope.node_sets).add(numbers)


def _third(lines: Lines, line: int, fields: list[str], given: dict[str, str], scope: Scope) -> FloatArray:
    """The extra point of an arc or a parabola: a node, or coordinates."""
    if len(fields) > 3 and fields[3]:
        return _position(lines, line, scope, whole(lines, line, fields[3], "the number of the third node"))
    what = "two nodes, an increment, a third node or the coordinates of a point"
    if not any(fields[4:7]):
        lines.fail(line, f"expected {what}, found '{shortened(lines.text(line))}'")
    coordinates = [real(lines, line, field, what) for field in [*fields[4:7], "", ""][:3]]
    point: FloatArray = positions(lines, line, given, np.array([coordinates]), scope)[0]
    return point


def fill_nodes(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*NFILL`: nodes on straight lines between the nodes of two sets, at equal distances."""
    given = parameters(lines, keyword, ("NSET",))
    for line in keyword.rows:
        fields = split(lines.text(line))
        if len(fields) < 3:
            lines.fail(line, f"expected two sets and a number of intervals, found '{shortened(lines.text(line))}'")
        bounds = [_set(lines, line, scope.node_sets, label) for label in fields[:2]]
        count, step = _wholes(lines, line, fields[2:4], "a number of intervals and an increment", (None, 1))
        starts, ends = (flat(each) for each in bounds)
        if len(starts) != len(ends) or not len(starts):
            lines.fail(line, f"the sets have {len(starts)} and {len(ends)} nodes; they need as many, one or more")
        if count < 1 or count * len(starts) > _LARGEST:
            lines.fail(line, f"expected a number of intervals, found '{shortened(fields[2])}'")
        made = []
        for first, last in zip(starts.tolist(), ends.tolist(), strict=True):
            start, end = (_position(lines, line, scope, node) for node in (first, last))
            numbers = first + step * np.arange(1, count)
            _add_nodes(lines, line, scope, numbers, straight(start, end, np.arange(1, count) / count))
            made += [np.array([first]), numbers, np.array([last])]
        if "NSET" in given:
            new_set(lines, keyword, given["NSET"], scope.node_sets).add(np.concatenate(made))


def copy_nodes(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*NCOPY, SHIFT`: a set of nodes again, moved."""
    given = parameters(lines, keyword, ("CHANGENUMBER", "OLDSET", "NEWSET", "SHIFT"))
    old = _set(lines, keyword.line, scope.node_sets, given.get("OLDSET", ""))
    change = whole(lines, keyword.line, given.get("CHANGENUMBER", ""), "CHANGE NUMBER=a whole number")
    what = "a translation, then two points of an axis and an angle"
    moved = move(reals(lines, keyword, 0, 3, what), reals(lines, keyword, 1, 7, what))
    if "SHIFT" not in given or moved is None:
        lines.fail(keyword.line, f"*NCOPY is read with SHIFT and {what}")
    numbers = flat(old)
    if not len(numbers):
        return
    points = moved(np.array([_position(lines, keyword.line, scope, node) for node in numbers.tolist()]))
    _add_nodes(lines, keyword.line, scope, numbers + change, points)
    if "NEWSET" in given:
        new_set(lines, keyword, given["NEWSET"], scope.node_sets).add(numbers + change)


def generate_elements(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*ELGEN`: rows and layers of an element."""
    given = parameters(lines, keyword, ("ELSET",))
    what = "an element, and three times a number of elements and increments of nodes and elements"
    for line in keyword.rows:
        fields = split(lines.text(line))
        defaults = (None, 1, 1, 1, 1, 0, 0, 1, 0, 0)
        master, *rest = _wholes(lines, line, fields[:10], what, defaults)
        found = scope.row_of(master)
        if found is None:
            lines.fail(line, f"there is no element {master} above that is a surface or a line")
        block, row = found
        counts, node_steps, steps = rest[::3], rest[1::3], rest[2::3]
        if min(counts) < 1 or float(np.prod(counts, dtype=float)) > _LARGEST:
            lines.fail(line, f"expected {what}, found '{shortened(lines.text(line))}'")
        numbers, shifts = np.array([master]), np.array([0])
        for count, node_step, step in zip(counts, node_steps, steps, strict=True):
            times = np.arange(count)
            numbers = (numbers + step * times[:, None]).ravel()
            shifts = (shifts + node_step * times[:, None]).ravel()
        _add_elements(lines, line, scope, block, numbers[1:], block.nodes[row] + shifts[1:, None])
        if "ELSET" in given:
            new_set(lines, keyword, given["ELSET"], scope.element_sets).add(numbers)


def copy_elements(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*ELCOPY`: a set of elements again, on other nodes."""
    given = parameters(lines, keyword, ("ELEMENTSHIFT", "OLDSET", "SHIFTNODES", "NEWSET"))
    old = flat(_set(lines, keyword.line, scope.element_sets, given.get("OLDSET", "")))
    shift, node_shift = (
        whole(lines, keyword.line, given.get(name, ""), f"{words}=a whole number")
        for name, words in (("ELEMENTSHIFT", "ELEMENT SHIFT"), ("SHIFTNODES", "SHIFT NODES"))
    )
    for block in list(scope.elements):
        rows = np.flatnonzero(np.isin(block.numbers, old))
        numbers, nodes = block.numbers[rows] + shift, block.nodes[rows] + node_shift
        _add_elements(lines, keyword.line, scope, block, numbers, nodes)
    if "NEWSET" in given:
        new_set(lines, keyword, given["NEWSET"], scope.element_sets).add(old + shift)


def _add_nodes(lines: Lines, line: int, scope: Scope, numbers: IntArray, points: FloatArray) -> None:
    _count(lines, line, scope, len(numbers))
    scope.nodes.append(Nodes(numbers, points, np.full(len(numbers), line)))


def _add_elements(lines: Lines, line: int, scope: Scope, like: Elements, numbers: IntArray, nodes: IntArray) -> None:
    _count(lines, line, scope, len(numbers))
    if len(numbers):
        scope.elements.append(Elements(like.type_name, like.kind, numbers, nodes, np.full(len(numbers), line)))


def _count(lines: Lines, line: int, scope: Scope, made: int) -> None:
    scope.generated += made
    if scope.generated > _LARGEST:
        lines.fail(line, f"more than {_LARGEST} nodes and elements are generated")


def _wholes(lines: Lines, line: int, fields: list[str], what: str, defaults: Sequence[int | None]) -> list[int]:
    """Whole numbers; an empty field has its default, or is a fault if that is None."""
    padded = fields + [""] * (len(defaults) - len(fields))
    return [
        default if not field and default is not None else whole(lines, line, field, what)
        for field, default in zip(padded, defaults, strict=True)
    ]


def _set(lines: Lines, line: int, sets: dict[str, NamedSet], label: str) -> NamedSet:
    found = lookup(sets, label)
    if found is None:
        lines.fail(line, f"there is no set '{shortened(shown(label))}' above")
    return found


def _position(lines: Lines, line: int, scope: Scope, node: int) -> FloatArray:
    found = scope.position(node)
    if found is None:
        lines.fail(line, f"there is no node {node} above")
    return found
