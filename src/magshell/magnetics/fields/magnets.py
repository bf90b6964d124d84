"""Permanent magnets with a uniform polarisation J = μ0 M.

The dipole and the sphere have exact derivatives. With the moment m, the vector r from the middle and k = μ0 / 4π (for a
sphere of radius a k m = a³ J / 3, and B = 2 J / 3 inside),

    B_i = k [3 (m·r) r_i / r⁵ − m_i / r³].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.field import Values
from magshell.magnetics.fields.shapes import Shape, distance_from_box, meridian
from magshell.units import ANGLE, LENGTH, MAGNETIC_MOMENT, REMANENCE, show
from magshell.wording import quantity

VACUUM_PERMEABILITY = 4e-7 * np.pi
POLARISATION = Key(
    "Polarisation", "J = μ0 M along the magnet's own axes, in T, or M in A/m; a magnet's data sheet calls it remanence."
)
HEIGHT = Key("PositiveLength", "Along its third axis.")
FACETS = 72
"""Sides of round surfaces in pictures."""


class Magnet(Shape):
    """A body with a uniform polarisation."""

    polarisation: ArrayLike

    @property
    def given(self) -> str:
        return f"polarisation {quantity(tuple(np.asarray(self.polarisation).tolist()), REMANENCE)}"

    @property
    def poles(self) -> FloatArray:
        return np.asarray(self.polarisation)


@dataclass(frozen=True, eq=False)
class Cuboid(Magnet):
    """A rectangular block.

    Parameters
    ----------
    sides : array_like, shape (3,)
        Lengths along its axes, m.
    polarisation : array_like, shape (3,)
        T.
    """

    sides: ArrayLike
    polarisation: ArrayLike
    kind: ClassVar[str] = "cuboid"
    keys: ClassVar = {"sides": Key("Sides", "Lengths along its own axes."), "polarisation": POLARISATION}

    def __post_init__(self) -> None:
        if np.any(self._numbers("sides", (3,)) <= 0.0):
            raise InputError(f"cuboid: sides are {np.asarray(self.sides).tolist()} m; all must be positive")
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return float(0.5 * np.linalg.norm(self.sides))

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Cuboid as Body

        return [(1.0, Body(dimension=self.sides, polarization=self.polarisation))]

    def distance(self, points: FloatArray) -> FloatArray:
        return np.abs(distance_from_box(points, 0.5 * np.asarray(self.sides)))

    def inside(self, points: FloatArray) -> AnyArray:
        return np.asarray(distance_from_box(points, 0.5 * np.asarray(self.sides)) < 0.0)

    def surface(self) -> Any:
        import pyvista

        x, y, z = np.asarray(self.sides)
        return pyvista.Cube(x_length=x, y_length=y, z_length=z)

    def words(self) -> str:
        sides = " × ".join(show(side, LENGTH) for side in np.asarray(self.sides))
        return f"cuboid {sides}, {self.given}"


@dataclass(frozen=True, eq=False)
class Cylinder(Magnet):
    """A round cylinder about its third axis.

    Parameters
    ----------
    diameter, height : float
        m.
    polarisation : array_like, shape (3,)
        T.
    """

    diameter: float
    height: float
    polarisation: ArrayLike
    kind: ClassVar[str] = "cylinder"
    keys: ClassVar = {"diameter": Key("PositiveLength", "Across."), "height": HEIGHT, "polarisation": POLARISATION}

    def __post_init__(self) -> None:
        self._positive("diameter", "height")
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return float(0.5 * np.hypot(self.diameter, self.height))

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Cylinder as Body

        return [(1.0, Body(dimension=(self.diameter, self.height), polarization=self.polarisation))]

    def _signed(self, points: FloatArray) -> FloatArray:
        return distance_from_box(meridian(points), 0.5 * np.array([self.diameter, self.height]))

    def distance(self, points: FloatArray) -> FloatArray:
        return np.abs(self._signed(points))

    def inside(self, points: FloatArray) -> AnyArray:
        return np.asarray(self._signed(points) < 0.0)

    def surface(self) -> Any:
        import pyvista

        return pyvista.Cylinder(direction=(0, 0, 1), radius=0.5 * self.diameter, height=self.height, resolution=FACETS)

    def words(self) -> str:
        return f"cylinder ⌀ {show(self.diameter, LENGTH)} × {show(self.height, LENGTH)}, {self.given}"


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


@dataclass(frozen=True, eq=False)
class Sphere(Magnet):
    """A ball.

    Parameters
    ----------
    diameter : float
        m.
    polarisation : array_like, shape (3,)
        T.
    """

    diameter: float
    polarisation: ArrayLike
    kind: ClassVar[str] = "sphere"
    keys: ClassVar = {"diameter": Key("PositiveLength", "Across."), "polarisation": POLARISATION}

    def __post_init__(self) -> None:
        self._positive("diameter")
        self._vector("polarisation", "magnet")

    @property
    def size(self) -> float:
        return 0.5 * self.diameter

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.magnet import Sphere as Body

        return [(1.0, Body(diameter=self.diameter, polarization=self.polarisation))]

    def values(self, points: FloatArray, second: bool) -> Values:
        J, inside = np.asarray(self.polarisation), self.inside(points)
        moment = J * self.size**3 / 3.0
        away = np.where(inside[:, None], self.size, points)
        B, gradient, twice = dipole(moment, away, second)
        B[inside], gradient[inside] = 2.0 * J / 3.0, 0.0
        if twice is not None:
            twice[inside] = 0.0
        return Values(B, gradient, twice)

    def distance(self, points: FloatArray) -> FloatArray:
        return np.abs(np.linalg.norm(points, axis=1) - self.size)

    def inside(self, points: FloatArray) -> AnyArray:
        return np.asarray(np.linalg.norm(points, axis=1) < self.size)

    def surface(self) -> Any:
        import pyvista

        return pyvista.Sphere(radius=self.size, theta_resolution=FACETS, phi_resolution=FACETS // 2)

    def words(self) -> str:
        return f"sphere ⌀ {show(self.diameter, LENGTH)}, {self.given}"


@dataclass(frozen=True, eq=False)
class Dipole(Shape):
    """A point with a magnetic moment: any magnet seen from afar.

    Parameters
    ----------
    moment : array_like, shape (3,)
        A m²; of a magnet its polarisation times its volume over μ0.
    """

    moment: ArrayLike
    kind: ClassVar[str] = "dipole"
    keys: ClassVar = {"moment": Key("MagneticMoment", "Along its own axes; of a magnet its magnetisation × volume.")}

    def __post_init__(self) -> None:
        self._vector("moment", "dipole")

    @property
    def size(self) -> float:
        return 0.0

    def bodies(self) -> Sequence[tuple[float, Any]]:
        from magpylib.misc import Dipole as Body

        return [(of_ours(), Body(moment=self.moment))]

    def values(self, points: FloatArray, second: bool) -> Values:
        return dipole(VACUUM_PERMEABILITY / (4.0 * np.pi) * np.asarray(self.moment), points, second)

    def distance(self, points: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(points, axis=1))

    @property
    def poles(self) -> FloatArray:
        return np.asarray(self.moment)

    def surface(self) -> Any:
        import pyvista

        return pyvista.Sphere(radius=MARK, theta_resolution=24, phi_resolution=12)

    def words(self) -> str:
        return f"dipole {quantity(tuple(np.asarray(self.moment).tolist()), MAGNETIC_MOMENT)}"


MARK = 1e-3
"""Radius of the ball that stands for a dipole in pictures, m."""


def of_ours() -> float:
    """The μ0 of this package, 4π·1e-7, over that of magpylib (CODATA, 1e-10 less)."""
    from magpylib import mu_0

    return float(VACUUM_PERMEABILITY / mu_0)


def dipole(moment: FloatArray, points: FloatArray, second: bool) -> Values:
    """The field of a dipole of a moment times μ0 / 4π (3,), T m³, at the origin; not finite there."""
    square = np.einsum("pi,pi->p", points, points)
    eye = np.eye(3)
    with np.errstate(divide="ignore", invalid="ignore"):
        r5 = square**-2.5
        mr, unit = points @ moment, points / square[:, None]
        B = r5[:, None] * (3.0 * mr[:, None] * points - square[:, None] * moment)
        linear = points[:, :, None] * moment + moment[:, None] * points[:, None, :] + mr[:, None, None] * eye
        gradient = r5[:, None, None] * (3.0 * linear - 15.0 * (mr[:, None] * points)[:, :, None] * unit[:, None, :])
        if not second:
            return Values(B, gradient, None)
        constant = eye[:, :, None] * moment + eye[:, None, :] * moment[:, None] + moment[:, None, None] * eye
        twice = np.einsum("pij,pk->pijk", linear, unit)
        twice += np.einsum("pi,pj,k->pijk", points, unit, moment)
        twice += np.einsum("p,pi,jk->pijk", mr, unit, eye) + np.einsum("p,pj,ik->pijk", mr, unit, eye)
        quartic = np.einsum("p,pi,pj,pk->pijk", mr, points, unit, unit)
        whole = r5[:, None, None, None] * (3.0 * constant - 15.0 * twice + 105.0 * quartic)
    return Values(B, gradient, whole)


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
