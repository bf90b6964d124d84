"""Coordinate systems of Nastran's bulk data, each defined in another one or by three grid points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.mesh.files.cards import Card
from magshell.mesh.files.lines import Lines

_DEEPEST = 100
"""Systems that are defined one in another."""


class _System(NamedTuple):
    shape: str
    """R, C or S: rectangular, cylindrical, spherical."""
    origin: FloatArray
    axes: FloatArray
    """(3, 3): rows are the axes."""

    def position(self, x: FloatArray) -> FloatArray:
        """In the basic system, of coordinates of this one; angles are in degrees."""
        if self.shape == "C":
            angle = np.radians(x[1])
            x = np.array([x[0] * np.cos(angle), x[0] * np.sin(angle), x[2]])
        elif self.shape == "S":
            polar, azimuth = np.radians(x[1:])
            x = x[0] * np.array([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
        result: FloatArray = self.origin + x @ self.axes
        return result


class Systems:
    """Positions of grid points in the basic system.

    Parameters
    ----------
    lines : Lines
    cards : mapping of str to list of Card
        All cards by name: GRID, GRDSET, CORD2R and its like.
    """

    def __init__(self, lines: Lines, cards: Mapping[str, list[Card]]) -> None:
        self._lines = lines
        self._known = {0: _System("R", np.zeros(3), np.eye(3))}
        self._defined: dict[int, tuple[Card, int]] = {}
        for name, found in cards.items():
            for card in found if name.startswith("CORD") else ():
                for first in (0, 4) if name.startswith("CORD1") else (0,):
                    if first and not card.text(first):
                        continue
                    number = card.whole(lines, first, "the number of a coordinate system")
                    if number in self._defined or number <= 0:
                        lines.fail(card.line, f"{name}: the coordinate system {number} is there already")
                    self._defined[number] = card, first
        defaults = [card.whole(lines, 1, "a coordinate system", default=0) for card in cards.get("GRDSET", ())]
        self._default = defaults[0] if defaults else 0
        self._grids = {card.whole(lines, 0, "the number of a grid point"): card for card in cards.get("GRID", ())}
        self._positions: dict[int, FloatArray] = {}

    def positions(self) -> dict[int, FloatArray]:
        """Of all grid points, by number."""
        for number, card in self._grids.items():
            self._position(number, card, 0)
        return self._positions

    def _position(self, number: int, asking: Card, depth: int) -> FloatArray:
        if number not in self._positions:
            card = self._grids.get(number)
            if card is None:
                self._lines.fail(asking.line, f"{asking.name}: there is no grid point {number}")
            system = card.whole(self._lines, 1, "a coordinate system", default=self._default)
            x = np.array([card.real(self._lines, 2 + axis, "a coordinate") for axis in range(3)])
            self._positions[number] = self._system(system, card, depth).position(x)
        return self._positions[number]

    def _system(self, number: int, asking: Card, depth: int) -> _System:
        if number in self._known:
            return self._known[number]
        if number not in self._defined:
            self._lines.fail(
                asking.line,
                f"{asking.name} {asking.text(0)}: there is no coordinate system {number} (CORD1 or CORD2 with R, C, S)",
            )
        card, first = self._defined[number]
        if depth > _DEEPEST:
            self._lines.fail(card.line, f"{card.name}: the coordinate system {number} is defined in itself")
        if card.name[4:5] not in ("1", "2") or card.name[5:] not in ("R", "C", "S"):
            self._lines.fail(card.line, f"{card.name} is not read; define the system by CORD2R, CORD2C or CORD2S")
        if card.name.startswith("CORD1"):
            places = [card.whole(self._lines, first + 1 + corner, "a grid point") for corner in range(3)]
            a, b, c = (self._position(place, card, depth + 1) for place in places)
        else:
            reference = self._system(card.whole(self._lines, 1, "a coordinate system", default=0), card, depth + 1)
            values = np.array([card.real(self._lines, 2 + place, "a coordinate") for place in range(9)])
            a, b, c = (reference.position(point) for point in values.reshape(3, 3))
        z = b - a
        y = np.cross(z, c - a)
        sizes = np.linalg.norm(z), np.linalg.norm(y)
        if not (sizes[0] > 0.0 and sizes[1] > 1e-9 * sizes[0] * np.linalg.norm(c - a)):
            self._lines.fail(card.line, f"{card.name} {number}: its three points do not span a plane")
        z, y = z / sizes[0], y / sizes[1]
        self._known[number] = _System(card.name[5], a, np.stack([np.cross(y, z), y, z]))
        return self._known[number]
