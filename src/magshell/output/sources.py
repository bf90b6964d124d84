"""Magnets and coils to scale where they are for given amounts, and a field on a plane as arrows or lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields import Field, MagnetField, Source
from magshell.magnetics.fields.field import known
from magshell.mesh.geometry import unit
from magshell.output.style import COLOURS

NORTH, SOUTH, COPPER = COLOURS[1], COLOURS[0], "#b87333"
GAP = 0.62
"""Length of an arrow over the distance between two."""
REACH = 5.0
"""How far from the middle of a part a picture of it goes to hold a source, over the part's size."""


class Piece(NamedTuple):
    """A surface of one colour.

    Attributes
    ----------
    surface : pyvista.PolyData
        In its place, m.
    colour : str
        Of the half at the north pole, the half at the south pole, or a coil.
    name : str
        Of the field that it belongs to.
    """

    surface: Any
    colour: str
    name: str


def pieces(field: Field, amounts: FloatArray) -> list[Piece]:
    """The surfaces of all magnets and coils of a field for given amounts; magnets are cut between their poles."""
    return [
        piece
        for part, own in field.parts(amounts)
        if isinstance(part, MagnetField)
        for source in part.now(own)
        for piece in of_source(source, part.name)
    ]


def of_source(source: Source, name: str) -> Iterator[Piece]:
    """The surfaces of one magnet or coil."""
    surface, poles = source.shape.surface(), source.shape.poles
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = source.turn, source.place
    if poles is None:
        yield Piece(surface.transform(place, inplace=False), COPPER, name)
        return
    middle = np.asarray(surface.center)
    for colour, invert in ((NORTH, False), (SOUTH, True)):
        half = surface.clip(normal=poles, origin=middle, invert=invert)
        yield Piece(half.extract_surface(algorithm="dataset_surface").transform(place, inplace=False), colour, name)


def place(plotter: Any, drawn: Iterable[Piece], opacity: float = 1.0) -> None:
    """Add surfaces of magnets and coils to a plotter."""
    for piece in drawn:
        plotter.add_mesh(piece.surface, color=piece.colour, ambient=0.55, specular=0.15, opacity=opacity)


def extent(drawn: Iterable[Piece], part: FloatArray) -> FloatArray:
    """Points (n, 3) of surfaces that a picture of a part, seen from its points (m, 3), must hold: none far away."""
    middle = 0.5 * (part.min(axis=0) + part.max(axis=0))
    size = float(np.linalg.norm(np.ptp(part, axis=0)))
    points = np.concatenate([np.zeros((0, 3)), *(np.asarray(piece.surface.points, dtype=float) for piece in drawn)])
    return np.asarray(points[np.linalg.norm(points - middle, axis=1) < REACH * size])


@dataclass(frozen=True, eq=False)
class Plane:
    """A rectangle on which a field is drawn.

    Parameters
    ----------
    corner : array_like, shape (3,)
        m.
    first, second : array_like, shape (3,)
        Its sides, at right angles to each other, m.
    points : int
        Along its longer side.

    Raises
    ------
    InputError
        Sides without length, or not at right angles.
    """

    corner: ArrayLike
    first: ArrayLike
    second: ArrayLike
    points: int = 40

    def __post_init__(self) -> None:
        sides = self.sides
        lengths = np.linalg.norm(sides, axis=1)
        if not np.isfinite(sides).all() or not lengths.all():
            raise InputError("plane: its sides must be finite and have a length")
        if abs(sides[0] @ sides[1]) > 1e-6 * lengths[0] * lengths[1]:
            raise InputError("plane: its sides must be at right angles to each other")
        if self.points < 2:
            raise InputError(f"plane: points is {self.points}; it needs at least 2 along a side")

    @property
    def sides(self) -> FloatArray:
        """Both sides (2, 3)."""
        return np.array([self.first, self.second], dtype=float)

    @property
    def counts(self) -> tuple[int, int]:
        """Number of points along each side."""
        lengths = np.linalg.norm(self.sides, axis=1)
        one, other = (max(2, round(self.points * length / lengths.max())) for length in lengths)
        return one, other

    def grid(self) -> FloatArray:
        """The points (n1 n2, 3), the first side fastest."""
        one, other = (np.linspace(0.0, 1.0, count) for count in self.counts)
        shares = np.stack([np.tile(one, len(other)), np.repeat(other, len(one))], axis=1)
        return np.asarray(np.asarray(self.corner, dtype=float) + shares @ self.sides)


def outside(field: Field, amounts: FloatArray, points: FloatArray) -> FloatArray:
    """B (n, 3) at points (n, 3), T; NaN inside magnets and where the field is not known."""
    B = known(field, amounts, points)
    for part, own in field.parts(amounts):
        if isinstance(part, MagnetField):
            for source in part.now(own):
                B[source.shape.inside(source.local(points))] = np.nan
    return B


def arrows(field: Field, amounts: FloatArray, plane: Plane) -> Any:
    """Arrows of equal length along B at the points of a plane, with the point array `B` (its magnitude, T).

    There is none where the field is zero or not known, nor inside magnets.

    Returns
    -------
    pyvista.PolyData
    """
    import pyvista

    points = plane.grid()
    B = outside(field, amounts, points)
    shown = np.linalg.norm(B, axis=1) > 0.0
    if not shown.any():
        return pyvista.PolyData()
    points, B = points[shown], B[shown]
    cloud = pyvista.PolyData(points)
    cloud["direction"], cloud["B"] = unit(B), np.linalg.norm(B, axis=1)
    lengths = np.linalg.norm(plane.sides, axis=1)
    length = GAP * min(side / (count - 1) for side, count in zip(lengths, plane.counts, strict=True))
    arrow = pyvista.Arrow(start=(-0.5, 0.0, 0.0), tip_length=0.35, tip_radius=0.14, shaft_radius=0.045)
    return cloud.glyph(orient="direction", scale=False, factor=length, geom=arrow)


def streamlines(field: Field, amounts: FloatArray, plane: Plane, density: float = 1.5) -> Any:
    """Lines along the part of B that lies in a plane, with the point array `B`, the magnitude of all of B, T.

    Parameters
    ----------
    density : float
        Of lines; 1 leaves about 1/30 of the longer side between them.

    Returns
    -------
    pyvista.PolyData
    """
    import pyvista
    from matplotlib.figure import Figure

    lengths = np.linalg.norm(plane.sides, axis=1)
    axes = plane.sides / lengths[:, None]
    B = known(field, amounts, plane.grid())
    one, other = (np.linspace(0.0, length, count) for length, count in zip(lengths, plane.counts, strict=True))
    along = unit(B @ axes.T).reshape(len(other), len(one), 2)
    drawn = (
        Figure()
        .subplots()
        .streamplot(
            one, other, along[..., 0], along[..., 1], density=tuple(density * lengths / lengths.max()), minlength=0.05
        )
    )
    paths = drawn.lines.get_segments()
    points = np.asarray(plane.corner, dtype=float) + np.concatenate([np.zeros((0, 2)), *paths]) @ axes
    starts = np.cumsum([0, *map(len, paths)])
    lines = [
        number
        for path, start in zip(paths, starts, strict=False)
        for number in (len(path), *range(start, start + len(path)))
    ]
    found = pyvista.PolyData(points, lines=np.array(lines, dtype=int))
    found["B"] = np.linalg.norm(known(field, amounts, points), axis=1)
    return found
