"""A second reader of input files, small and slow, to compare the program's with.

It works in another way (an instance runs the text of its part again) and takes only what it is sure of.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from faults.inp_model import CORNERS, NODES, Member, Model, Named


class Unsure(Exception):
    """Something that this reader does not judge."""


@dataclass
class Block:
    """A keyword and the names of its parameters in lower case without blanks; the fields of its rows."""

    word: str
    given: dict[str, str]
    rows: list[list[str]]


def reference(text: str) -> Model:
    """The model of a text."""
    model = Model()
    parts: dict[str, list[Block]] = {}
    blocks = _blocks(text)
    frame = None
    for block in blocks:
        if block.word == "part":
            name = _label(block.given["name"])
            _sure(name not in parts)
            parts[name] = list(_until(blocks, "endpart"))
        elif block.word == "instance":
            part = parts.get(_label(block.given["part"]))
            _sure(part is not None and set(block.given) == {"name", "part"})
            _instance(model, block.given["name"], part or [], block.rows, list(_until(blocks, "endinstance")))
        elif block.word not in ("assembly", "endassembly"):
            _sure(block.word not in ("endpart", "endinstance"))
            frame = _run(model, "", block, frame)
    _sure(bool(parts) == bool(model.scopes))
    return model


def _until(blocks: Iterator[Block], end: str) -> Iterator[Block]:
    for block in blocks:
        if block.word == end:
            return
        _sure(block.word not in ("part", "instance", "assembly", "endpart", "endinstance", "endassembly"))
        yield block
    raise Unsure


def _instance(model: Model, name: str, part: list[Block], placing: list[list[str]], own: list[Block]) -> None:
    _sure(bool(re.fullmatch(r"\w[\w-]*", name)) and _label(name) not in {_label(each) for each in model.scopes})
    model.scopes.append(name)
    for blocks in (part, own):
        frame = None
        for block in blocks:
            frame = _run(model, name, block, frame)
    _sure(len(placing) <= 2 and all(len(row) == width for row, width in zip(placing, (3, 7), strict=False)))
    shift = np.array([_real(field) for field in placing[0]]) if placing else np.zeros(3)
    for member, point in model.nodes.items():
        if member[0] == name:
            moved = np.array(point) + shift
            if len(placing) == 2:
                numbers = np.array([_real(field) for field in placing[1]])
                moved = _turned(moved, numbers[:3], numbers[3:6], math.radians(numbers[6]))
            model.nodes[member] = tuple(moved.tolist())


def _turned(point: np.ndarray, start: np.ndarray, end: np.ndarray, angle: float) -> np.ndarray:
    """By Rodrigues' formula."""
    _sure(np.linalg.norm(end - start) > 1e-9)
    axis, arm = (end - start) / np.linalg.norm(end - start), point - start
    return (
        start
        + arm * math.cos(angle)
        + np.cross(axis, arm) * math.sin(angle)
        + axis * (axis @ arm) * (1.0 - math.cos(angle))
    )


