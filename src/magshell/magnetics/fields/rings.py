"""Ring magnets, whole or from angle to angle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.magnets import FACETS, HEIGHT, POLARISATION, Magnet
from magshell.magnetics.fields.shapes import distance_from_box, meridian
from magshell.units import ANGLE, LENGTH, show


@dataclass(frozen=True, eq=False)
class Ring(Magnet):
    """A cylinder with a coaxial hole: two cylinders, the inner one of opposite polarisation.

    Parameters
    ----------
    inner_diameter, outer_diameter, height : float
        m.
    polarisation : array_like, shape (3,)
        T.
    """

    inner_diameter: float
    outer_diameter: float
    height: float
    polarisation: ArrayLike
    kind: ClassVar[str] = "ring"
    keys: ClassVar = {
        "inner_diameter": Key("PositiveLength", "Of the hole."),
        "outer_diameter": Key("PositiveLength", "Across."),
        "height": HEIGHT,
        "polarisation": POLARISATION,
    }

    def __post_init__(self) -> None:
        self._positive("inner_diameter", "outer_diameter", "height")
        _check_inner(self)
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return float(0.5 * np.hypot(self.outer_diameter, self.height))

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Cylinder as Body

        diameters = ((1.0, self.outer_diameter), (-1.0, self.inner_diameter))
        return [
            (sign, Body(dimension=(diameter, self.height), polarization=self.polarisation))
            for sign, diameter in diameters
        ]

    def _signed(self, points: FloatArray) -> FloatArray:
        return _distance_from_section(meridian(points), self)

    def distance(self, points: FloatArray) -> FloatArray:
        return np.abs(self._signed(points))

    def inside(self, points: FloatArray) -> AnyArray:
        return np.asarray(self._signed(points) < 0.0)

    def surface(self) -> Any:
        return _turned_section(self, 0.0, 2.0 * np.pi)

    def words(self) -> str:
        return f"ring {_span(self)}, {self.given}"


@dataclass(frozen=True, eq=False)
class CylinderSegment(Magnet):
    """A part of a ring between two angles.

    Parameters
    ----------
    inner_diameter, outer_diameter, height : float
        m; the inner diameter may be 0.
    angles : array_like, shape (2,)
        About its third axis from the first, rad; the second is larger, by less than a full turn.
    polarisation : array_like, shape (3,)
        Along its axes, T.
    """

    inner_diameter: float
    outer_diameter: float
    height: float
    angles: ArrayLike
    polarisation: ArrayLike
    kind: ClassVar[str] = "cylinder-segment"
    keys: ClassVar = {
        "inner_diameter": Key("NonNegativeLength", "May be 0."),
        "outer_diameter": Key("PositiveLength", "Across."),
        "height": HEIGHT,
        "angles": Key("Sector", "From where to where, about its third axis from the first."),
        "polarisation": POLARISATION,
    }

    def __post_init__(self) -> None:
        self._positive("outer_diameter", "height")
        if self.inner_diameter:
            self._positive("inner_diameter")
        _check_inner(self)
        start, end = self._numbers("angles", (2,))
        if not 0.0 < end - start < 2.0 * np.pi:
            raise InputError(
                f"cylinder-segment: angles are {show(start, ANGLE)} and {show(end, ANGLE)}; the second must be larger, "
                "by less than 360 deg (a full turn is a ring or a cylinder)"
            )
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return float(0.5 * np.hypot(self.outer_diameter, self.height))

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import CylinderSegment as Body

        start, end = np.rad2deg(np.asarray(self.angles))
        dimension = (0.5 * self.inner_diameter, 0.5 * self.outer_diameter, self.height, start, end)
        return [(1.0, Body(dimension=dimension, polarization=self.polarisation))]

    def _within(self, points: FloatArray) -> AnyArray:
        start, end = np.asarray(self.angles)
        return np.asarray(np.mod(np.arctan2(points[:, 1], points[:, 0]) - start, 2.0 * np.pi) < end - start)

    def distance(self, points: FloatArray) -> FloatArray:
        ring = np.abs(_distance_from_section(meridian(points), self))
        least = np.where(self._within(points), ring, np.inf)
        for angle in np.asarray(self.angles):
            along = points[:, 0] * np.cos(angle) + points[:, 1] * np.sin(angle)
            across = points[:, 1] * np.cos(angle) - points[:, 0] * np.sin(angle)
            flat = np.maximum(_distance_from_section(np.stack([along, points[:, 2]], axis=1), self), 0.0)
            least = np.minimum(least, np.hypot(flat, across))
        return least

    def inside(self, points: FloatArray) -> AnyArray:
        return self._within(points) & (_distance_from_section(meridian(points), self) < 0.0)

    def surface(self) -> Any:
        return _turned_section(self, *np.asarray(self.angles))

    def words(self) -> str:
        start, end = (show(angle, ANGLE) for angle in np.asarray(self.angles))
        return f"cylinder segment {_span(self)}, {start} to {end}, {self.given}"


def _check_inner(ring: Ring | CylinderSegment) -> None:
    if not 0.0 <= ring.inner_diameter < ring.outer_diameter:
        raise InputError(
            f"{ring.kind}: inner_diameter is {show(ring.inner_diameter, LENGTH)}, outer_diameter "
            f"{show(ring.outer_diameter, LENGTH)}; the inner must be the smaller one"
        )


def _distance_from_section(places: FloatArray, ring: Ring | CylinderSegment) -> FloatArray:
    """Signed distance of places (n, 2), radius and height, from the section of a ring."""
    inner, outer = 0.5 * ring.inner_diameter, 0.5 * ring.outer_diameter
    middle, half = 0.5 * (outer + inner), 0.5 * (outer - inner)
    return distance_from_box(places - [middle, 0.0], np.array([half, 0.5 * ring.height]))


def _span(ring: Ring | CylinderSegment) -> str:
    sizes = (show(one, LENGTH) for one in (ring.inner_diameter, ring.outer_diameter, ring.height))
    return "⌀ {} to {} × {}".format(*sizes)


def _turned_section(ring: Ring | CylinderSegment, start: float, end: float) -> Any:
    """The surface of a ring from angle to angle."""
    import pyvista

    radii = np.array([ring.inner_diameter, ring.outer_diameter]) / 2.0
    angles = np.linspace(start, end, max(3, round(FACETS * (end - start) / (2.0 * np.pi))) + 1)
    heights = np.array([-0.5, 0.5]) * ring.height
    r, angle, z = np.meshgrid(radii, angles, heights, indexing="ij")
    grid = pyvista.StructuredGrid(r * np.cos(angle), r * np.sin(angle), z)
    return grid.extract_surface(algorithm="dataset_surface").clean()
