"""Shapes of an SVG file, read by svgelements."""

from __future__ import annotations

import pathlib
import re
from collections.abc import Iterator
from itertools import count
from typing import Any
from xml.etree.ElementTree import ParseError

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.mesh.drawings.pieces import FOLLOWED, STEP, Drawing, Piece, counted

PIXEL = 25.4 / 96.0
"""Of CSS, mm."""
ABSOLUTE = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72.0, "pc": 25.4 / 6.0, "q": 0.25, "px": PIXEL, "": PIXEL}
"""Units of the size of the page, mm."""
UNGROUPED = "drawing"
"""Layer of shapes in no group."""
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_MODE = "{http://www.inkscape.org/namespaces/inkscape}groupmode"
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([a-zA-Z]*)\s*")


def read_svg(path: pathlib.Path, name: str) -> Drawing:
    """The curves of all shapes that are shown, y upwards, in the units of the drawing (those of its viewBox).

    A layer is one of Inkscape; else the outermost group with an id.

    Raises
    ------
    InputError
        Not an SVG file.
    """
    from svgelements import SVG, Path, Shape, SVGText

    try:
        svg = SVG.parse(str(path), reify=True)
    except (ParseError, OSError, ValueError, KeyError, AttributeError, TypeError, IndexError) as error:
        line = f", line {error.position[0]}" if isinstance(error, ParseError) else ""
        raise InputError(f"{name}{line}: is not an SVG file, or a damaged one") from None
    scale, origin, millimetres, unit = _frame(svg)
    pieces: list[Piece] = []
    others = dict[str, int]()
    numbers = count()
    for element, layer in _elements(svg, ""):
        if isinstance(element, Shape):
            for subpath in abs(Path(element)).as_subpaths():
                number = next(numbers)
                for points, arc in _curves(subpath):
                    own = (points - origin) / scale * (1.0, -1.0)
                    pieces.append(Piece(own, layer or UNGROUPED, arc, number))
        else:
            what = "text" if isinstance(element, SVGText) else type(element).__name__.lower()
            others[what] = others.get(what, 0) + 1
    notes = counted(others, "elements that are no lines")
    return Drawing(pieces, millimetres, unit, tuple(notes))


def _frame(svg: Any) -> tuple[float, FloatArray, float | None, str]:
    """Pixels in a unit of the drawing; the corner below on the left, pixels; that unit, mm, and its name.

    Without a size of the page, or with one in per cent, the file does not say what its unit is: programs write 72, 90
    or 96 to the inch.
    """
    box = svg.viewbox
    height = float(svg.height or 0.0)
    given = _LENGTH.fullmatch(str(svg.values.get("attributes", {}).get("width", svg.values.get("width", ""))))
    corner = np.array([0.0, height])
    known = given is not None and given[2].lower() in ABSOLUTE
    if box is None or not box.width or not box.height or not svg.width:
        return 1.0, corner, PIXEL if known else None, "px"
    scale = min(float(svg.width) / box.width, height / box.height)
    if given is None or not known:
        return scale, corner, None, ""
    length, named = float(given[1]), given[2].lower()
    return scale, corner, ABSOLUTE[named] * length / box.width, named or "px"


def _elements(group: Any, layer: str) -> Iterator[tuple[Any, str]]:
    """Shapes, texts and pictures with their layers; clones (`use`) are on the layer where they are placed."""
    from svgelements import Group, Use

    for element in group:
        if isinstance(element, Use):
            yield from _elements(element, layer)
            continue
        if not isinstance(element, Group):
            yield element, layer
            continue
        own = element.values.get("attributes", {})
        if own.get(_MODE) == "layer" and own.get(_LABEL):
            yield from _elements(element, own[_LABEL])
        else:
            yield from _elements(element, layer or own.get(_LABEL) or own.get("id") or "")


def _curves(path: Any) -> Iterator[tuple[FloatArray, bool]]:
    """Points of every piece of a path, pixels, and whether they lie on a circle."""
    from svgelements import Arc, Close, CubicBezier, Line, QuadraticBezier

    for segment in path:
        if isinstance(segment, Line | Close):
            if segment.start is not None and segment.end is not None:
                yield _of([segment.start, segment.end]), False
        elif isinstance(segment, Arc):
            number = max(5, int(np.ceil(abs(segment.sweep) / STEP)) + 1)
            inside = [segment.point(float(t)) for t in np.linspace(0.0, 1.0, number)[1:-1]]
            yield _of([segment.start, *inside, segment.end]), bool(segment.is_circular())
        elif isinstance(segment, CubicBezier | QuadraticBezier):
            yield _flattened(segment), False


def _of(points: list[Any]) -> FloatArray:
    return np.array([[point.x, point.y] for point in points], dtype=np.float64)


def _flattened(segment: Any) -> FloatArray:
    """Points of a Bézier curve so dense that its chords are off it by little of its length."""
    number = 9
    while True:
        t = np.linspace(0.0, 1.0, 2 * number - 1)
        points = _of([segment.point(float(each)) for each in t])
        off = np.linalg.norm(points[1::2] - 0.5 * (points[:-2:2] + points[2::2]), axis=1).max()
        if off <= FOLLOWED * np.linalg.norm(np.ptp(points, axis=0)) or number > 200:
            return points[::2]
        number = 2 * number - 1
