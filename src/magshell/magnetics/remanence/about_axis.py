"""Directions that an axis gives: along meridians, around the axis, away from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence, direction, flipped_towards, scaled, vector
from magshell.magnetics.remanence.way import MAGNITUDE, TOWARDS, Way
from magshell.remembered import remembered

if TYPE_CHECKING:
    from magshell.mesh import Mesh


@remembered
def meridional(magnitude: float, axis: ArrayLike = (0.0, 0.0, 1.0), mirrored: bool = True) -> Remanence:
    """Along the meridians of a sphere about the origin, pointing away from the pole on the +axis side.

    Parameters
    ----------
    magnitude : float
        T.
    axis : array_like, shape (3,)
        From the centre to the pole.
    mirrored : bool
        Reverse it below the equator, so that both halves are mirror images.
    """
    pole = direction("axis", axis)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        height = points @ pole
        radius = np.linalg.norm(points, axis=-1)
        along = points * (height / radius**2)[..., None] - pole
        sign = np.where(mirrored & (height < 0.0), -1.0, 1.0)
        return scaled(along, magnitude, "meridional") * sign[..., None]

    return sample


@remembered
def circumferential(magnitude: float, axis: ArrayLike = (0.0, 0.0, 1.0), towards: ArrayLike | None = None) -> Remanence:
    """Along the circles about an axis through the origin, in the sense axis × radius.

    Parameters
    ----------
    magnitude : float
        T.
    axis : array_like, shape (3,)
        Axis of the circles.
    towards : array_like, shape (3,), optional
        Where the component along this direction would be negative, the sign is flipped.
    """
    centre_line = direction("axis", axis)
    preferred = None if towards is None else direction("towards", towards)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        values = scaled(np.cross(centre_line, points), magnitude, "circumferential")
        return flipped_towards(values, preferred)

    return sample


@remembered
def radial(
    magnitude: float,
    axis: ArrayLike = (0.0, 0.0, 1.0),
    through: ArrayLike = (0.0, 0.0, 0.0),
    inward: bool = False,
) -> Remanence:
    """Away from an axis and normal to it.

    Parameters
    ----------
    magnitude : float
        T.
    axis : array_like, shape (3,)
        Direction of the axis.
    through : array_like, shape (3,)
        A point of the axis, m.
    inward : bool
        Towards the axis instead.
    """
    along, point = direction("axis", axis), vector("through", through)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        arm = points - point
        arm = arm - (arm @ along)[..., None] * along
        return scaled(arm, -magnitude if inward else magnitude, "radial")

    return sample


MERIDIONAL = Way(
    meridional,
    {
        "magnitude": MAGNITUDE,
        "axis": Key("Direction", "From the centre (the origin) to the pole that it points away from."),
        "mirrored": Key("Switch", "Whether it is reversed below the equator."),
    },
    lambda magnitude, axis, mirrored: (
        f"meridional, away from the pole {wording.vector(axis)}" + ", mirrored at the equator" * mirrored
    ),
    in_space=True,
)
CIRCUMFERENTIAL = Way(
    circumferential,
    {
        "magnitude": MAGNITUDE,
        "axis": Key("Direction", "Of the circles, through the origin; the sense is axis × radius."),
        "towards": TOWARDS,
    },
    lambda magnitude, axis, towards: (
        f"circumferential, about the axis {wording.vector(axis)}" + wording.towards(towards)
    ),
    in_space=True,
)
RADIAL = Way(
    radial,
    {
        "magnitude": MAGNITUDE,
        "axis": Key("Direction", "Direction of the axis."),
        "through": Key("Position", "A point of the axis."),
        "inward": Key("Switch", "Towards the axis instead of away from it."),
    },
    lambda magnitude, axis, through, inward: (
        f"radial, {'towards' if inward else 'away from'} the axis {wording.vector(axis)}"
    ),
    in_space=True,
)
