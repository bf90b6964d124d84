"""Permanent magnets with a uniform polarisation J = μ0 M: what they share, blocks and cylinders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.shapes import Shape, distance_from_box, meridian
from magshell.units import LENGTH, REMANENCE, show
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


def of_ours() -> float:
    """The μ0 of this package, 4π·1e-7, over that of magpylib (CODATA, 1e-10 less)."""
    from magpylib import mu_0

    return float(VACUUM_PERMEABILITY / mu_0)
