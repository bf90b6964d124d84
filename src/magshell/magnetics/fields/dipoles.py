r"""The sphere and the dipole, whose derivatives are exact.

With the moment m, the vector r from the middle and k = μ0 / 4π (for a sphere of radius a k m = a³ J / 3, and
B = 2 J / 3 inside),

    B_i = k [3 (m·r) r_i / r⁵ − m_i / r³].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.keys import Key
from magshell.magnetics.fields.field import Values
from magshell.magnetics.fields.magnets import FACETS, POLARISATION, VACUUM_PERMEABILITY, Magnet, of_ours
from magshell.magnetics.fields.shapes import Shape
from magshell.units import LENGTH, MAGNETIC_MOMENT, show
from magshell.wording import quantity

MARK = 1e-3
"""Radius of the ball that stands for a dipole in pictures, m."""


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
