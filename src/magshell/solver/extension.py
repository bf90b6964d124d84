"""How far a body is stretched where its law has a limit.

Such a law has a method `extension(F)`: the share of the limit that deformation gradients (..., 3, 3) take, 1 at the
limit. Beyond it the law gives NaN, and no step is accepted there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.shell.deformed import evaluate
from magshell.shell.state import State


class Extension(NamedTuple):
    """The largest share of the limit of a law, and the element that it is in."""

    share: float
    element: int


def extension(discretisation: Discretisation, F: FloatArray) -> Extension | None:
    """The worst of a body with deformation gradients F (elements, points, levels, 3, 3); None: no law has a limit."""
    worst = None
    for part in discretisation.model.shell.parts:
        for number, layer in enumerate(part.layers):
            if not hasattr(layer.material, "extension"):
                continue
            levels = slice(number * part.levels, (number + 1) * part.levels)
            shares = layer.material.extension(F[part.elements][:, :, levels]).max(axis=(1, 2))
            element = int(np.argmax(shares))
            if worst is None or shares[element] > worst.share:
                worst = Extension(float(shares[element]), int(part.elements[element]))
    return worst


def beyond(discretisation: Discretisation, state: State) -> str:
    """Where a state is stretched beyond the limit of a law, as the end of a message; else empty."""
    found = extension(discretisation, evaluate(discretisation.reference, state).F)
    if found is None or found.share < 1.0:
        return ""
    return f": element {found.element} is stretched to {100 * found.share:.0f} % of the limit of its law"
