"""Coils: loops and polygons of wire, and windings as sheets of current.

The sheet of current about a cylinder or cuboid, N I / height per length, has exactly the field of a magnet of that
shape with the polarisation μ0 N I / height along the axis (B, not H, also inside), which magpylib has in closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import real
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.magnets import FACETS, VACUUM_PERMEABILITY, of_ours
from magshell.magnetics.fields.shapes import Shape, distance_from_segments, meridian
from magshell.units import CURRENT, LENGTH, show

CURRENT_KEY = Key("Current", "In the wire, at multiplier 1; positive turns from its first to its second axis.")
TURNS = Key("Count", "Windings.", "1")
LAYERS = Key("Count", "Of the winding, one about the other, with equal numbers of turns.", "1")
SPACING = Key("PositiveLength", "From layer to layer, outwards.", "none")
WINDING = {
    "height": Key("PositiveLength", "Along its third axis."),
    "current": CURRENT_KEY,
    "turns": Key("Count", "Windings of all layers together."),
    "layers": LAYERS,
    "spacing": SPACING,
}
"""Keys that windings of several layers have."""
WIRE = 0.02
"""Radius of a drawn wire over the size of the coil."""


class Coil(Shape):
    """Wire that carries a current."""

    current: float
    turns: int
    is_coil = True

    def _check_current(self) -> None:
        if not np.isfinite(real(f"{self.kind}: current", self.current, "a current (A)")) or not self.current:
            raise InputError(f"{self.kind}: current is {self.current!r} A; it must be finite and not zero")
        if not real(f"{self.kind}: turns", self.turns).is_integer() or self.turns < 1:
            raise InputError(f"{self.kind}: turns is {self.turns!r}; it must be a whole number, at least 1")

    @property
    def given(self) -> str:
        turns = "" if self.turns == 1 else f"{self.turns} turns, "
        return f"{turns}{show(self.current, CURRENT)}"


@dataclass(frozen=True, eq=False)
class Loop(Coil):
    """A circle of wire about its third axis.

    Parameters
    ----------
    diameter : float
        m.
    current : float
        A.
    turns : int
    """

    diameter: float
    current: float
    turns: int = 1
    kind: ClassVar[str] = "loop"
    keys: ClassVar = {
        "diameter": Key("PositiveLength", "Of the middle of the wire."),
        "current": CURRENT_KEY,
        "turns": TURNS,
    }

    def __post_init__(self) -> None:
        self._positive("diameter")
        self._check_current()

    @property
    def size(self) -> float:
        return 0.5 * self.diameter

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.current import Circle

        return [(of_ours(), Circle(diameter=self.diameter, current=self.turns * self.current))]

    def distance(self, points: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(meridian(points) - [self.size, 0.0], axis=1))

    def surface(self) -> Any:
        angle = np.linspace(0.0, 2.0 * np.pi, FACETS + 1)
        return wire(self.size * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1), WIRE * self.size)

    def words(self) -> str:
        return f"loop ⌀ {show(self.diameter, LENGTH)}, {self.given}"


@dataclass(frozen=True, eq=False)
class Polygon(Coil):
    """A closed polygon of wire.

    Parameters
    ----------
    corners : array_like, shape (n, 3)
        In the order of the current, m; the last is joined to the first.
    current : float
        A.
    turns : int
    """

    corners: ArrayLike
    current: float
    turns: int = 1
    kind: ClassVar[str] = "polygon"
    keys: ClassVar = {
        "corners": Key("Places", "In the order of the current; the last is joined to the first."),
        "current": Key("Current", "In the wire, at multiplier 1, from corner to corner."),
        "turns": TURNS,
    }

    def __post_init__(self) -> None:
        corners = self._numbers("corners", (None, 3))
        if len(corners) > 1 and np.array_equal(corners[0], corners[-1]):
            corners = corners[:-1]
            object.__setattr__(self, "corners", corners)
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
        if len(corners) < 3 or not sides.all():
            raise InputError("polygon: corners must be three or more, none the same as the next")
        self._check_current()

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.corners, axis=1).max())

    @property
    def _closed(self) -> FloatArray:
        corners = np.asarray(self.corners)
        return np.concatenate([corners, corners[:1]])

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.current import Polyline

        return [(of_ours(), Polyline(vertices=self._closed, current=self.turns * self.current))]

    def distance(self, points: FloatArray) -> FloatArray:
        return distance_from_segments(points, np.stack([self._closed[:-1], self._closed[1:]], axis=1))

    def surface(self) -> Any:
        return wire(self._closed, WIRE * self.size)

    def words(self) -> str:
        return f"polygon of {len(np.asarray(self.corners))} corners, {self.given}"


@dataclass(frozen=True, eq=False)
class Solenoid(Coil):
    """A round winding about its third axis, close enough to be a sheet of current.

    Parameters
    ----------
    diameter, height : float
        Of the (innermost) layer, m.
    current : float
        A.
    turns : int
        Of all layers together.
    layers : int
    spacing : float, optional
        From layer to layer, m; with several layers only.
    """

    diameter: float
    height: float
    current: float
    turns: int
    layers: int = 1
    spacing: float | None = None
    kind: ClassVar[str] = "solenoid"
    keys: ClassVar = {
        "diameter": Key("PositiveLength", "Of the innermost layer."),
        **WINDING,
    }

    def __post_init__(self) -> None:
        self._positive("diameter", "height")
        self._check_current()
        _check_layers(self)

    @property
    def size(self) -> float:
        return float(np.hypot(self._radii[-1], 0.5 * self.height))

    @property
    def _radii(self) -> FloatArray:
        return 0.5 * self.diameter + outwards(self)

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Cylinder

        along = (0.0, 0.0, sheet(self))
        return [(1.0, Cylinder(dimension=(2.0 * radius, self.height), polarization=along)) for radius in self._radii]

    def distance(self, points: FloatArray) -> FloatArray:
        ends = [[(radius, -0.5 * self.height), (radius, 0.5 * self.height)] for radius in self._radii]
        return distance_from_segments(meridian(points), np.array(ends))

    def surface(self) -> Any:
        import pyvista

        return pyvista.Cylinder(
            direction=(0, 0, 1), radius=self._radii[-1], height=self.height, resolution=FACETS, capping=False
        )

    def words(self) -> str:
        return f"solenoid ⌀ {show(self.diameter, LENGTH)} × {show(self.height, LENGTH)}{_layered(self)}, {self.given}"


@dataclass(frozen=True, eq=False)
class RectangularWinding(Coil):
    """A winding about a rectangle in its first and second axis, close enough to be a sheet of current.

    Parameters
    ----------
    sides : array_like, shape (2,)
        Of the (innermost) layer, along its first and second axis, m.
    height : float
        Along its third axis, m.
    current : float
        A.
    turns : int
        Of all layers together.
    layers : int
    spacing : float, optional
        From layer to layer, m; with several layers only.
    """

    sides: ArrayLike
    height: float
    current: float
    turns: int
    layers: int = 1
    spacing: float | None = None
    kind: ClassVar[str] = "rectangular"
    keys: ClassVar = {
        "sides": Key("PlaneSides", "Of the innermost layer, along its first and second axis."),
        **WINDING,
    }

    def __post_init__(self) -> None:
        if np.any(self._numbers("sides", (2,)) <= 0.0):
            raise InputError(f"rectangular: sides are {np.asarray(self.sides).tolist()} m; both must be positive")
        self._positive("height")
        self._check_current()
        _check_layers(self)

    @property
    def size(self) -> float:
        return float(np.linalg.norm([*self._halves[-1], 0.5 * self.height]))

    @property
    def _halves(self) -> FloatArray:
        """Half sides (layers, 2)."""
        return np.asarray(0.5 * np.asarray(self.sides) + outwards(self)[:, None])

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Cuboid

        along = (0.0, 0.0, sheet(self))
        return [(1.0, Cuboid(dimension=(*2.0 * half, self.height), polarization=along)) for half in self._halves]

    def distance(self, points: FloatArray) -> FloatArray:
        beyond = np.maximum(np.abs(points[:, 2]) - 0.5 * self.height, 0.0)
        least = np.full(len(points), np.inf)
        for x, y in self._halves:
            corners = np.array([(x, y), (-x, y), (-x, -y), (x, -y)])
            outline = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
            least = np.minimum(least, np.hypot(distance_from_segments(points[:, :2], outline), beyond))
        return least

    def surface(self) -> Any:
        import pyvista

        x, y = self._halves[-1]
        outline = np.array([(x, y), (-x, y), (-x, -y), (x, -y)])
        low, high = (np.insert(outline, 2, z, axis=1) for z in (-0.5 * self.height, 0.5 * self.height))
        faces = [[4, k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)]
        return pyvista.PolyData(np.concatenate([low, high]), np.array(faces).ravel())

    def words(self) -> str:
        x, y = np.asarray(self.sides)
        size = " × ".join(show(length, LENGTH) for length in (x, y, self.height))
        return f"rectangular winding {size}{_layered(self)}, {self.given}"


def wire(points: FloatArray, radius: float) -> Any:
    """A closed line of points (n, 3) as a tube, a `pyvista.PolyData`."""
    import pyvista

    return pyvista.MultipleLines(points).tube(radius=radius, n_sides=16)


def outwards(winding: Solenoid | RectangularWinding) -> FloatArray:
    """Distances (layers,) of the layers from the innermost one."""
    return (winding.spacing or 0.0) * np.arange(winding.layers, dtype=float)


def sheet(winding: Solenoid | RectangularWinding) -> float:
    """μ0 times the current per length of one layer, T."""
    return VACUUM_PERMEABILITY * winding.turns * winding.current / (winding.layers * winding.height)


def _check_layers(winding: Solenoid | RectangularWinding) -> None:
    layers = winding.layers
    if isinstance(layers, bool) or layers != int(layers) or layers < 1:
        raise InputError(f"{winding.kind}: layers is {layers!r}; it must be a whole number, at least 1")
    if (layers > 1) != (winding.spacing is not None):
        missing = "is missing" if layers > 1 else "makes no sense with one layer"
        raise InputError(f"{winding.kind}: spacing {missing}; it is the distance from layer to layer")
    if winding.spacing is not None:
        winding._positive("spacing")


def _layered(winding: Solenoid | RectangularWinding) -> str:
    return "" if winding.spacing is None else f" in {winding.layers} layers {show(winding.spacing, LENGTH)} apart"
