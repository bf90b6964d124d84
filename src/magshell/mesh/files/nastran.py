"""Nastran's bulk data (`.bdf`, `.nas`, `.fem`): grid points in any coordinate system, shells, lines, their properties.

meshio's and gmsh's readers are not used for them: both take every coordinate for a global Cartesian one, and skip what
they do not know.
"""

from __future__ import annotations

from collections import defaultdict
from typing import NoReturn

import numpy as np

from magshell.mesh.files.cards import Card, read_cards
from magshell.mesh.files.cells import LINE2, LINE3, QUAD4, QUAD8, QUAD9, TRIANGLE3, TRIANGLE6, Kind
from magshell.mesh.files.contents import GROUPED, Block, Contents, in_order, places
from magshell.mesh.files.lines import Lines
from magshell.mesh.files.systems import Systems
from magshell.units import LENGTH

_SHELLS: dict[str, tuple[tuple[Kind, ...], int | None]] = {
    "CTRIA3": ((TRIANGLE3,), 6),
    "CTRIAR": ((TRIANGLE3,), 6),
    "CTRIA6": ((TRIANGLE6, TRIANGLE3), 9),
    "CQUAD4": ((QUAD4,), 7),
    "CQUADR": ((QUAD4,), 7),
    "CQUAD8": ((QUAD8, QUAD4), 15),
    "CQUAD": ((QUAD9, QUAD8, QUAD4), None),
}
"""Kinds of an element by the nodes that are there, most first; and the field of its offset from the nodes."""
_LINES: dict[str, tuple[Kind, int]] = {
    **dict.fromkeys(("CBAR", "CBEAM", "CROD", "CTUBE"), (LINE2, 2)),
    **dict.fromkeys(("CONROD", "PLOTEL"), (LINE2, 1)),
    "CBEAM3": (LINE3, 2),
}
"""Kind, and the field of the first node; behind a property, if it is not the second."""
_SURFACES = ("CTRI", "CQUAD", "CSHEAR", "CPLST", "CTRAX", "CTRIAX", "CRAC2D", "PLOTTRI", "PLOTQUA")
_SOLIDS = ("CTETRA", "CHEXA", "CPENTA", "CPYRA", "CIHEX", "CRAC3D", "CSOLID")
_NO_ELEMENTS = ("CORD", "CEND")


def read_nastran(content: bytes, name: str) -> Contents:
    """Read the mesh of a bulk data file; elements of one property become a group.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        What is wrong, with file and line; shells that are offset from their nodes.
    """
    lines = Lines(name, content)
    by_name: dict[str, list[Card]] = defaultdict(list)
    for card in read_cards(lines):
        by_name[card.name].append(card)
    for card in by_name["INCLUDE"]:
        lines.fail(card.line, "INCLUDE is not followed; put the included file in its place")
    grids = by_name["GRID"]
    if not grids:
        lines.fail(0, "has no GRID cards: not Nastran's bulk data, or without a mesh")
    systems = Systems(lines, by_name)
    positions = systems.positions()

    def twice(row: int) -> NoReturn:
        lines.fail(grids[row].line, f"grid point {grids[row].text(0)} is given a second time")

    every = np.array([card.whole(lines, 0, "the number of a grid point") for card in grids], dtype=np.int64)
    numbers, points = in_order(every, np.array([positions[number] for number in every.tolist()]), twice)
    sorted_out: dict[Kind, list[tuple[list[int], int, Card]]] = defaultdict(list)
    unread, notes, solids = {}, [], 0
    for called, found in by_name.items():
        if called in _SHELLS:
            for card in found:
                kind, row = _shell(lines, card)
                sorted_out[kind].append((row, card.whole(lines, 1, "a property", default=row[0]), card))
        elif called in _LINES:
            kind, first = _LINES[called]
            for card in found:
                row = [card.whole(lines, place, "a number") for place in (0, *range(first, first + kind.nodes))]
                sorted_out[kind].append((row, card.whole(lines, 1, "a property", default=0) if first > 1 else 0, card))
        elif called.startswith(_SOLIDS):
            solids += len(found)
        elif called.startswith(_SURFACES):
            unread[called] = len(found)
        elif called.startswith("C") and found and not called.startswith(_NO_ELEMENTS):
            notes.append(f"{len(found)} cards {called} left out")
    blocks = []
    for kind, elements in sorted_out.items():

        def missing(row: int, number: int, elements: list[tuple[list[int], int, Card]] = elements) -> NoReturn:
            card = elements[row][2]
            lines.fail(card.line, f"{card.name} {card.text(0)} has grid point {number}, which is not there")

        rows = np.array([row for row, _, _ in elements], dtype=np.int64)
        properties = np.array([number for _, number, _ in elements], dtype=np.int64)
        groups = {
            f"{GROUPED[kind.dimension]}-{number}": np.flatnonzero(properties == number)
            for number in np.unique(properties).tolist()
            if number
        }
        blocks.append(Block(kind, rows[:, 0], places(numbers, rows[:, 1:], missing), groups))
    unit = _unit(lines, by_name["DTI"])
    return Contents(points, blocks, solids=solids, unread=unread, unit=unit, notes=tuple(notes))


def _shell(lines: Lines, card: Card) -> tuple[Kind, list[int]]:
    """Kind, number and nodes of a shell; middles may be left out, but only all of them."""
    kinds, offset = _SHELLS[card.name]
    if offset is not None and card.real(lines, offset, "an offset"):
        lines.fail(
            card.line,
            f"{card.name} {card.text(0)} is offset from its grid points by {card.text(offset)}; put the grid points on "
            "the mid-surface",
        )
    given = [bool(card.text(2 + place)) for place in range(kinds[0].nodes)]
    kind = next((kind for kind in kinds if all(given[: kind.nodes]) and not any(given[kind.nodes :])), None)
    if kind is None:
        least, most = kinds[-1].nodes, kinds[0].nodes
        counts = f"{least}" if least == most else f"{least} or {most}"
        lines.fail(card.line, f"{card.name} {card.text(0)} has {sum(given)} grid points, not {counts} in a row")
    return kind, [card.whole(lines, place, "a number") for place in (0, *range(2, 2 + kind.nodes))]


def _unit(lines: Lines, cards: list[Card]) -> str | None:
    """Of lengths, where a card DTI,UNITS says it."""
    for card in cards:
        if card.text(0).upper() == "UNITS":
            said = card.text(4).lower()
            if said not in LENGTH.units:
                lines.fail(card.line, f"lengths are in {card.text(4)}; allowed are {LENGTH.allowed}")
            return said
    return None
