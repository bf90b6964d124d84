"""Built-in problems on other meshes, and values along their paths."""

from __future__ import annotations

from typing import Any

import numpy as np

from examples.references import STRIP_LENGTHS, Reference
from magshell import problem
from magshell.problem.building import Problem, build
from magshell.problem.schema import ProblemFile
from magshell.solver import Path


def value_at(path: Path, reference: Reference) -> float:
    """The path's value of a reference, in the reference's unit; the field must be a stop of the path."""
    fields = np.linalg.norm(path.probe(reference.probe).flux_density, axis=1) * 1e3
    step = int(np.argmin(np.abs(fields - reference.field)))
    assert abs(fields[step] - reference.field) < 1e-9, f"no step at {reference.field} mT: {fields}"
    value = float(getattr(path.probe(reference.probe), reference.component)[step])
    return value / (1e-3 if reference.unit == "mm" else STRIP_LENGTHS[reference.problem])


def read(name: str, element: str = "paper") -> tuple[str, ProblemFile]:
    """A built-in problem with the element of the source, whose values the references on the files' meshes are."""
    source, file = problem.read(name)
    shell = file.shell.model_copy(update={"element": element})
    return source, file.model_copy(update={"shell": shell})


PART_OF_THE_PUMP = "pump to 10 mT"


def part_of_the_pump() -> tuple[str, ProblemFile]:
    """The pump in a fifteenth of its field, on every other element."""
    source, file = read("pump")
    field = file.field.model_copy(update={"flux_density": (0.0, 0.0, 10e-3), "stops": (5e-3,)})
    mesh = file.mesh.model_copy(update={"elements": (12, 10)})
    return source, file.model_copy(update={"field": field, "mesh": mesh})


def variant(
    name: str,
    divide: int = 1,
    stops: tuple[float, ...] = (),
    coupling: str = "couple",
    length_scale: float | None = None,
    element: str = "paper",
) -> Problem:
    """A built-in problem with every element divided into divide × divide, its own stops (T), law and l (m)."""
    source, file = read(name, element)
    changes: dict[str, Any] = {}
    if getattr(file.mesh, "elements", None) is not None:
        changes["elements"] = _times(file.mesh.elements, divide)
    if hasattr(file.mesh, "blocks"):
        changes["blocks"] = {
            key: block
            if block.elements is None
            else block.model_copy(update={"elements": _times(block.elements, divide)})
            for key, block in file.mesh.blocks.items()
        }
    mesh = file.mesh.model_copy(update=changes)
    field = file.field.model_copy(update={"stops": stops, "coupling": coupling})
    material = file.material
    if length_scale is not None:
        material = material.model_copy(update={"length_scale": length_scale})
    return build(file.model_copy(update={"mesh": mesh, "field": field, "material": material}), source)


def _times(divisions: tuple[int, int], factor: int) -> tuple[int, int]:
    return divisions[0] * factor, divisions[1] * factor
