"""Nodes, elements, sets and surfaces as a file writes them, into a scope."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import suggest
from magshell.mesh.files.cells import Kind
from magshell.mesh.files.inp.frames import from_cylindrical
from magshell.mesh.files.inp.keywords import (
    Keyword,
    is_whole,
    key,
    lookup,
    parameters,
    real,
    shown,
    split,
    table,
    whole,
    whole_rows,
)
from magshell.mesh.files.inp.scope import Elements, NamedSet, Nodes, Numbers, Scope, Skipped, Surface
from magshell.mesh.files.inp.types import kind_of, may_have_direction
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_LARGEST_SET = 10_000_000
_NODE_FIELDS = 7
"""Number, three coordinates, three direction cosines."""


def read_nodes(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*NODE`: number and up to three coordinates; direction cosines behind them are not used."""
    given = parameters(lines, keyword, ("NSET", "SYSTEM"))
    found = table(lines, keyword.rows, float)
    if found is None or not 1 < found.shape[1] <= _NODE_FIELDS or (found[:, 0] != np.rint(found[:, 0])).any():
        found = np.array([_node(lines, line) for line in keyword.rows], dtype=np.float64).reshape(-1, 4)
    coordinates = np.zeros((len(found), 3))
    coordinates[:, : found.shape[1] - 1] = found[:, 1:4]
    numbers = found[:, 0].astype(np.int64)
    points = positions(lines, keyword.line, given, coordinates, scope)
    scope.nodes.append(Nodes(numbers, points, np.array(keyword.rows, dtype=np.int64)))
    if "NSET" in given:
        new_set(lines, keyword, given["NSET"], scope.node_sets).add(numbers)


def _node(lines: Lines, line: int) -> list[float]:
    what = "a node number and three coordinates"
    fields = split(lines.text(line).rstrip(", \t"))
    if not is_whole(fields[0]) or len(fields) > _NODE_FIELDS:
        lines.fail(line, f"expected {what}, found '{shortened(lines.text(line))}'")
    number = whole(lines, line, fields[0], what)
    return [number, *([real(lines, line, field, what) for field in fields[1:4]] + [0.0, 0.0, 0.0])[:3]]


def positions(lines: Lines, line: int, given: Mapping[str, str], coordinates: FloatArray, scope: Scope) -> FloatArray:
    """Positions in the scope of coordinates in the system of the keyword, and that of `*SYSTEM`."""
    match given.get("SYSTEM", "R").upper():
        case "R" | "RC":
            points = coordinates
        case "C":
            points = from_cylindrical(coordinates)
        case other:
            lines.fail(line, f"SYSTEM={shortened(other)} is not read; R (rectangular) and C (cylindrical) are")
    return points if scope.frame is None else scope.frame.positions(points)


def read_elements(lines: Lines, keyword: Keyword, scope: Scope) -> None:
    """`*ELEMENT`: number and nodes."""
    given = parameters(lines, keyword, ("TYPE", "ELSET"))
    type_name = given.get("TYPE", "").upper()
    if not type_name:
        lines.fail(keyword.line, "the elements have no type: write *ELEMENT, TYPE=S8R")
    kind = kind_of(type_name)
    if isinstance(kind, Kind):
        block: Elements | Skipped = _elements(lines, keyword, type_name, kind)
        scope.elements += [block] if isinstance(block, Elements) and len(block.numbers) else []
    else:
        block = _skipped(lines, keyword, shortened(type_name), long=kind != "no surface")
        count = len(block.numbers)
        if kind == "solid":
            scope.solids += count
        elif kind == "unknown" and count:
            scope.unknown[block.type_name] = scope.unknown.get(block.type_name, 0) + count
        elif count:
            scope.skipped.append(block)
    if "ELSET" in given:
        new_set(lines, keyword, given["ELSET"], scope.element_sets).add(block.numbers)


def _elements(lines: Lines, keyword: Keyword, type_name: str, kind: Kind) -> Elements:
    flat, counts = whole_rows(lines, keyword.rows, "element and node numbers")
    width = 1 + kind.nodes
    if may_have_direction(type_name) and len(counts) and (counts == width + 1).all():
        flat, counts = flat.reshape(-1, width + 1)[:, :width].ravel(), counts - 1
    starts = np.concatenate([[0], np.cumsum(counts)])
    begins = np.arange(0, len(flat), width)
    rows = np.searchsorted(starts, begins)
    if len(flat) % width or (starts[rows] != begins).any():
        lines.fail(
            keyword.line,
            f"the elements of type {type_name} need {width} numbers each (their own and {kind.nodes} nodes) and "
            f"begin on a line of their own, but {len(flat)} numbers follow on {len(counts)} lines",
        )
    array = flat.reshape(-1, width)
    return Elements(type_name, kind, array[:, 0].copy(), array[:, 1:], np.array(keyword.rows, dtype=np.int64)[rows])


def _skipped(lines: Lines, keyword: Keyword, type_name: str, long: bool) -> Skipped:
    """Number and nodes of elements of any type; a line of those with many nodes goes on if it ends with a comma."""
    numbers: list[int] = []
    nodes: list[list[int]] = []
    where: list[int] = []
    goes_on = False
    for line in keyword.rows:
        fields = split(lines.text(line))
        if not goes_on:
            numbers.append(whole(lines, line, fields.pop(0), "an element number"))
            nodes.append([])
            where.append(line)
        nodes[-1] += [whole(lines, line, field, "a node number") for field in fields if is_whole(field)]
        goes_on = long and lines.every[line][-1:] == b","
    return Skipped(type_name, np.array(numbers, dtype=np.int64), nodes, np.array(where, dtype=np.int64))