def _run(model: Model, scope: str, block: Block, frame: np.ndarray | None) -> np.ndarray | None:
    """Take in a block; return the frame (4, 3) of origin and axes that holds then."""
    given, rows = block.given, block.rows
    match block.word:
        case "system":
            return _frame(rows)
        case "node":
            _sure(set(given) <= {"nset", "system"} and given.get("system", "r").lower() in ("r", "c"))
            for number, *coordinates in rows:
                _sure(len(coordinates) <= 3)
                x, y, z = ([_real(field) for field in coordinates] + [0.0, 0.0, 0.0])[:3]
                if given.get("system", "r").lower() == "c":
                    x, y = x * math.cos(math.radians(y)), x * math.sin(math.radians(y))
                point = (x, y, z) if frame is None else frame[0] + x * frame[1] + y * frame[2] + z * frame[3]
                _new_node(model, (scope, _whole(number)), point)
                _into(model, scope, "nset", given.get("nset"), {(scope, _whole(number))})
        case "ngen":
            _sure(set(given) <= {"nset"})
            for row in rows:
                _sure(len(row) == 3)
                first, last, step = (_whole(field) for field in row)
                _sure(0 < step <= last - first < 9999 and (last - first) % step == 0)
                _line(model, scope, first, last, range(first + step, last, step))
                inside = {(scope, number) for number in range(first, last + 1, step)}
                _into(model, scope, "nset", given.get("nset"), inside)
        case "nfill":
            _sure(set(given) <= {"nset"})
            for low, high, count, step in rows:
                a, b = (sorted(number for _, number in _set(model, scope, "nset", label)) for label in (low, high))
                _sure(len(a) == len(b) and 0 < _whole(count) < 9999)
                for first, last in zip(a, b, strict=True):
                    made = [first + _whole(step) * k for k in range(1, _whole(count))]
                    _line(model, scope, first, last, made)
                    _into(model, scope, "nset", given.get("nset"), {(scope, n) for n in (first, *made, last)})
        case "element":
            _sure(set(given) <= {"type", "elset"} and given.get("type", "").upper() in NODES)
            flat = [field for row in rows for field in row]
            width = 1 + NODES[given["type"].upper()]
            _sure(len(flat) % width == 0)
            starts = [sum(len(row) for row in rows[:k]) for k in range(len(rows))]
            _sure(all(at in starts for at in range(0, len(flat), width)))
            for at in range(0, len(flat), width):
                number, *nodes = (_whole(field) for field in flat[at : at + width])
                _new_element(model, (scope, number), given["type"].upper(), tuple(nodes))
                _into(model, scope, "elset", given.get("elset"), {(scope, number)})
        case "elgen":
            _sure(set(given) <= {"elset"})
            for row in rows:
                _sure(len(row) == 7)
                master, n, node, number, m, row_node, row_number = (_whole(field) for field in row)
                _sure((scope, master) in model.elements and 0 < n * m < 9999)
                kind, nodes = model.elements[scope, master]
                _sure(kind != "MASS")
                for j in range(m):
                    for i in range(n):
                        made = (scope, master + i * number + j * row_number)
                        if i or j:
                            _new_element(model, made, kind, tuple(k + i * node + j * row_node for k in nodes))
                        _into(model, scope, "elset", given.get("elset"), {made})
        case "nset" | "elset":
            _named_set(model, scope, block)
        case "surface":
            _surface(model, scope, block)
        case "heading" | "material" | "elastic":
            pass
        case _:
            raise Unsure
    return frame


def _frame(rows: list[list[str]]) -> np.ndarray | None:
    if not rows:
        return None
    _sure([len(row) for row in rows] in ([3], [6, 3]))
    first = [_real(field) for field in rows[0]]
    if len(rows) == 1:
        return np.vstack([first, np.eye(3)])
    a, b, c = np.array(first[:3]), np.array(first[3:]), np.array([_real(field) for field in rows[1]])
    _sure(np.linalg.norm(np.cross(b - a, c - a)) > 1e-6 * np.linalg.norm(b - a) * np.linalg.norm(c - a))
    x = (b - a) / np.linalg.norm(b - a)
    y = (c - a) - x * (x @ (c - a))  # by Gram and Schmidt
    y /= np.linalg.norm(y)
    return np.vstack([a, x, y, np.cross(x, y)])


def _line(model: Model, scope: str, first: int, last: int, numbers: list[int] | range) -> None:
    _sure((scope, first) in model.nodes and (scope, last) in model.nodes)
    a, b = np.array(model.nodes[scope, first]), np.array(model.nodes[scope, last])
    for k, number in enumerate(numbers, 1):
        _new_node(model, (scope, number), a + (b - a) * (k / (len(numbers) + 1)))


def _new_node(model: Model, member: Member, point: np.ndarray | tuple[float, float, float]) -> None:
    _sure(member not in model.nodes and all(math.isfinite(x) for x in point))
    model.nodes[member] = tuple(float(x) for x in point)


def _new_element(model: Model, member: Member, kind: str, nodes: tuple[int, ...]) -> None:
    _sure(member not in model.elements)
    model.elements[member] = (kind, nodes)


def _named_set(model: Model, scope: str, block: Block) -> None:
    given, kind = block.given, block.word
    _sure(set(given) <= {kind, "generate", "instance", "internal", "unsorted", "elset"})
    owner = _instance_name(model, given["instance"]) if "instance" in given else scope
    _sure(owner == scope or not scope)
    inside: set[Member] = set()
    if kind == "nset" and "elset" in given:
        _sure("generate" not in given)
        chosen = (
            _set(model, owner, "elset", given["elset"])
            if (owner, _label(given["elset"])) in model.element_sets
            else None
        )
        _sure(chosen is not None or owner != scope)
        chosen = chosen if chosen is not None else _set(model, scope, "elset", given["elset"])
        inside = {(part, n) for part, number in chosen for n in model.elements.get((part, number), ("", ()))[1]}
    elif "generate" in given:
        for row in block.rows:
            first, last, step = [_whole(field) for field in row] + [1] * (len(row) == 2)
            _sure(step > 0 and last - first < 99999)
            inside |= {(owner, number) for number in range(first, last + 1, step)}
    else:
        for field in (field for row in block.rows for field in row if field):
            inside |= _members(model, owner, scope, kind, field)
    _into(model, scope, kind, given.get(kind), inside)
    _sure(kind in given)


