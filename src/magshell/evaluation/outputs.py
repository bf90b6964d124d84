"""What a result holds: every quantity that files and pictures show, named once.

Writers, pictures and pages all go through `OUTPUTS`, so a new quantity is one entry here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from magshell.arrays import AnyArray
from magshell.errors import InputError, suggest
from magshell.evaluation.converged import Converged
from magshell.shell.point import INTERNAL


@dataclass(frozen=True)
class Output:
    """One quantity of a state.

    Attributes
    ----------
    name : str
        Its array in the files.
    symbol : str
        Short name; a component is the symbol and 1, 2 or 3.
    unit : str
        SI, empty for a pure number.
    sentence : str
        What it is.
    where : "point" or "cell"
        One row per node or per element of the mesh.
    components : int
        1 for a scalar (one-dimensional array), 3 for a vector (in X1, X2, X3).
    evaluate : callable
        From what has converged to the array.
    """

    name: str
    symbol: str
    unit: str
    sentence: str
    where: Literal["point", "cell"]
    components: Literal[1, 3]
    evaluate: Callable[[Converged], AnyArray]


def _element_group(converged: Converged) -> AnyArray:
    numbers = np.zeros(len(converged.mesh.elements), dtype=np.int32)
    for number, elements in enumerate(converged.mesh.element_groups.values(), start=1):
        numbers[elements] = number
    return numbers


OUTPUTS: dict[str, Output] = {
    output.name: output
    for output in (
        Output(
            "displacement",
            "u",
            "m",
            "Displacement of the mid-surface.",
            "point",
            3,
            lambda converged: converged.displacement,
        ),
        Output(
            "director",
            "d",
            "",
            "Deformed director: unit normal of the undeformed mid-surface plus its difference vector w.",
            "point",
            3,
            lambda converged: converged.director(),
        ),
        Output(
            "phi",
            "phi",
            "1/m",
            "Linear part of the thickness stretch.",
            "point",
            1,
            lambda converged: converged.phi(),
        ),
        Output(
            "rotation",
            "theta",
            "rad",
            "Micro-rotation vector: along the axis, as long as the angle.",
            "point",
            3,
            lambda converged: converged.rotation(),
        ),
        Output(
            "normal",
            "D",
            "",
            "Unit normal of the undeformed mid-surface.",
            "point",
            3,
            lambda converged: converged.discretisation.normals,
        ),
        Output(
            "remanence",
            "b",
            "T",
            "Remanent flux density carried by the deformed body, F·Brem/J, mean over the element.",
            "cell",
            3,
            lambda converged: converged.remanence(),
        ),
        Output(
            "thickness_ratio",
            "h",
            "",
            "Deformed over undeformed thickness, mean over the element.",
            "cell",
            1,
            lambda converged: converged.thickness_ratio(),
        ),
        Output(
            "energy",
            "W",
            "J",
            "Strain energy of the element.",
            "cell",
            1,
            lambda converged: converged.energies[:, INTERNAL],
        ),
        Output(
            "element_group",
            "group",
            "",
            "Number of the element group, from 1 in the order of element_group_names; 0 in none.",
            "cell",
            1,
            _element_group,
        ),
    )
}
"""The quantities, by name, in the order of the files."""


def find(name: str) -> tuple[Output, int | None]:
    """Look an output up by what a user calls it.

    Parameters
    ----------
    name : str
        Name or symbol of an output, or the symbol of a vector and a component: "displacement", "u", "u3".

    Returns
    -------
    Output
    int or None
        The component, 1 to 3; None for the whole (a vector is then shown by its length).

    Raises
    ------
    InputError
        No such output; names the nearest.
    """
    known: dict[str, tuple[Output, int | None]] = {}
    for output in OUTPUTS.values():
        known[output.name] = known[output.symbol] = (output, None)
        if output.components == 3:
            known |= {f"{output.symbol}{i}": (output, i) for i in (1, 2, 3)}
    if name not in known:
        raise InputError(f"There is no output '{name}' to show. {suggest(name, known)}")
    return known[name]
