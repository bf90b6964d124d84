"""Outlines as polygons in a CSV file."""

from __future__ import annotations

import math
import pathlib
import re
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from magshell.errors import InputError
from magshell.mesh.drawings.pieces import Drawing, Piece
from magshell.units import LENGTH, shortened

LAYER = "outline"
"""Of a file that names none."""
MOST_LINES = 1_000_000
_HEADING = re.compile(r"\s*(?:x1?|X1?)\s*(?:\[(.*)\]|\((.*)\)|/(.*))?\s*")


def read_table(path: pathlib.Path, name: str) -> Drawing:
    """Corners, one a line: x1, x2 and, if there is a third column, a layer. An empty line ends a polygon.

    Fields are separated by commas, semicolons or tabs. The first line may name the columns, with a unit: `x1 [mm]`.

    Raises
    ------
    InputError
        With file and line.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise InputError(f"{name}: is not a text file in UTF-8 (byte {error.start})") from None
    if len(lines) > MOST_LINES:
        raise InputError(f"{name}: has more than {MOST_LINES} lines")
    polygons: list[tuple[str, list[tuple[float, float]], int]] = []
    unit, began, separator = "", False, ""
    for number, line in enumerate(lines, start=1):
        if line.lstrip().startswith("#"):
            continue
        if not line.strip(" ,;\t"):
            began = False
            continue
        separator = separator or next((sign for sign in ";\t" if sign in line), ",")
        fields = [field.strip() for field in line.split(separator)]
        heading = _HEADING.fullmatch(fields[0])
        if heading is not None and not polygons:
            unit = next((each.strip() for each in heading.groups() if each), "")
            continue
        where = f"{name}, line {number}"
        if len(fields) not in (2, 3):
            raise InputError(f"{where}: has {len(fields)} fields; expected x1, x2 and, if need be, a layer")
        corner = _number(fields[0], where, separator), _number(fields[1], where, separator)
        layer = fields[2] if len(fields) == 3 and fields[2] else LAYER
        if not began or polygons[-1][0] != layer:
            polygons.append((layer, [], number))
        polygons[-1][1].append(corner)
        began = True
    if unit and LENGTH.value(unit) is None:
        raise InputError(f"{name}, line 1: '{shortened(unit)}' is not a unit of length, which are {LENGTH.allowed}")
    pieces = [
        piece
        for number, (layer, corners, line) in enumerate(polygons)
        for piece in polygon(corners, layer, number, f"{name}, line {line}")
    ]
    return Drawing(pieces, 1e3 * float(LENGTH.value(unit) or 0.0) if unit else None, unit)


def polygon(corners: Sequence[tuple[float, float]], layer: str, number: int, where: str) -> list[Piece]:
    """The sides of a polygon; the last corner may be the first once more.

    Raises
    ------
    InputError
        Fewer than three corners.
    """
    corners = [corner for at, corner in enumerate(corners) if not at or corner != corners[at - 1]]
    if len(corners) > 1 and corners[0] == corners[-1]:
        corners = corners[:-1]
    if len(corners) < 3:
        raise InputError(f"{where}: the polygon has {len(corners)} corners; it needs three or more")
    return [
        Piece(np.array([begin, end], dtype=np.float64), layer, entity=number)
        for begin, end in pairwise([*corners, corners[0]])
    ]


def _number(text: str, where: str, separator: str) -> float:
    if separator != ",":
        text = text.replace(",", ".")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{where}: '{shortened(text)}' is not a coordinate")
    return value
