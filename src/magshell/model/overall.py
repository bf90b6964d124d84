"""Remanence of a shell of several parts, for those who ask at other places than the integration points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.magnetics.remanence import Remanence, placed
from magshell.magnetics.remanence.groups import only
from magshell.magnetics.remanence.sampled import averaged
from magshell.magnetics.remanence.template import carried
from magshell.mesh import Mesh
from magshell.model.parts import Draft
from magshell.model.region import Layer

Sampled: TypeAlias = Callable[[Remanence, FloatArray], FloatArray]


def overall_remanence(whole: Remanence, drafts: Sequence[Draft]) -> Remanence:
    """One remanence for all drafts; that of the whole shell if they share it."""
    if all(not draft.layered and draft.layers[0].remanence is whole for draft in drafts):
        return whole
    return OfParts(drafts)


class OfParts:
    """The remanence of each part in its elements; of layers the mean over the thickness."""

    def __init__(self, drafts: Sequence[Draft]) -> None:
        self._drafts = drafts

    def __call__(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """At points (elements, points, 3), T."""
        return self._mean(mesh, points, lambda remanence, asked: remanence(mesh, asked))

    def carried_at(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """What the parts carry in their templates."""
        return self._mean(mesh, points, lambda remanence, asked: carried(remanence, mesh, asked))

    def averaged(self, mesh: Mesh, points: FloatArray) -> IntArray:
        """Elements whose remanence is the mean over several places."""
        found = [np.zeros(0, dtype=np.int64)]
        for draft in self._drafts:
            asked = only(draft.elements, points)
            found += [averaged(layer.remanence, mesh, asked) for layer in draft.layers]
        return np.unique(np.concatenate(found))

    def placed(self, mesh: Mesh, points: FloatArray) -> FloatArray | None:
        """Where the templates of the parts have the points; of layers the first template; None without any."""
        positions, moved = points.copy(), False
        for draft in self._drafts:
            asked = only(draft.elements, points)
            places = (placed(layer.remanence, mesh, asked) for layer in draft.layers)
            there = next((place for place in places if place is not None), None)
            if there is not None:
                positions[draft.elements], moved = there[draft.elements], True
        return positions if moved else None

    def _mean(self, mesh: Mesh, points: FloatArray, of: Sampled) -> FloatArray:
        mean = np.zeros(points.shape)
        for draft in self._drafts:
            asked = only(draft.elements, points)
            vectors = [of(layer.remanence, asked)[draft.elements] for layer in draft.layers]
            heights = [_thickness(layer, mesh, asked)[draft.elements] for layer in draft.layers]
            shares = np.stack(heights) / np.sum(heights, axis=0)
            sums = np.einsum("lep,lepx->epx", shares, np.stack(vectors))
            mean[draft.elements] = vectors[0] if len(vectors) == 1 else sums
        return mean


def _thickness(layer: Layer, mesh: Mesh, points: FloatArray) -> FloatArray:
    if callable(layer.thickness):
        return layer.thickness(mesh, points)
    return np.full(points.shape[:-1], layer.thickness)
