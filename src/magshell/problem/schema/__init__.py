"""The problem file as data: which tables and keys there are, and what each may hold.

After reading, every quantity is in SI (angles of the mesh generators in degrees). What a single table cannot
know, such as whether a group exists, is checked in `magshell.problem.building`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar, get_args

from pydantic import BeforeValidator, Field

from magshell.problem import fields as f
from magshell.problem.schema.loading import (
    ClampTable,
    FieldTable,
    ForceTable,
    GravityTable,
    Load,
    MomentTable,
    PrescribeTable,
    PressureTable,
    SimpleTable,
    Support,
    SymmetryTable,
    TractionTable,
)
from magshell.problem.schema.material import Material, MooneyRivlin, NeoHookean, ShellTable, StVenantKirchhoff
from magshell.problem.schema.mesh import (
    Annulus,
    Block,
    Blocks,
    Cylinder,
    Mesh,
    MeshFile,
    Rectangle,
    Selection,
    SpherePatch,
    TheMesh,
)
from magshell.problem.schema.remanence import (
    CircumferentialRemanence,
    ConstantRemanence,
    CurveRemanence,
    DeformedRemanence,
    FileRemanence,
    FoldedRemanence,
    FoldTable,
    MeridionalRemanence,
    ProfileRemanence,
    RadialRemanence,
    Remanence,
    RolledRemanence,
    TangentialRemanence,
)
from magshell.problem.schema.solving import SolverTable, StageTable
from magshell.problem.schema.table import Table

__all__ = [
    "Annulus",
    "Block",
    "Blocks",
    "CircumferentialRemanence",
    "ClampTable",
    "ConstantRemanence",
    "CurveRemanence",
    "Cylinder",
    "DeformedRemanence",
    "FieldTable",
    "FileRemanence",
    "FoldTable",
    "FoldedRemanence",
    "ForceTable",
    "GravityTable",
    "Load",
    "Material",
    "MeridionalRemanence",
    "Mesh",
    "MeshFile",
    "MomentTable",
    "MooneyRivlin",
    "NeoHookean",
    "PrescribeTable",
    "PressureTable",
    "ProblemFile",
    "ProfileRemanence",
    "RadialRemanence",
    "Rectangle",
    "Remanence",
    "RolledRemanence",
    "Selection",
    "ShellTable",
    "SimpleTable",
    "SolverTable",
    "SpherePatch",
    "StVenantKirchhoff",
    "StageTable",
    "Support",
    "SymmetryTable",
    "Table",
    "TangentialRemanence",
    "TractionTable",
]


class ProblemFile(Table):
    """The whole file."""

    # Key that chooses among the kinds of a table, and where in the path of an error pydantic puts the choice.
    chosen_by: ClassVar[dict[str, tuple[str, int]]] = {
        "mesh": ("generator", 1),
        "material": ("law", 1),
        "remanence": ("kind", 2),
        "supports": ("kind", 2),
        "loads": ("kind", 2),
    }

    title: str = ""
    description: str = ""
    mesh: TheMesh
    shell: ShellTable
    material: Annotated[Material, Field(discriminator="law")]
    remanence: tuple[Annotated[Remanence, Field(discriminator="kind")], ...] = ()
    field: FieldTable = FieldTable(flux_density=(0.0, 0.0, 0.0))
    loads: tuple[Annotated[Load, Field(discriminator="kind")], ...] = ()
    supports: Annotated[tuple[Annotated[Support, Field(discriminator="kind")], ...], BeforeValidator(f.not_empty)]
    stages: tuple[StageTable, ...] = ()
    probes: dict[f.ProbeName, f.Position] = {}
    solver: SolverTable = SolverTable()

    def files(self) -> list[tuple[str, str]]:
        """Key, as in `remanence[1].file`, and name of every file that the problem names, in the order of the keys."""
        return list(_files(self, ""))


def _files(value: object, where: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, tuple):
        for number, entry in enumerate(value):
            yield from _files(entry, f"{where}[{number}]")
    if not isinstance(value, Table):
        return
    for key, field in type(value).model_fields.items():
        inside, path = getattr(value, key), f"{where}.{key}".lstrip(".")
        if isinstance(inside, str) and get_args(f.FileName)[1] in field.metadata:
            yield path, inside
        yield from _files(inside, path)
