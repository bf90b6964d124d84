"""What a page says of the problem in a line: from the model and the path alone."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from magshell.units import FLUX_DENSITY, LENGTH, STRESS, show

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

Facts: TypeAlias = Sequence[tuple[str, str]]
PEOPLE = {
    "neo hookean": "neo-Hookean",
    "st venant kirchhoff": "St. Venant–Kirchhoff",
    "mooney rivlin": "Mooney–Rivlin",
}


def facts(path: Path, shown: Sequence[Step]) -> Facts:
    """Label and text of each: material, thickness, remanence, mesh, steps left out, how the path ended, version."""
    shell = path.model.shell
    material = shell.material
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(material).__name__).lower()
    for people, proper in PEOPLE.items():
        words = words.replace(people, proper)
    remanence = float(np.linalg.norm(path.discretisation.reference.remanence, axis=-1).max())
    lines = [
        ("material", f"{words}, shear modulus {show(material.shear_modulus, STRESS)}"),
        ("thickness", show(shell.thickness, LENGTH)),
        ("remanence", f"up to {show(remanence, FLUX_DENSITY)}" if remanence else "none"),
        ("mesh", f"{len(path.discretisation.mesh.elements)} elements, {path.discretisation.dofs} unknowns"),
    ]
    if len(shown) < len(path.steps):
        lines.append(("steps", f"{len(shown)} of {len(path.steps)} are shown: all would be too much for a browser"))
    if not path.converged:
        lines.append(("path", f"ends at step {path.steps[-1].number}: {path.reason}"))
    return [*lines, ("magshell", version("magshell"))]
