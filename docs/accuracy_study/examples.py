"""The built-in problems on other meshes, with other elements, laws and parameters; what is read off each."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

import magshell as ms
from magshell import problem
from magshell.problem.building import build
from magshell.problem.schema import Blocks, Mesh, PrescribeTable, ProblemFile, SimpleTable

Divisions = tuple[int, int]
STRIPS = {"strip-10": 11.0, "strip-17": 19.2, "strip-20": 17.2, "strip-41": 17.2}
"""Lengths, mm."""


@dataclass(frozen=True)
class Reading:
    """The displacement that stands for an example.

    Attributes
    ----------
    example, probe : str
    component : int
        1, 2 or 3.
    low, final : float
        Fields, mT.
    words : str
    scale : float
        What mm are multiplied by.
    unit : str
    """

    example: str
    probe: str
    component: int
    low: float
    final: float
    words: str
    scale: float = 1.0
    unit: str = "mm"

    @property
    def fields(self) -> tuple[float, float]:
        """Low and final."""
        return self.low, self.final

    def of(self, run: Any, field: float) -> float:
        """The reading of a run at a field, mT."""
        return self.scale * run.at(self.probe, self.component, field)


READINGS = {
    **{name: Reading(name, "tip", 3, 2.0, 50.0, "$u_3/L$, tip", 1.0 / length, "L") for name, length in STRIPS.items()},
    "hollow-cross": Reading("hollow-cross", "C", 3, 10.0, 200.0, "$u_3$ at C"),
    "thin-cross": Reading("thin-cross", "A", 3, 2.0, 40.0, "$u_3$ at A"),
    "h-shape": Reading("h-shape", "A", 3, 2.0, 50.0, "$u_3$ at A"),
    "pump": Reading("pump", "B", 1, 1.0, 150.0, r"$\lvert u_1\rvert$ at B", -1.0),
    "gripper": Reading("gripper", "B", 3, 0.02, 10.0, "$u_3$ at B"),
}


@dataclass(frozen=True)
class Variant:
    """A built-in problem, changed.

    Attributes
    ----------
    example : str
    divisions : (int, int)
        Elements of the mesh; of the blocks that share one number, of each; where blocks have their own, of the centre.
    element : str
    fields : tuple of float
        mT; the last is the end of the path.
    coupling, thickness_stretch : str
    eta, length : float
        eta/mu, l/h.
    ends : {"clamp", "simple", "phi held"}
        What the clamps of the problem are.
    classical : bool
        Without micro-rotation; eta and length are 0 then.
    """

    example: str
    divisions: Divisions
    element: str
    fields: tuple[float, ...]
    coupling: str = "couple"
    thickness_stretch: str = "linear"
    eta: float = 0.1
    length: float = 0.1
    ends: str = "clamp"
    classical: bool = False

    @property
    def settings(self) -> ms.Settings:
        """The default; where the only field is a small one, the whole of it at once."""
        single = self.fields == (READINGS[self.example].low,)
        return ms.Settings(first_step=1.0) if single else ms.Settings()

    def model(self) -> ms.Model:
        """The model, its path ending at the last field."""
        source, file = problem.read(self.example)
        return build(self.file(file), source).model

    def file(self, file: ProblemFile) -> ProblemFile:
        """The problem file with the changes."""
        vector = np.array(file.field.flux_density)
        end = 1e-3 * self.fields[-1] * vector / np.linalg.norm(vector)
        stops = tuple(1e-3 * field for field in self.fields)
        material = {
            "coupling_modulus": None if self.classical else self.eta * file.material.shear_modulus,
            "length_scale": None if self.classical else self.length * file.shell.thickness,
        }
        shell = {
            "element": self.element,
            "thickness_stretch": self.thickness_stretch,
            "micro_rotation": not self.classical,
        }
        field = {"flux_density": tuple(end), "stops": stops, "coupling": self.coupling}
        return file.model_copy(
            update={
                "mesh": divided(file.mesh, self.divisions),
                "material": file.material.model_copy(update=material),
                "shell": file.shell.model_copy(update=shell),
                "field": file.field.model_copy(update=field),
                "supports": self._supports(file),
                "probes": {name: place for name, place in file.probes.items() if name == READINGS[self.example].probe},
            }
        )

    def _supports(self, file: ProblemFile) -> tuple[Any, ...]:
        supports: list[Any] = []
        for support in file.supports:
            if support.kind != "clamp" or self.ends == "clamp":
                supports.append(support)
            elif self.ends == "simple":
                supports.append(SimpleTable(kind="simple", group=support.group))
            else:
                supports += [support, PrescribeTable(kind="prescribe", group=support.group, field="phi")]
        return tuple(supports)


def divided(mesh: Mesh, divisions: Divisions) -> Mesh:
    """A mesh with other numbers of elements; blocks with numbers of their own in proportion to that named centre."""
    if not isinstance(mesh, Blocks) or mesh.elements is not None:
        return mesh.model_copy(update={"elements": divisions})
    centre = mesh.blocks["centre"].elements
    assert centre is not None
    blocks = {
        name: block.model_copy(update={"elements": tuple(n * divisions[0] // centre[0] for n in mesh.divisions(name))})
        for name, block in mesh.blocks.items()
    }
    return mesh.model_copy(update={"blocks": blocks})


def paper_divisions(example: str) -> Divisions:
    """The paper's mesh, which is that of the problem file, in the sense of `Variant.divisions`."""
    mesh: Any = problem.read(example)[1].mesh
    return mesh.elements or mesh.blocks["centre"].elements


def changed(variant: Variant, **keys: Any) -> Variant:
    """A variant with some of its attributes changed."""
    return dataclasses.replace(variant, **keys)