def _members(model: Model, owner: str, scope: str, kind: str, field: str) -> set[Member]:
    sets = model.node_sets if kind == "nset" else model.element_sets
    if re.fullmatch(r"-?\d+", field):
        return {(owner, _whole(field))}
    for place in (owner, scope):
        if (place, _label(field)) in sets:
            return set(sets[place, _label(field)].members)
    found = re.fullmatch(r"([\w-]+)\.([\w -]+)", field)
    if found is None or scope:
        raise Unsure
    owner = _instance_name(model, found[1])
    return {(owner, int(found[2]))} if found[2].isdigit() else _set(model, owner, kind, found[2])


def _set(model: Model, scope: str, kind: str, label: str) -> set[Member]:
    sets = model.node_sets if kind == "nset" else model.element_sets
    _sure((scope, _label(label)) in sets)
    return set(sets[scope, _label(label)].members)


def _into(model: Model, scope: str, kind: str, label: str | None, members: set[Member]) -> None:
    if label is None:
        return
    _sure(bool(label.strip('" ')))
    sets = model.node_sets if kind == "nset" else model.element_sets
    shown = label[1:-1] if label.startswith('"') else label
    sets.setdefault((scope, _label(label)), Named(scope, shown)).members.update(members)


def _surface(model: Model, scope: str, block: Block) -> None:
    given = block.given
    _sure(
        set(given) <= {"name", "type"} and given.get("type", "element").lower() == "element" and bool(given.get("name"))
    )
    chosen = model.edges.setdefault((scope, _label(given["name"])), (given["name"], set()))[1]
    for row in block.rows:
        _sure(len(row) == 2 and row[1].upper() in ("E1", "E2", "E3", "E4"))
        for member in _members(model, scope, scope, "elset", row[0]):
            kind, side = model.elements.get(member, ("", ()))[0], int(row[1][1]) - 1
            if not kind:
                continue
            _sure(kind in CORNERS and side < CORNERS[kind])
            chosen.add((*member, side))
    _sure(bool(chosen))


def _instance_name(model: Model, label: str) -> str:
    found = [name for name in model.scopes if _label(name) == _label(label)]
    _sure(len(found) == 1)
    return found[0]


def _label(text: str) -> str:
    return text[1:-1] if text.startswith('"') else re.sub(r"\s", "", text).upper()


def _whole(text: str) -> int:
    _sure(bool(re.fullmatch(r"[+-]?\d{1,11}", text, re.ASCII)) and abs(int(text)) <= 10**11)
    return int(text)


def _real(text: str) -> float:
    if not text:
        return 0.0
    _sure(bool(re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?", text, re.ASCII)))
    return float(text.upper().replace("D", "E"))


def _sure(condition: bool) -> None:
    if not condition:
        raise Unsure


def _blocks(text: str) -> Iterator[Block]:
    found: list[str] = []
    for line in [*re.split(r"\r\n|\r|\n", text), "*"]:
        line = line.strip()
        if line.startswith("*") and not line.startswith("**"):
            if found:
                yield _block(found)
            found = [line]
        elif found and line and not line.startswith("**"):
            found.append(line)


def _block(lines: list[str]) -> Block:
    head, rows = lines[0], lines[1:]
    if head.endswith(","):
        _sure(bool(rows) and not re.match(r"[\d.+-]", rows[0]))
        head, rows = head + rows[0], rows[1:]
        _sure(not head.endswith(","))
    word, *parameters = _fields(head[1:])
    given = []
    for name, _, value in (each.partition("=") for each in parameters):
        short = re.sub(r"\s", "", name).lower()
        given.append(("generate" if short == "gen" else short, value.strip()))
    _sure(len(dict(given)) == len(given))
    return Block(re.sub(r"\s", "", word).lower(), dict(given), [_fields(row.rstrip(", \t")) for row in rows])


def _fields(text: str) -> list[str]:
    _sure(text.count('"') % 2 == 0 and text.isprintable())
    return [field.strip() for field in re.findall(r'((?:"[^"]*"|[^,"])*)(?:,|$)', text)][
        : len(re.sub(r'"[^"]*"', "", text).split(","))
    ]
