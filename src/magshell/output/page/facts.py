"""Facts on the problem in the head of a page, from the model and the path alone."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from magshell.model.parts import Part
from magshell.model.region import Layer
from magshell.model.words import name_of, thickness_of
from magshell.units import FLUX_DENSITY, STRESS, show

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

Facts: TypeAlias = Sequence[tuple[str, str]]
PEOPLE = {
    "neo hookean": "neo-Hookean",
    "st venant kirchhoff": "St. Venant–Kirchhoff",
    "mooney rivlin": "Mooney–Rivlin",
    "gent": "Gent",
    "yeoh": "Yeoh",
}


def facts(path: Path, shown: Sequence[Step]) -> Facts:
    """Label and text of each: material, thickness, remanence, mesh, steps left out, how the path ended, version."""
    parts = path.model.shell.parts
    remanence = max(float(np.linalg.norm(part.remanence, axis=-1).max()) for part in parts)
    lines = [
        *_made_of(parts),
        ("remanence", f"up to {show(remanence, FLUX_DENSITY)}" if remanence else "none"),
        ("mesh", f"{len(path.discretisation.mesh.elements)} elements, {path.discretisation.dofs} unknowns"),
    ]
    if len(shown) < len(path.steps):
        lines.append(("steps", f"{len(shown)} of {len(path.steps)} are shown: all would be too much for a browser"))
    if not path.converged:
        lines.append(("path", f"ends at step {path.steps[-1].number}: {path.reason}"))
    return [*lines, ("magshell", version("magshell"))]


def _made_of(parts: Sequence[Part]) -> Facts:
    """Material and thickness; of several parts and layers those of each."""
    if len(parts) == 1 and not parts[0].layered:
        return [("material", _of(parts[0].layers[0])), ("thickness", thickness_of(parts[0]))]
    lines = []
    for part in parts:
        layers = [f"{thickness_of(part, number)} of {_of(layer)}" for number, layer in enumerate(part.layers)]
        lines.append((name_of(part) if len(parts) > 1 else "layers", "; ".join(layers)))
    return lines


def _of(layer: Layer) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(layer.material).__name__).lower()
    for people, proper in PEOPLE.items():
        words = words.replace(people, proper)
    return f"{words}, shear modulus {show(layer.material.shear_modulus, STRESS)}"