def new_set(lines: Lines, keyword: Keyword, label: str, sets: dict[str, NamedSet]) -> NamedSet:
    """The set of this label, new if there is none yet."""
    if not shown(label).strip():
        lines.fail(keyword.line, f"the set has no name: write *{keyword.name}, {keyword.name}=NAME")
    return sets.setdefault(key(label), NamedSet(shown(label)))


def read_set(lines: Lines, keyword: Keyword, scope: Scope, instances: Mapping[str, Scope]) -> None:
    """`*NSET` and `*ELSET`: numbers, ranges, and other sets; the members may be those of an instance."""
    name = keyword.name
    allowed = (name, "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", *(("ELSET",) if name == "NSET" else ()))
    given = parameters(lines, keyword, allowed)
    sets = scope.node_sets if name == "NSET" else scope.element_sets
    result = new_set(lines, keyword, given.get(name, ""), sets)
    result.unsorted = result.unsorted or "UNSORTED" in given
    owner = instance_of(lines, keyword.line, given["INSTANCE"], instances) if "INSTANCE" in given else ""
    if name == "NSET" and "ELSET" in given:
        for instance, elements in members(lines, keyword.line, given["ELSET"], owner, scope, instances, "ELSET"):
            result.add((instances[instance] if instance else scope).nodes_of(elements), instance)
    elif "GENERATE" in given:
        for line in keyword.rows:
            result.add(_range(lines, line), owner)
    else:
        full = table(lines, keyword.rows[:-1], int)
        if full is not None:  # the last line may be shorter
            result.add(full.ravel(), owner)
        numbers: list[int] = []
        for line in keyword.rows if full is None else keyword.rows[-1:]:
            for text in split(lines.text(line)):
                if is_whole(text):
                    numbers.append(whole(lines, line, text, "a number"))
                elif text:
                    for instance, found in members(lines, line, text, owner, scope, instances, name):
                        result.add(found, instance)
        result.add(np.array(numbers, dtype=np.int64), owner)


def _range(lines: Lines, line: int) -> range:
    fields = split(lines.text(line).rstrip(", \t"))
    values = [whole(lines, line, field, "first, last and increment") for field in fields] + [1] * (len(fields) == 2)
    if len(values) != 3 or values[2] <= 0 or (values[1] - values[0]) / values[2] > _LARGEST_SET:
        lines.fail(line, f"expected first, last and increment, found '{shortened(lines.text(line))}'")
    return range(values[0], values[1] + 1, values[2])


def instance_of(lines: Lines, line: int, label: str, instances: Mapping[str, Scope]) -> str:
    """Key of an instance."""
    found = lookup({name: name for name in instances}, label)
    if found is None:
        known = suggest(shortened(shown(label)), (shortened(each.name) for each in instances.values()))
        lines.fail(line, f"there is no instance '{shortened(shown(label))}' above. {known}")
    return found


def members(
    lines: Lines,
    line: int,
    text: str,
    owner: str,
    scope: Scope,
    instances: Mapping[str, Scope],
    kind: str,
) -> list[tuple[str, Numbers]]:
    """What a label or a number stands for: pairs of an instance and numbers in it.

    It may be a set of the scope, or of the instance `owner`, or one of another instance (`instance.set`, or
    `instance.number`).
    """

    def sets(of: Scope) -> dict[str, NamedSet]:
        return of.node_sets if kind == "NSET" else of.element_sets

    if is_whole(text):
        return [(owner, np.array([whole(lines, line, text, "a number")]))]
    for instance in dict.fromkeys((owner, "")):
        found = lookup(sets(instances[instance] if instance else scope), text)
        if found is not None:
            return [(instance or part, numbers) for part, numbers in found.members()]
    first, rest = _parted(text)
    prefix = lookup({name: name for name in instances}, first) if rest else None
    if prefix is not None:
        if is_whole(rest):
            return [(prefix, np.array([whole(lines, line, rest, "a number")]))]
        found = lookup(sets(instances[prefix]), rest)
        if found is not None:
            return [(prefix, numbers) for _, numbers in found.members()]
        text, scope = rest, instances[prefix]
    known = suggest(shortened(shown(text)), (shortened(each.name) for each in sets(scope).values()))
    lines.fail(line, f"there is no set '{shortened(shown(text))}' above. {known}")


def _parted(text: str) -> tuple[str, str]:
    """An instance and what is named in it; the second is empty where there is no point between two names."""
    first, quote, rest = text[1:].partition('"') if text[:1] == '"' else text.partition(".")
    if quote == '"':
        first, rest = f'"{first}"', rest.strip()[1:] if rest.strip()[:1] == "." else ""
    return first, rest.strip()


def read_surface(lines: Lines, keyword: Keyword, scope: Scope, notes: list[str]) -> None:
    """`*SURFACE` of elements (with faces and edges) or nodes; of others `notes` says that they are left out."""
    given = dict(keyword.parameters)
    label, kind = given.get("NAME", ""), given.get("TYPE", "ELEMENT").upper()
    if not shown(label).strip():
        lines.fail(keyword.line, "the surface has no name: write *SURFACE, NAME=NAME")
    if kind not in ("ELEMENT", "NODE") or "COMBINE" in given or "CROP" in given:
        notes.append(f"surface '{shortened(shown(label))}' left out, as it is not made of elements or nodes")
        return
    surface = scope.surfaces.setdefault(key(label), Surface(shown(label), kind == "NODE"))
    for line in keyword.rows:
        text, face = (*split(lines.text(line)), "")[:2]
        surface.members.append((text, face.upper(), line))
