"""Directions that an axis gives: along meridians, around the axis, away from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.magnetics.remanence.vectors import Remanence, direction, flipped_towards, scaled, vector

if TYPE_CHECKING:
    from magshell.mesh import Mesh


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
