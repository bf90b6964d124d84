r"""Derivatives of a magnetic field by central differences of sixth order.

Where there is neither current nor a surface of a magnet, B is the gradient of a harmonic function, so ∇B is symmetric
and free of trace (5 numbers) and ∇∇B symmetric in all its indices and free of trace (7). Differences along two axes and
the diagonal between them give all of them, from 19 values of B:

    ∂1 B, ∂2 B → ∇B;    ∂1∂1 B, ∂2∂2 B, ∂d∂d B3 → ∇∇B,    2 ∂d∂d = ∂1∂1 + 2 ∂1∂2 + ∂2∂2.

What is found is symmetric and free of trace exactly. The step is a share of the distance from the nearest surface or
wire, which is the length over which the field varies there. `STEP` is where the errors of truncation, as STEP⁶, and of
round-off, as 1/STEP (gradient) and 1/STEP² (second derivatives), are alike: with magnets and loops of magpylib the
gradient is within 1e-10 and the second derivatives within 1e-8, relative to the largest component.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields.field import Values

STEP = 8e-3
FIRST = (45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0)
SECOND = (270.0 / 180.0, -27.0 / 180.0, 2.0 / 180.0)
SECOND_AT_CENTRE = -490.0 / 180.0
AXES = np.eye(3)
DIAGONAL = np.sqrt(0.5)

Function = Callable[[FloatArray], FloatArray]


def harmonic(function: Function, points: FloatArray, step: FloatArray, second: bool) -> Values:
    """A field free of curl and divergence, with its derivatives.

    Parameters
    ----------
    function : callable
        From points (m, 3) to B (m, 3).
    points : ndarray, shape (n, 3)
    step : ndarray, shape (n,)
        m.
    second : bool
        Whether second derivatives are needed.
    """
    directions = [AXES[0], AXES[1], DIAGONAL * (AXES[0] + AXES[1])] if second else [AXES[0], AXES[1]]
    B, first, twice = _along(function, points, step, directions)
    gradient = np.empty((len(points), 3, 3))
    gradient[:, 0, 0], gradient[:, 1, 1] = first[0][:, 0], first[1][:, 1]
    gradient[:, 2, 2] = -first[0][:, 0] - first[1][:, 1]
    for i, j, both in ((0, 1, 0.5 * (first[0][:, 1] + first[1][:, 0])), (0, 2, first[0][:, 2]), (1, 2, first[1][:, 2])):
        gradient[:, i, j] = gradient[:, j, i] = both
    return Values(B, gradient, _third_derivatives(*twice) if second else None)


def _third_derivatives(one: FloatArray, two: FloatArray, diagonal: FloatArray) -> FloatArray:
    """∇∇B (n, 3, 3, 3) of second derivatives (n, 3) of B along the axes 1 and 2 and their diagonal."""
    found = {
        (0, 0, 0): one[:, 0],
        (0, 0, 1): one[:, 1],
        (0, 0, 2): one[:, 2],
        (0, 1, 1): two[:, 0],
        (1, 1, 1): two[:, 1],
        (1, 1, 2): two[:, 2],
        (0, 1, 2): diagonal[:, 2] - 0.5 * (one[:, 2] + two[:, 2]),
        (0, 2, 2): -one[:, 0] - two[:, 0],
        (1, 2, 2): -one[:, 1] - two[:, 1],
        (2, 2, 2): -one[:, 2] - two[:, 2],
    }
    second = np.empty((len(one), 3, 3, 3))
    for place in np.ndindex(3, 3, 3):
        second[(slice(None), *place)] = found[tuple(sorted(place))]
    return second


def general(function: Function, points: FloatArray, step: FloatArray, second: bool) -> Values:
    """Any field with its derivatives, from 19 values of B, or 37 with second derivatives; arguments as `harmonic`."""
    pairs = ((0, 1), (1, 2), (2, 0)) if second else ()
    diagonals = [DIAGONAL * (AXES[j] + AXES[k]) for j, k in pairs]
    B, first, twice = _along(function, points, step, [*AXES, *diagonals])
    gradient = np.stack(first[:3], axis=2)
    if not second:
        return Values(B, gradient, None)
    whole = np.empty((len(points), 3, 3, 3))
    for j in range(3):
        whole[:, :, j, j] = twice[j]
    for (j, k), diagonal in zip(pairs, twice[3:], strict=True):
        whole[:, :, j, k] = whole[:, :, k, j] = diagonal - 0.5 * (twice[j] + twice[k])
    return Values(B, gradient, whole)


def _along(
    function: Function, points: FloatArray, step: FloatArray, directions: Sequence[FloatArray]
) -> tuple[FloatArray, list[FloatArray], list[FloatArray]]:
    """The function (n, 3), and its first and second derivatives (n, 3) along unit vectors; one call for all."""
    steps = np.arange(1, len(FIRST) + 1)
    moves = np.array([sign * k * direction for direction in directions for k in steps for sign in (1.0, -1.0)])
    places = points + step[:, None] * np.concatenate([np.zeros((1, 3)), moves])[:, None, :]
    found = function(places.reshape(-1, 3)).reshape(len(moves) + 1, len(points), 3)
    first, second = [], []
    for pairs in found[1:].reshape(len(directions), len(FIRST), 2, len(points), 3):
        difference = sum(share * (after - before) for share, (after, before) in zip(FIRST, pairs, strict=True))
        total = sum(share * (after + before) for share, (after, before) in zip(SECOND, pairs, strict=True))
        first.append(difference / step[:, None])
        second.append((total + SECOND_AT_CENTRE * found[0]) / step[:, None] ** 2)
    return found[0], first, second
