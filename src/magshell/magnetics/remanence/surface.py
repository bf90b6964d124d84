"""Along the surface: a direction laid into the tangent plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.remanence.inside import find
from magshell.magnetics.remanence.vectors import Remanence, direction, first_element
from magshell.magnetics.remanence.way import MAGNITUDE, Way
from magshell.remembered import remembered

if TYPE_CHECKING:
    from magshell.mesh import Mesh

NORMAL = 1e-6


@remembered
def tangential(magnitude: float, along: ArrayLike) -> Remanence:
    """In the surface, along the projection of a direction onto its tangent plane.

    Parameters
    ----------
    magnitude : float
        T.
    along : array_like, shape (3,)
        The direction.

    Raises
    ------
    InputError
        When used: the direction is normal to the surface at a point.
    """
    wanted = direction("along", along)

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        A = find(mesh, points).slopes(mesh.points[mesh.elements])
        normal = np.cross(A[:, :, 0], A[:, :, 1])
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        inside = wanted - (normal @ wanted)[..., None] * normal
        length = np.linalg.norm(inside, axis=-1, keepdims=True)
        bad = length[..., 0] < NORMAL
        if bad.any():
            raise InputError(
                f"remanence: the direction {wanted.tolist()} is normal to the surface in element "
                f"{first_element(bad)}; it has no part in the surface there"
            )
        return np.asarray(magnitude * inside / length)

    return sample


TANGENTIAL = Way(
    lambda magnitude, direction: tangential(magnitude, direction),
    {
        "magnitude": MAGNITUDE,
        "direction": Key("Direction", "Laid into the tangent plane of the surface at every point."),
    },
    lambda magnitude, direction: f"in the surface, along {wording.vector(direction)}",
    in_space=True,
)
