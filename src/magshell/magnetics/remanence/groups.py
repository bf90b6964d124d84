"""One remanence per element group."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.magnetics.remanence.sampled import averaged
from magshell.magnetics.remanence.template import carried, placed
from magshell.magnetics.remanence.vectors import Remanence

if TYPE_CHECKING:
    from magshell.mesh import Mesh


class ByGroup:
    """What `by_group` returns."""

    def __init__(self, remanences: Mapping[str, Remanence]) -> None:
        self._remanences = dict(remanences)

    def __call__(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """The remanence at points (elements, points, 3); every part is evaluated at NaN outside its group."""
        return self._gathered(mesh, points, lambda remanence, asked: remanence(mesh, asked))

    def carried_at(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """What the groups carry in their templates."""
        return self._gathered(mesh, points, lambda remanence, asked: carried(remanence, mesh, asked))

    def _gathered(
        self, mesh: Mesh, points: FloatArray, of: Callable[[Remanence, FloatArray], FloatArray]
    ) -> FloatArray:
        values = np.zeros(points.shape)
        owner = np.full(len(points), "", dtype=object)
        for group, remanence in self._remanences.items():
            members = mesh.elements_of(group)
            taken = members[owner[members] != ""]
            if taken.size:
                raise InputError(
                    f"remanence: element {taken[0]} is in the groups '{owner[taken[0]]}' and '{group}'; "
                    "an element has one remanence only"
                )
            owner[members] = group
            values[members] = of(remanence, only(members, points))[members]
        return values

    def averaged(self, mesh: Mesh, points: FloatArray) -> IntArray:
        """Elements whose remanence is the mean over several places."""
        parts = [
            averaged(remanence, mesh, only(mesh.elements_of(group), points))
            for group, remanence in self._remanences.items()
        ]
        return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *parts]))

    def placed(self, mesh: Mesh, points: FloatArray) -> FloatArray | None:
        """Where the templates of the groups have the points; other groups stay; None without any template."""
        positions = points.copy()
        moved = False
        for group, remanence in self._remanences.items():
            members = mesh.elements_of(group)
            there = placed(remanence, mesh, only(members, points))
            if there is not None:
                positions[members] = there[members]
                moved = True
        return positions if moved else None


def by_group(remanences: Mapping[str, Remanence]) -> Remanence:
    """One remanence per element group; elements in none of the groups have none."""
    return ByGroup(remanences)


def only(members: IntArray, points: FloatArray) -> FloatArray:
    """The points (elements, points, 3) of some elements; those of the others are NaN."""
    asked = np.full(points.shape, np.nan)
    asked[members] = points[members]
    return asked
