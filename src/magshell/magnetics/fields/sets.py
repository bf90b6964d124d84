"""Sets of magnets and coils that laboratories build: they expand to single sources.

Coils of radius R about the third axis, with the current I in each (N turns; constants of B and gradient on the axis):

* Helmholtz: two loops R apart, alike: uniform, B = (4/5)^(3/2) μ0 N I / R;
* Maxwell: two loops √3 R apart, opposed: a gradient, ∂B3/∂x3 = (48/49) √(3/7) μ0 N I / R².

A Halbach ring is a circle of equal magnets in the plane of its first two axes whose polarisation turns by (k + 1) θ
along the angle θ: k = 1, 2, … has 2 k poles inside, k = 1 a field that is uniform there.
"""

from __future__ import annotations

from numbers import Integral

import numpy as np

from magshell.arguments import instance, real
from magshell.arrays import three_finite
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.coils import TURNS, Loop
from magshell.magnetics.fields.magnets import Cuboid
from magshell.magnetics.fields.sources import Source

MOST_MAGNETS = 1000
PAIR_KEYS = {
    "radius": Key("PositiveLength", "Of both loops."),
    "current": Key("Current", "In the wire, at multiplier 1."),
    "turns": TURNS,
}
HALBACH_KEYS = {
    "radius": Key("PositiveLength", "Of the circle of the magnets' middles."),
    "count": Key("Count", "Number of magnets."),
    "sides": Key("Sides", "Of each magnet: along the radius, along the circle, along the third axis."),
    "remanence": Key("PositiveRemanence", "Magnitude of the polarisation."),
    "order": Key("Count", "k: 1 for a uniform field inside, 2 for four poles, and so on.", "1"),
}


def helmholtz(radius: float, current: float, turns: int = 1) -> tuple[Source, ...]:
    """Two equal loops about the third axis, one radius apart: a uniform field between them.

    Parameters
    ----------
    radius : float
        m.
    current : float
        A.
    turns : int
        Of each loop.
    """
    real("helmholtz: radius", radius, "a length (m)")
    loop = Loop(2.0 * radius, current, turns)
    return tuple(Source(loop, (0.0, 0.0, place * radius)) for place in (-0.5, 0.5))


def maxwell(radius: float, current: float, turns: int = 1) -> tuple[Source, ...]:
    """Two opposed loops about the third axis, √3 radii apart: a uniform gradient between them.

    Parameters
    ----------
    radius : float
        m.
    current : float
        Of the upper loop, A.
    turns : int
        Of each loop.
    """
    real("maxwell: radius", radius, "a length (m)")
    real("maxwell: current", current, "a current (A)")
    half = 0.5 * np.sqrt(3.0) * radius
    pair = ((-1.0, -half), (1.0, half))
    return tuple(Source(Loop(2.0 * radius, sign * current, turns), (0.0, 0.0, place)) for sign, place in pair)


def halbach(
    radius: float, count: int, sides: tuple[float, float, float], remanence: float, order: int = 1
) -> tuple[Source, ...]:
    """A Halbach ring of cuboids about the third axis.

    Parameters
    ----------
    radius : float
        Of the circle of their middles, m.
    count : int
        Number of magnets.
    sides : (float, float, float)
        Of each, along the radius, along the circle and along the third axis, m.
    remanence : float
        Magnitude of the polarisation, T.
    order : int
        1 for a field that is uniform inside (along the first axis), 2 for four poles, and so on.

    Raises
    ------
    InputError
        Fewer than three magnets, magnets that overlap, numbers that are not positive.
    """
    for name, whole in (("count", count), ("order", order)):
        instance(f"halbach: {name}", whole, Integral, "a whole number")
    for name, value, wanted in (("radius", radius, "a length (m)"), ("remanence", remanence, "a number (T)")):
        real(f"halbach: {name}", value, wanted)
    if three_finite(sides) is None:
        raise InputError(f"halbach: sides is {sides!r}; it must be three lengths (m)")
    if not 3 <= count <= MOST_MAGNETS:
        raise InputError(f"halbach: count is {count}; a ring has from 3 to {MOST_MAGNETS} magnets")
    if order < 1:
        raise InputError(f"halbach: order is {order}; it must be at least 1")
    inner = radius - 0.5 * sides[0]
    if inner <= 0.0 or 2.0 * inner * np.tan(np.pi / count) < sides[1] * (1.0 - 1e-9):
        raise InputError(
            f"halbach: {count} magnets of {sides[0]:g} × {sides[1]:g} m overlap on a circle of {radius:g} m radius; "
            "make it larger or the magnets smaller"
        )
    ring = []
    for angle in 2.0 * np.pi * np.arange(count) / count:
        own = order * angle
        magnet = Cuboid(sides, (remanence * np.cos(own), remanence * np.sin(own), 0.0))
        place = (radius * np.cos(angle), radius * np.sin(angle), 0.0)
        ring.append(Source(magnet, place, (0.0, 0.0, angle)))
    return tuple(ring)
