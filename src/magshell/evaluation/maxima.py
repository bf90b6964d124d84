"""The largest stress and strain of a state, and where they are: at which node, of which element, on which face."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.evaluation.converged import Converged
from magshell.evaluation.patches import patches_of

QUANTITIES = {"von_mises": "Pa", "principal_stress": "Pa", "principal_strain": ""}
"""Quantities of `Face`, with their units; of several principal values the largest."""
FACES = {"top": 1, "bottom": -1}
"""The faces, and their numbers in tables."""


class Largest(NamedTuple):
    """The largest value of a quantity.

    Attributes
    ----------
    value : float
    face : {"top", "bottom"}
    node, element : int
        A node, and the element of the lowest number in the patch whose value it is.
    position : ndarray, shape (3,)
        Of the node in the undeformed shell, m.
    """

    value: float
    face: str
    node: int
    element: int
    position: FloatArray


def maxima(converged: Converged) -> dict[str, Largest]:
    """The largest values over both faces, by the names of `QUANTITIES`."""
    patches = patches_of(converged.discretisation.model.shell)
    found = {}
    for name in QUANTITIES:
        values = np.stack([converged.at_face(name, face) for face in FACES])
        values = values[..., 0] if values.ndim == 3 else values
        face, row = np.unravel_index(np.argmax(values), values.shape)
        node = int(patches.nodes[row])
        place = converged.mesh.points[node]
        found[name] = Largest(float(values[face, row]), list(FACES)[face], node, int(patches.first[row]), place)
    return found


def columns() -> list[str]:
    """Names of what `numbers` gives: value, node and face (1: upper, -1: lower) of each quantity."""
    return [f"{name}.{what}" for name in QUANTITIES for what in ("max", "node", "face")]


def numbers(converged: Converged) -> list[float | None]:
    """The maxima for a table, a number for each column."""
    return [
        number
        for largest in maxima(converged).values()
        for number in (largest.value, largest.node, FACES[largest.face])
    ]
