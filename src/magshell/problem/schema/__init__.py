"""The problem file as data: which tables and keys there are, and what each may hold.

After reading, every quantity is in SI (angles of the mesh generators in degrees). What a single table cannot
know, such as whether a group exists, is checked in `magshell.problem.building`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Union, get_args

from pydantic import BeforeValidator, Field, create_model

from magshell.materials import MATERIALS, keys_of
from magshell.model.loads import LOADS
from magshell.model.supports import SUPPORTS
from magshell.problem import fields as f
from magshell.problem.schema.described import table_of
from magshell.problem.schema.loading import FieldTable, LoadTable, SupportTable
from magshell.problem.schema.material import MaterialTable, ShellTable
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
    "ConstantRemanence",
    "CurveRemanence",
    "Cylinder",
    "DeformedRemanence",
    "FieldTable",
    "FileRemanence",
    "FoldTable",
    "FoldedRemanence",
    "LoadTable",
    "MaterialTable",
    "MeridionalRemanence",
    "Mesh",
    "MeshFile",
    "ProblemFile",
    "ProfileRemanence",
    "RadialRemanence",
    "Rectangle",
    "Remanence",
    "RolledRemanence",
    "Selection",
    "ShellTable",
    "SolverTable",
    "SpherePatch",
    "StageTable",
    "SupportTable",
    "Table",
    "TangentialRemanence",
    "load_tables",
    "material_tables",
    "problem_file",
    "support_tables",
]


class ProblemFile(Table):
    """The whole file; `problem_file` has the tables of all materials, loads and supports."""

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
    material: MaterialTable
    remanence: tuple[Annotated[Remanence, Field(discriminator="kind")], ...] = ()
    field: FieldTable = FieldTable(flux_density=(0.0, 0.0, 0.0))
    loads: tuple[LoadTable, ...] = ()
    supports: tuple[SupportTable, ...]
    stages: tuple[StageTable, ...] = ()
    probes: dict[f.ProbeName, f.Position] = {}
    solver: SolverTable = SolverTable()

    def files(self) -> list[tuple[str, str]]:
        """Key, as in `remanence[1].file`, and name of every file that the problem names, in the order of the keys."""
        return list(_files(self, ""))


def load_tables() -> dict[str, type[Table]]:
    """The tables of all loads, by kind."""
    return {name: table_of(load, load.keys, "kind", name, LoadTable) for name, load in LOADS.items()}


def support_tables() -> dict[str, type[Table]]:
    """The tables of all supports, by kind."""
    return {name: table_of(one, one.keys, "kind", name, SupportTable) for name, one in SUPPORTS.items()}


def material_tables() -> dict[str, type[Table]]:
    """The tables of all material laws, by name."""
    return {name: table_of(law, keys_of(law), "law", name, MaterialTable) for name, law in MATERIALS.items()}


def problem_file() -> type[ProblemFile]:
    """The model of a file, with the materials, loads and supports that are registered now."""
    return _problem_file(*(tuple(registry.items()) for registry in (MATERIALS, LOADS, SUPPORTS)))


@lru_cache(maxsize=1)
def _problem_file(*registered: tuple[tuple[str, type], ...]) -> type[ProblemFile]:
    entries: dict[str, Any] = {
        "material": (_one_of(material_tables(), "law"), ...),
        "loads": (_list_of(_one_of(load_tables(), "kind")), ()),
        "supports": (Annotated[_list_of(_one_of(support_tables(), "kind")), BeforeValidator(f.not_empty)], ...),
    }
    return create_model("ProblemFile", __base__=ProblemFile, **entries)


def _one_of(tables: Mapping[str, type[Table]], choice: str) -> Any:
    return Annotated[Union[tuple(tables.values())], Field(discriminator=choice)]  # noqa: UP007


def _list_of(entry: Any) -> Any:
    return tuple.__class_getitem__((entry, ...))


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
