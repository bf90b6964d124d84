"""Which outlines bound material, which are holes, and which lines are groups of edges."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, NoReturn

import numpy as np

from magshell.errors import InputError, suggest
from magshell.mesh.drawings.joining import Chain, Joined
from magshell.mesh.drawings.pieces import Piece

if TYPE_CHECKING:
    from shapely import Polygon

SAME = 5e-4
"""Of the smaller area: outlines overlap by less, or all but this, where they only touch or one lies in the other."""
NEAR = 2e-4
"""Of the size: lines closer than this lie on one another."""
WIDEST = 0.05
"""Of the size: wider gaps are not meant to be closed."""
MOST_OUTLINES = 2000


class Face(NamedTuple):
    """An area of material."""

    outline: Chain
    cut: tuple[Chain, ...]
    """Holes in it."""
    group: str
    depth: int
    """How many areas it lies in: what lies deeper has its own group only."""


@dataclass(frozen=True, eq=False)
class Plan:
    """What is to be meshed.

    Attributes
    ----------
    faces : list of Face
        By depth.
    edges : dict of str to list of Piece
        Named curves.
    marks : list of Chain
        Lines on the outlines, at whose ends these are divided, and cuts.
    size, area : float
        Diagonal, mm, and area, mm².
    notes : tuple of str
    """

    faces: list[Face]
    edges: dict[str, list[Piece]]
    marks: list[Chain]
    size: float
    area: float
    notes: tuple[str, ...]


def planned(joined: Joined, holes: Sequence[str] | None, cuts: Sequence[str] = ()) -> Plan:
    """Sort outlines by what contains what.

    An outline inside of another on its own layer is a hole, and one inside of that is material again. On another layer
    it is an area of its own, with the layer's name, or a hole if that layer is among `holes`. Open lines lie on
    outlines, or are on a layer among `cuts`.

    Raises
    ------
    InputError
        An outline is open, crosses itself or another, or encloses nothing; no such layer.
    """
    holes = holes or ()
    notes = list(joined.notes)
    layers = {piece.layer for chain in (*joined.outlines, *joined.open) for piece in chain.pieces}
    for layer in holes:
        if layer not in layers:
            raise InputError(f"holes: there is no layer '{layer}' with lines. {suggest(layer, layers)}")
    if not joined.outlines:
        _refuse_open(joined, joined.open[0])
    if len(joined.outlines) > MOST_OUTLINES:
        raise InputError(f"draws {len(joined.outlines)} outlines; at most {MOST_OUTLINES} can be meshed")
    outlines, polygons = _sorted(joined, notes)
    parents = _parents(outlines, polygons)
    solid: list[bool] = []
    for chain, parent in zip(outlines, parents, strict=True):
        if parent < 0:
            solid.append(chain.layer not in holes)
        elif chain.layer == outlines[parent].layer:
            solid.append(not solid[parent] and chain.layer not in holes)
        else:
            solid.append(chain.layer not in holes)
    if not any(solid):
        raise InputError("draws nothing but holes: leave a layer out of `holes`")
    faces = []
    for number, chain in enumerate(outlines):
        if solid[number]:
            inside = [
                outlines[other]
                for other in range(len(outlines))
                if not solid[other] and _cuts(other, number, parents, solid)
            ]
            faces.append(Face(chain, tuple(inside), chain.layer, len(_ancestors(number, parents))))
    areas = {
        outlines[number].layer
        for number, parent in enumerate(parents)
        if solid[number] and parent >= 0 and solid[parent]
    }
    if areas:
        listed = ", ".join(f"'{layer}'" for layer in sorted(areas))
        notes.append(
            f"outlines on {listed} inside of others: areas of the sheet (list the layer in `holes` to cut them)"
        )
    marks = _marks(joined, outlines, cuts, notes)
    area = sum(
        (1.0 if solid[number] else -1.0) * polygons[number].area
        for number, parent in enumerate(parents)
        if (solid[number] and (parent < 0 or not solid[parent]))
        or (not solid[number] and parent >= 0 and solid[parent])
    )
    return Plan(
        sorted(faces, key=lambda face: face.depth),
        _edges(outlines, solid, marks),
        marks,
        joined.size,
        area,
        tuple(notes),
    )


def _sorted(joined: Joined, notes: list[str]) -> tuple[list[Chain], list[Polygon]]:
    """Outlines and their polygons, the largest first, without repetitions."""
    from shapely import Polygon
    from shapely.validation import explain_validity

    pairs = []
    for chain in joined.outlines:
        polygon = Polygon(chain.fine())
        if polygon.is_valid and polygon.area <= (NEAR * joined.size) ** 2:
            x, y = chain.begin
            raise InputError(f"layer '{chain.layer}': the outline at ({x:.6g}, {y:.6g}) mm encloses no area")
        if not polygon.is_valid:
            where = explain_validity(polygon).partition("[")[2].rstrip("]").split()
            raise InputError(
                f"layer '{chain.layer}': an outline crosses or touches itself"
                + (f" at ({float(where[0]):.6g}, {float(where[1]):.6g}) mm" if len(where) >= 2 else "")
            )
        pairs.append((chain, polygon))
    pairs.sort(key=lambda pair: -pair[1].area)
    kept: list[tuple[Chain, Polygon]] = []
    twice = 0
    for chain, polygon in pairs:
        same = [
            other
            for other, there in kept
            if other.layer == chain.layer
            and there.area * (1.0 - SAME) <= polygon.area
            and there.intersection(polygon).area >= (1.0 - SAME) * there.area
        ]
        twice += bool(same)
        if not same:
            kept.append((chain, polygon))
    if twice:
        notes.append(f"{twice} outline{'s' * (twice > 1)} left out, drawn twice")
    return [chain for chain, _ in kept], [polygon for _, polygon in kept]


def _parents(outlines: list[Chain], polygons: list[Polygon]) -> list[int]:
    """Number of the least outline that contains each; -1: none does."""
    from shapely import STRtree

    tree = STRtree(polygons)
    parents = []
    for number, polygon in enumerate(polygons):
        parent = -1
        for other in sorted(int(each) for each in tree.query(polygon)):
            if other >= number:
                break
            common = polygon.intersection(polygons[other]).area
            if common >= (1.0 - SAME) * polygon.area:
                parent = other
            elif common > SAME * polygon.area:
                crossing = polygon.boundary.intersection(polygons[other].boundary).representative_point()
                layers = list(dict.fromkeys([outlines[other].layer, outlines[number].layer]))
                where = "layers '{}' and '{}'" if len(layers) > 1 else "layer '{}'"
                raise InputError(
                    f"{where.format(*layers)}: two outlines cross at "
                    f"({crossing.x:.6g}, {crossing.y:.6g}) mm; they may touch, or one may lie in the other"
                )
        parents.append(parent)
    return parents


def _ancestors(number: int, parents: list[int]) -> list[int]:
    found = []
    while (number := parents[number]) >= 0:
        found.append(number)
    return found


def _cuts(hole: int, face: int, parents: list[int], solid: list[bool]) -> bool:
    """Whether a hole lies in a face, with nothing but material between."""
    for other in _ancestors(hole, parents):
        if not solid[other]:
            return False
        if other == face:
            return True
    return False


def _marks(joined: Joined, outlines: list[Chain], cuts: Sequence[str], notes: list[str]) -> list[Chain]:
    """Open lines that lie on outlines, and cuts; of layers of their own."""
    from shapely import LineString, MultiLineString

    if not joined.open:
        return []
    borders = MultiLineString([chain.fine() for chain in outlines]).buffer(max(NEAR * joined.size, joined.gap))
    marks = []
    for chain in joined.open:
        if chain.layer not in cuts and not borders.contains(LineString(chain.fine())):
            _refuse_open(joined, chain, cut=True)
        if any(chain.layer == outline.layer for outline in outlines):
            notes.append(f"layer '{chain.layer}': a line on an outline of its own layer left out")
        else:
            marks.append(chain)
    return marks


def _refuse_open(joined: Joined, chain: Chain, cut: bool = False) -> NoReturn:
    """Say where a line ends, and what is nearest to its end; and whether it may be a cut."""
    ends = np.array([end for other in joined.open for end in (other.begin, other.end)])
    distance = np.linalg.norm(ends - chain.end, axis=1)
    distance[[2 * number + 1 for number, other in enumerate(joined.open) if other is chain]] = np.inf
    begin, end, gap = chain.begin, chain.end, 1.05 * float(distance.min())
    advice = "Close it"
    if gap < WIDEST * joined.size:
        advice += f', or let gaps be closed: gap = "{gap:.2g} mm" reaches to the nearest other end'
    if cut:
        advice += (
            f"; if the sheet is cut along it, name its layer: cuts = [{json.dumps(chain.layer, ensure_ascii=False)}]"
        )
    raise InputError(
        f"layer '{chain.layer}': an outline is open: it begins at ({begin[0]:.6g}, {begin[1]:.6g}) and ends at "
        f"({end[0]:.6g}, {end[1]:.6g}) mm. {advice}"
    )


def _edges(outlines: list[Chain], solid: list[bool], marks: list[Chain]) -> dict[str, list[Piece]]:
    """Groups of edges: of a layer, of a hole, and those marked by lines of other layers."""
    edges: dict[str, list[Piece]] = {}
    material = {chain.layer for chain, full in zip(outlines, solid, strict=True) if full}
    hole = 0
    for chain, full in zip(outlines, solid, strict=True):
        for piece in chain.pieces:
            own = f"{piece.layer}-edges" if piece.layer in material else piece.layer
            edges.setdefault(own, []).append(piece)
        if not full:
            hole += 1
            edges[f"hole-{hole}"] = list(chain.pieces)
    for mark in marks:
        edges.setdefault(mark.layer, []).extend(mark.pieces)
    return edges
