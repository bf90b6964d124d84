"""Lines, arcs, polylines, ellipses and splines of a DXF file, read by ezdxf."""

from __future__ import annotations

import pathlib
from collections.abc import Iterable, Iterator
from itertools import count
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.mesh.drawings.pieces import FOLLOWED, STEP, Drawing, Piece, counted
from magshell.units import shortened

UNITS = {
    1: ("inches", 25.4),
    2: ("feet", 304.8),
    4: ("mm", 1.0),
    5: ("cm", 10.0),
    6: ("m", 1e3),
    8: ("microinches", 25.4e-6),
    9: ("mils", 25.4e-3),
    10: ("yards", 914.4),
    12: ("nm", 1e-6),
    13: ("um", 1e-3),
    14: ("dm", 100.0),
}
"""Name and length, mm, of the units of `$INSUNITS`."""
NOT_PRINTED = "defpoints"
"""Layer of the points that dimensions are measured between."""
FLAT = 1e-6
"""Of the size of a drawing, by which its heights may differ."""
DEEPEST = 16
"""Blocks in blocks."""


def read_dxf(path: pathlib.Path, name: str) -> Drawing:
    """The curves of the model space, blocks too, on layers that are shown.

    Raises
    ------
    InputError
        Not a DXF file, or curves at different heights.
    """
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    try:
        document, _ = recover.readfile(path)
    except (DXFError, OSError, ValueError) as error:
        raise InputError(f"{name}: is not a DXF file, or a damaged one: {shortened(str(error))}") from None
    hidden = {layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()}
    pieces: list[Piece] = []
    heights: list[tuple[float, str]] = []
    others, unseen = dict[str, int](), dict[str, int]()
    for entity, layer, polyline in _entities(document.modelspace(), "0", 0, count()):
        if layer.lower() in hidden or layer.lower() == NOT_PRINTED or entity.dxf.get("invisible", 0):
            unseen[f"on layer '{layer}'"] = unseen.get(f"on layer '{layer}'", 0) + 1
            continue
        found = _points(entity)
        if found is None:
            others[entity.dxftype()] = others.get(entity.dxftype(), 0) + 1
            continue
        if len(found) > 1:
            pieces.append(Piece(found[:, :2], layer, entity.dxftype() in ("ARC", "CIRCLE"), polyline))
            heights += [(float(height), layer) for height in found[:, 2]]
    _must_be_flat(pieces, heights, name)
    notes = [*counted(others, "entities that are no lines"), *counted(unseen, "hidden lines")]
    unit, millimetres = UNITS.get(document.header.get("$INSUNITS", 0), ("", None))
    return Drawing(pieces, millimetres, unit, tuple(notes))


def _entities(
    entities: Iterable[Any], parent: str, depth: int, numbers: Iterator[int]
) -> Iterator[tuple[Any, str, int]]:
    """Entities with their layers, those of blocks where they are inserted; polylines, numbered, as lines and arcs."""
    for entity in entities:
        own = entity.dxf.get("layer", "0")
        layer = parent if own == "0" and depth else own
        kind = entity.dxftype()
        if kind == "INSERT" and depth < DEEPEST:
            inserts = entity.multi_insert() if entity.mcount > 1 else [entity]
            for insert in inserts:
                yield from _entities(insert.virtual_entities(), layer, depth + 1, numbers)
        elif kind == "LWPOLYLINE" or (kind == "POLYLINE" and (entity.is_2d_polyline or entity.is_3d_polyline)):
            number = next(numbers)
            for part in entity.virtual_entities():
                yield part, layer, number
        else:
            yield entity, layer, -1


def _points(entity: Any) -> FloatArray | None:
    """Points (k, 3) of a curve, in the frame of the drawing; None of anything else."""
    match entity.dxftype():
        case "LINE":
            points = [entity.dxf.start, entity.dxf.end]
        case "CIRCLE":
            points = list(entity.vertices(np.linspace(0.0, 360.0, round(2.0 * np.pi / STEP) + 1).tolist()))
        case "ARC":
            begin, span = entity.dxf.start_angle, (entity.dxf.end_angle - entity.dxf.start_angle) % 360.0 or 360.0
            points = list(entity.vertices((begin + np.linspace(0.0, span, _count(np.radians(span)))).tolist()))
        case "ELLIPSE":
            begin, end = entity.dxf.start_param, entity.dxf.end_param
            span = (end - begin) % (2.0 * np.pi) or 2.0 * np.pi
            points = list(entity.vertices((begin + np.linspace(0.0, span, _count(span))).tolist()))
        case "SPLINE":
            curve = entity.construction_tool()
            extent = np.ptp(np.array([tuple(point) for point in curve.control_points]), axis=0)
            points = list(curve.flattening(max(FOLLOWED * float(np.linalg.norm(extent)), 1e-12), segments=8))
        case _:
            return None
    found = np.array([tuple(point) for point in points], dtype=np.float64)
    if not np.isfinite(found).all():
        raise ValueError("coordinates that are not finite")
    if len(found) > 2 and np.linalg.norm(found[0] - found[-1]) <= 1e-9 * np.linalg.norm(np.ptp(found, axis=0)):
        found[-1] = found[0]
    return found


def _count(span: float) -> int:
    """Of points on an arc."""
    return max(5, int(np.ceil(span / STEP)) + 1)


def _must_be_flat(pieces: list[Piece], heights: list[tuple[float, str]], name: str) -> None:
    if not pieces:
        return
    size = np.linalg.norm(np.ptp(np.concatenate([piece.points for piece in pieces]), axis=0))
    (low, layer), (high, other) = min(heights), max(heights)
    if high - low > FLAT * size:
        raise InputError(
            f"{name}: is not flat: it has lines at z = {low:g} on layer '{layer}' and at z = {high:g} on layer "
            f"'{other}'; an outline is drawn in one plane z = constant"
        )
