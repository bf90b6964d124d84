"""The loading along the path: field, loads and held values against the load factor of a stage.

Multipliers, places and angles of the field (`magshell.magnetics.fields`), multipliers of loads and held values vary
linearly with the load factor s from the start of a stage to its end. A uniform field B = h R(α) B0, with multiplier h
and R(α) a turn about its axis a, then varies as dB/ds = h' R(α) B0 + α' a × B: it turns at constant magnitude where
h' = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import Field, FieldUnknown, UniformField, Values
from magshell.model.stages import Stage

# Stops closer to each other than this are one.
SAME_STOP = 1e-12


class Loading(NamedTuple):
    """What acts on the shell.

    Attributes
    ----------
    flux_density : ndarray, shape (3,)
        T; of a field that varies, at the centre of area of the undeformed shell.
    loads : ndarray, shape (loads,)
        Multiplier of each load of the model.
    held : ndarray, shape (rows, 11)
        Values at the supports, in the nodes' frames.
    drives : ndarray, shape (drives,)
        Amounts of the field.
    """

    flux_density: FloatArray
    loads: FloatArray
    held: FloatArray
    drives: FloatArray

    def plus(self, other: Loading) -> Loading:
        """The sum."""
        return Loading(*(one + two for one, two in zip(self, other, strict=True)))

    def without_field(self) -> Loading:
        """With no field."""
        return self._replace(flux_density=np.zeros(3), drives=np.zeros_like(self.drives))


class Amounts(NamedTuple):
    """What varies linearly within a stage: amounts of the field, multipliers of loads, held values."""

    drives: FloatArray
    loads: FloatArray
    held: FloatArray

    def between(self, other: Amounts, fraction: float) -> Amounts:
        """Linear interpolation towards `other`."""
        return Amounts(*(one + fraction * (two - one) for one, two in zip(self, other, strict=True)))


class Course(NamedTuple):
    """The loading of a stage.

    Attributes
    ----------
    stage : Stage
    field : Field
    start, end : Amounts
        At load factors 0 and 1.
    centre : ndarray, shape (3,)
        Where the flux density of a field that varies is reported, m.
    """

    stage: Stage
    field: Field
    start: Amounts
    end: Amounts
    centre: FloatArray

    def amounts(self, load_factor: float) -> Amounts:
        """At a load factor, also outside [0, 1]."""
        return self.start.between(self.end, load_factor)

    def at(self, load_factor: float) -> Loading:
        """The loading at a load factor."""
        now = self.amounts(load_factor)
        told = self._told(lambda: self.field.at(now.drives, self.centre[None], second=False))
        return Loading(told, now.loads, now.held, now.drives)

    def rate(self, load_factor: float) -> Loading:
        """Its derivative with respect to the load factor."""
        now, start, end = self.amounts(load_factor), self.start, self.end
        drives = end.drives - start.drives
        change = self._told(lambda: self.field.rate(now.drives, drives, self.centre[None]))
        return Loading(change, end.loads - start.loads, end.held - start.held, drives)

    def reported(self, load_factor: float, flux_density: FloatArray) -> FloatArray:
        """The flux density (3,) of `at` as results have it: NaN where the field is not known at the centre."""
        if self.field.is_uniform or np.any(flux_density):
            return flux_density
        try:
            self.field.at(self.amounts(load_factor).drives, self.centre[None], second=False)
        except FieldUnknown:
            return np.full(3, np.nan)
        return flux_density

    @staticmethod
    def _told(values: Callable[[], Values]) -> FloatArray:
        """Flux density (3,) of values at the centre; zero where the field is not known there."""
        try:
            return np.array(values().flux_density[0])
        except FieldUnknown:
            return np.zeros(3)

    def stops(self) -> list[float]:
        """Load factors that the path must hit, 1 the last: the stage's own, and where a uniform part meets its."""
        factors = {1.0, *np.asarray(self.stage.stops, dtype=float).tolist()}
        parts = zip(self.field.parts(self.start.drives), self.field.parts(self.end.drives), strict=True)
        for (part, before), (_, after) in parts:
            if not isinstance(part, UniformField) or before[0] == after[0]:
                continue
            for stop in np.asarray(part.stops, dtype=float).tolist():
                for multiplier in (stop / part.magnitude, -stop / part.magnitude):
                    factors.add(float((multiplier - before[0]) / (after[0] - before[0])))
        rising: list[float] = []
        for factor in sorted(factor for factor in factors if SAME_STOP < factor < 1.0 - SAME_STOP):
            if not rising or factor - rising[-1] > SAME_STOP:
                rising.append(factor)
        return [*rising, 1.0]
