"""The largest stress and strain of a state, and where they are: at which node, of which element, on which face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

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
        both = np.stack([converged.at_face(name, face) for face in FACES])
        both = both[..., 0] if both.ndim == 3 else both
        face, row = np.unravel_index(np.argmax(both), both.shape)
        node = int(patches.nodes[row])
        place = converged.mesh.points[node]
        found[name] = Largest(float(both[face, row]), list(FACES)[face], node, int(patches.first[row]), place)
    return found


PLACES = ("node", "element", "face")


def values(converged: Converged, names: Sequence[str]) -> list[float | None]:
    """The largest values of some quantities, for a table."""
    found = maxima(converged)
    return [found[name].value for name in names]


def places(converged: Converged) -> list[float | None]:
    """Where all of them are: node, element and number of the face of each, for a table."""
    found = maxima(converged).values()
    return [number for one in found for number in (one.node, one.element, FACES[one.face])]


def value_column(name: str) -> str:
    """The column of a largest value."""
    return f"max_{name}"


def place_columns() -> list[str]:
    """The columns of the places."""
    return [f"{value_column(name)}.{what}" for name in QUANTITIES for what in PLACES]


def described(numbers: Mapping[str, float | None], points: FloatArray) -> dict[str, Any]:
    """The maxima of a row of the table, in words: `numbers` by their columns, `points` (nodes, 3) of the mesh."""
    faces = {number: face for face, number in FACES.items()}
    told = {}
    for name in QUANTITIES:
        column = value_column(name)
        node, element, face = (int(numbers[f"{column}.{what}"] or 0) for what in PLACES)
        told[name] = {
            "value": numbers[column],
            "face": faces[face],
            "node": node,
            "element": element,
            "position": points[node].tolist(),
        }
    return told
