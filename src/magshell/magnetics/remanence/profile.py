"""Remanence that turns, or changes its magnitude, along a coordinate.

With the coordinate s = (X - X_0) · t along a direction $t$, the remanence is

    m(s) = M(s) (cos θ(s) e + sin θ(s) n),

where e is the direction at angle 0 and n that at 90°. θ and M are piecewise linear between given positions and constant
beyond the first and the last. A harmonic wave of length λ, m = M (cos(2πs/λ + φ) e + sin(2πs/λ + φ) n), is the straight
line from θ(0) = φ to θ(λ) = φ + 360°, continued as long as the part; alternating poles are a magnitude that changes its
sign. Neither needs a name of its own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence, direction, vector
from magshell.magnetics.remanence.way import Way
from magshell.remembered import remembered
from magshell.units import ANGLE, LENGTH, show

if TYPE_CHECKING:
    from magshell.mesh import Mesh

PARALLEL = 1e-6


@remembered
def profile(
    magnitudes: ArrayLike,
    positions: ArrayLike,
    along: ArrayLike,
    start: ArrayLike,
    angles: ArrayLike = 0.0,
    towards: ArrayLike | None = None,
    origin: ArrayLike = (0.0, 0.0, 0.0),
) -> Remanence:
    """Magnitude and angle of the remanence as tables over a coordinate.

    Parameters
    ----------
    magnitudes : array_like, shape () or (n,)
        M at the positions, T; may change sign.
    positions : array_like, shape (n,)
        s, m, rising.
    along : array_like, shape (3,)
        Direction of the coordinate.
    start : array_like, shape (3,)
        Direction at angle 0.
    angles : array_like, shape () or (n,)
        θ at the positions, rad; they may pass 2π, so that the remanence turns several times.
    towards : array_like, shape (3,), optional
        Into which a positive angle turns: at 90° the remanence has the direction of the part of this that is normal to
        `start`. Needed where an angle is not zero.
    origin : array_like, shape (3,)
        Where s is zero, m.

    Raises
    ------
    InputError
        Tables of different lengths, positions that do not rise, `towards` missing or parallel to `start`.
    """
    s = np.asarray(positions, dtype=float)
    if s.ndim != 1 or not len(s) or not np.isfinite(s).all() or np.any(np.diff(s) <= 0.0):
        raise InputError(f"remanence: positions are {s.tolist()}; they must be a list of finite numbers that rise")
    tables = []
    for name, values in (("magnitudes", magnitudes), ("angles", angles)):
        table = np.asarray(values, dtype=float)
        if table.ndim > 1 or table.size not in (1, len(s)) or not np.isfinite(table).all():
            raise InputError(f"remanence: {name} are {table.tolist()}; give one, or one for each of {len(s)} positions")
        tables.append(np.broadcast_to(table, s.shape))
    t, e, zero = direction("along", along), direction("start", start), vector("origin", origin)
    n = _normal_to(e, towards) if towards is not None else np.zeros(3)
    if towards is None and np.any(tables[1]):
        raise InputError("remanence: towards is missing; it says into which direction the angles turn the remanence")

    def sample(mesh: Mesh, points: FloatArray) -> FloatArray:
        at = (points - zero) @ t
        M, θ = (np.interp(at, s, table)[..., None] for table in tables)
        return np.asarray(M * (np.cos(θ) * e + np.sin(θ) * n))

    return sample


def _normal_to(e: FloatArray, towards: ArrayLike) -> FloatArray:
    n = direction("towards", towards)
    n = n - (n @ e) * e
    length = np.linalg.norm(n)
    if length < PARALLEL:
        raise InputError("remanence: towards is parallel to start; it says into which direction the remanence turns")
    return np.asarray(n / length)


def _from_keys(
    along: ArrayLike,
    positions: ArrayLike,
    magnitude: ArrayLike,
    direction: ArrayLike,
    angle: ArrayLike = (0.0,),
    towards: ArrayLike | None = None,
    origin: ArrayLike = (0.0, 0.0, 0.0),
) -> Remanence:
    return profile(magnitude, positions, along, direction, angle, towards, origin)


def _words(along: Sequence[float], positions: Sequence[float], angle: Sequence[float], **others: Any) -> str:
    words = f"over {show(positions[0], LENGTH)} to {show(positions[-1], LENGTH)} along {wording.vector(along)}"
    turned = max(angle) - min(angle)
    if turned:
        words += f", turning by {show(turned, ANGLE)}"
        if turned > 2.0 * math.pi:
            words += f" ({turned / (2.0 * math.pi):.4g} turns)"
    return words


PROFILE = Way(
    _from_keys,
    {
        "along": Key("Direction", "Direction of the coordinate $s$."),
        "positions": Key("Positions", "Values of $s$, rising."),
        "magnitude": Key(
            "Remanences", "At the positions, or one for all; linear between, constant beyond. May change sign."
        ),
        "direction": Key("Direction", "Of the remanence at angle 0."),
        "angle": Key(
            "Angles", "At the positions, or one for all; linear between, constant beyond. May pass 360°.", "0"
        ),
        "towards": Key("Direction", "Direction into which a positive angle turns; needed with an angle."),
        "origin": Key("Position", "Where $s = 0$."),
    },
    _words,
    in_space=True,
)
