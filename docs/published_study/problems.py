"""The six problems of Sze, Liu and Lo: what their tables hold, on which meshes they are solved, and their models.

Tables: Finite Elem. Anal. Des. 40 (2004) 1551–1569. `load_ratio` is the load over its largest value; the other columns
are displacements, whose signs are in their names. The rolled cantilever has the exact solution in place of a table.
"""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

import magshell as ms
from magshell import problem
from magshell.problem.building import build

TABLES = pathlib.Path(__file__).parents[2] / "tests" / "published"
Divisions = tuple[int, int]


class Variant(NamedTuple):
    """Element and number of parameters; with 10, the coupling modulus is mu/10."""

    element: str
    parameters: int

    @property
    def name(self) -> str:
        """As in tables and pictures."""
        return f"{self.element}, {self.parameters} parameters"


CLASSICAL = Variant("quadratic", 7)
MICROPOLAR = Variant("quadratic", 10)
PAPER = Variant("paper", 10)
VARIANTS = (CLASSICAL, MICROPOLAR, PAPER)


class Column(NamedTuple):
    """A column of a table: a displacement component of a probe, times a factor with its sign."""

    name: str
    probe: str
    component: int
    factor: float


@dataclasses.dataclass(frozen=True)
class Published:
    """A problem with its table.

    Attributes
    ----------
    name : str
        Of the built-in problem.
    title : str
    table : str
        File of the table.
    columns : sequence of Column
    meshes : mapping of Variant to sequence of (int, int)
        Divisions, coarse to fine.
    allowed : float
        Of a column's range: the largest distance of a tabulated point on the built-in mesh.
    by_displacement : bool
        Whether the path is led through the tabulated displacements, and loads are compared; otherwise the reverse.
    """

    name: str
    title: str
    table: str
    columns: Sequence[Column]
    meshes: Mapping[Variant, Sequence[Divisions]]
    allowed: float = 0.01
    by_displacement: bool = False

    @property
    def usual(self) -> Divisions:
        """Divisions of the built-in problem."""
        divisions: Divisions = problem.read(self.name)[1].mesh.elements
        return divisions

    @property
    def data(self) -> dict[str, np.ndarray]:
        """The table's columns."""
        rows = np.genfromtxt(TABLES / self.table, delimiter=",", names=True, skip_header=1)
        return {name: rows[name] for name in rows.dtype.names}

    def model(self, variant: Variant = CLASSICAL, divisions: Divisions | None = None) -> ms.Model:
        """The built-in problem as a variant, on a mesh of its own or the built-in one, led through the table's rows."""
        source, file = problem.read(self.name)
        if divisions is not None:
            file = file.model_copy(update={"mesh": file.mesh.model_copy(update={"elements": divisions})})
        built = build(file, source).model
        shell, stages = dataclasses.replace(built.shell, element=variant.element), self.stages()
        if variant.parameters == 7:
            return dataclasses.replace(built, shell=shell, stages=stages)
        mu, length = shell.material.shear_modulus, 0.01 * shell.thickness
        material = shell.material._replace(coupling_modulus=mu / 10.0, length_scale=length)
        shell = dataclasses.replace(shell, material=material, micro_rotation=True)
        return dataclasses.replace(built, shell=shell, stages=stages)

    def stages(self) -> list[ms.Stage]:
        """Stages that end, or stop, at each row."""
        if not self.by_displacement:
            return [ms.Stage(stops=self.data["load_ratio"].tolist())]
        (column,) = self.columns
        led = {"control": "displacement", "probe": column.probe, "component": column.component}
        return [ms.Stage(target=value / column.factor, **led) for value in self.data[column.name].tolist()]


def meshes(
    along: int, across: int, classical: Sequence[int], micropolar: Sequence[int], paper: Sequence[int]
) -> dict[Variant, list[Divisions]]:
    """Meshes of the variants: these numbers of elements times factors; with none across, one throughout."""
    factors = zip((CLASSICAL, MICROPOLAR, PAPER), (classical, micropolar, paper), strict=True)
    return {variant: [(along * n, across * n or 1) for n in counts] for variant, counts in factors}


MM = 1e3
PROBLEMS = [
    Published(
        "cantilever-shear", "cantilever, shear force", "cantilever_end_shear.csv",
        [Column("minus_u_tip", "tip", 1, -1.0), Column("w_tip", "tip", 3, 1.0)],
        meshes(1, 0, (2, 4, 8, 16), (2, 4, 8, 16), (4, 8, 16, 32)),
    ),
    Published(
        "cantilever-moment", "cantilever, moment", "cantilever_end_moment.csv",
        [Column("minus_u_tip", "tip", 1, -1.0), Column("w_tip", "tip", 3, 1.0)],
        meshes(1, 0, (4, 8, 16, 24), (8, 16, 24), (12, 16, 24)),
    ),
    Published(
        "slit-annulus", "slit annulus", "slit_annulus.csv",
        [Column("w_A", "A", 3, 1.0), Column("w_B", "B", 3, 1.0)],
        meshes(1, 5, (2, 3, 6, 9), (2, 3, 6), (3, 6, 9)),
    ),
    Published(
        "hemisphere", "hemisphere with a hole", "hemisphere_18deg_hole.csv",
        [Column("smaller_radial", "smaller_radial", 1, 1.0), Column("larger_radial", "larger_radial", 2, -1.0)],
        meshes(4, 4, (2, 3, 4, 6), (2, 3, 4), (2, 4, 6)),
    ),
    Published(
        "semi-cylinder", "pinched semi-cylinder", "pinched_semicylinder.csv",
        [Column("minus_w", "A", 3, -MM)],
        meshes(4, 4, (2, 3, 4, 5), (2, 3, 4), (4, 5)),
    ),
    Published(
        "hinged-roof", "hinged roof", "hinged_roof_h12p7.csv",
        [Column("minus_w_C", "C", 3, -MM)],
        meshes(2, 2, (1, 2, 4, 8), (1, 2, 4), (2, 4, 6)),
        allowed=0.02, by_displacement=True,
    ),
]  # fmt: skip
