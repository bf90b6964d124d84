"""The loading along the path: field, loads and held values against the load factor of a stage.

Multipliers, the angle of the field and held values vary straight with the load factor s from the start of a stage to
its end. The field B = h R(α) B0, with multiplier h and R(α) a turn about its axis a, then varies as

    dB/ds = h' R(α) B0 + α' a × B,

so it turns at constant magnitude where h' = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields.uniform import UniformField
from magshell.model.stages import Stage

# Stops closer to each other than this are one.
SAME_STOP = 1e-12


class Loading(NamedTuple):
    """What acts on the shell.

    Attributes
    ----------
    flux_density : ndarray, shape (3,)
        T.
    loads : ndarray, shape (loads,)
        Multiplier of each load of the model.
    held : ndarray, shape (nodes, 11)
        Values at the supports, in the nodes' frames.
    """

    flux_density: FloatArray
    loads: FloatArray
    held: FloatArray

    def plus(self, other: Loading) -> Loading:
        """The sum."""
        return Loading(*(one + two for one, two in zip(self, other, strict=True)))


class Amounts(NamedTuple):
    """What varies straight within a stage: multiplier and angle (rad) of the field, loads, held values."""

    field: float
    angle: float
    loads: FloatArray
    held: FloatArray

    def between(self, other: Amounts, fraction: float) -> Amounts:
        """This far on the way to others."""
        field = self.field + fraction * (other.field - self.field)
        angle = self.angle + fraction * (other.angle - self.angle)
        loads = self.loads + fraction * (other.loads - self.loads)
        return Amounts(field, angle, loads, self.held + fraction * (other.held - self.held))


class Course(NamedTuple):
    """The loading of a stage.

    Attributes
    ----------
    stage : Stage
    field : UniformField
    start, end : Amounts
        At load factors 0 and 1.
    """

    stage: Stage
    field: UniformField
    start: Amounts
    end: Amounts

    def amounts(self, load_factor: float) -> Amounts:
        """At a load factor, also outside [0, 1]."""
        return self.start.between(self.end, load_factor)

    def at(self, load_factor: float) -> Loading:
        """The loading at a load factor."""
        now = self.amounts(load_factor)
        return Loading(now.field * self.field.turned(now.angle), now.loads, now.held)

    def rate(self, load_factor: float) -> Loading:
        """Its derivative with respect to the load factor."""
        now, start, end = self.amounts(load_factor), self.start, self.end
        direction = self.field.turned(now.angle)
        turning = now.field * (end.angle - start.angle) * np.cross(self.field.axis, direction)
        return Loading((end.field - start.field) * direction + turning, end.loads - start.loads, end.held - start.held)

    def stops(self) -> list[float]:
        """Load factors that the path must hit, 1 the last: the stage's own, and where |B| meets the field's stops."""
        factors = {1.0, *np.asarray(self.stage.stops, dtype=float).tolist()}
        start, change = self.start.field, self.end.field - self.start.field
        for stop in np.asarray(self.field.stops, dtype=float).tolist() if change else ():
            for multiplier in (stop / self.field.magnitude, -stop / self.field.magnitude):
                factors.add((multiplier - start) / change)
        rising: list[float] = []
        for factor in sorted(factor for factor in factors if SAME_STOP < factor < 1.0 - SAME_STOP):
            if not rising or factor - rising[-1] > SAME_STOP:
                rising.append(factor)
        return [*rising, 1.0]
