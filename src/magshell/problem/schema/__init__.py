"""The problem file as data: which tables and keys there are, and what each may hold.

After reading, every quantity is in SI (angles of the mesh generators in degrees). What a single table cannot
know, such as whether a group exists, is checked in `magshell.problem.building`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Union, get_args

from pydantic import BeforeValidator, Field, create_model, model_validator

from magshell.magnetics.fields import COILS, MAGNETS
from magshell.magnetics.remanence import REMANENCES
from magshell.materials import MATERIALS, keys_of, names_of
from magshell.model.loads import LOADS
from magshell.model.repeated import REPEATED
from magshell.model.springs import SPRINGS
from magshell.model.supports import SUPPORTS
from magshell.problem import fields as f
from magshell.problem.schema.described import table_of
from magshell.problem.schema.joints import HingeTable, RigidTable
from magshell.problem.schema.loading import FieldTable, LoadTable, RepeatedTable, SpringTable, SupportTable
from magshell.problem.schema.material import MaterialTable
from magshell.problem.schema.mesh import (
    Annulus,
    Block,
    Blocks,
    Cylinder,
    Elements,
    Mesh,
    MeshFile,
    Miura,
    Polygon,
    Profile,
    Rectangle,
    Round,
    Selection,
    Sphere,
    SpherePatch,
    TheMesh,
    Wall,
)
from magshell.problem.schema.region import LayerTable, RegionTable, ThicknessFile, ThicknessProfile
from magshell.problem.schema.remanence import FoldTable, RemanenceTable
from magshell.problem.schema.shell import ShellTable
from magshell.problem.schema.solving import ResultsTable, SolverTable, StageTable
from magshell.problem.schema.sources import (
    CoilSystemTable,
    CoilTable,
    GradientTable,
    MagnetTable,
    MotionTable,
    SampledTable,
    SourceTable,
)
from magshell.problem.schema.table import Table, key_error

__all__ = [
    "Annulus",
    "Block",
    "Blocks",
    "CoilSystemTable",
    "CoilTable",
    "Cylinder",
    "Elements",
    "FieldTable",
    "FoldTable",
    "GradientTable",
    "HingeTable",
    "LayerTable",
    "LoadTable",
    "MagnetTable",
    "MaterialTable",
    "Mesh",
    "MeshFile",
    "Miura",
    "MotionTable",
    "Polygon",
    "ProblemFile",
    "Profile",
    "Rectangle",
    "RegionTable",
    "RemanenceTable",
    "RepeatedTable",
    "ResultsTable",
    "RigidTable",
    "Round",
    "SampledTable",
    "Selection",
    "ShellTable",
    "SolverTable",
    "SourceTable",
    "Sphere",
    "SpherePatch",
    "SpringTable",
    "StageTable",
    "SupportTable",
    "Table",
    "ThicknessFile",
    "ThicknessProfile",
    "Wall",
    "coil_tables",
    "load_tables",
    "magnet_tables",
    "material_tables",
    "problem_file",
    "remanence_tables",
    "repeated_tables",
    "spring_tables",
    "support_tables",
]


class ProblemFile(Table):
    """The whole file; `problem_file` has the tables of all that is registered."""

    # Key that chooses among the kinds of a table, by where the table stands; where there is none, its form chooses.
    chosen_by: ClassVar[dict[str, str]] = {
        "mesh": "generator",
        "supports[]": "kind",
        "springs[]": "kind",
        "repeated[]": "kind",
        "loads[]": "kind",
        "magnets[]": "shape",
        "coils[]": "shape",
        "field.stops": "",
        "stages[].stops": "",
        "material": "law",
        "remanence[]": "kind",
        **{f"{place}thickness": "" for place in ("shell.", "shell.layers[].", "regions[].", "regions[].layers[].")},
        **{f"{place}material": "law" for place in ("shell.layers[].", "regions[].", "regions[].layers[].")},
        **{f"{place}remanence[]": "kind" for place in ("shell.layers[].", "regions[].", "regions[].layers[].")},
    }

    # Tables of what is registered, and the whole, by the names of their classes.
    classes: ClassVar[dict[str, type[Table]]] = {}

    title: str = ""
    description: str = ""
    mesh: TheMesh
    shell: ShellTable = ShellTable()
    material: MaterialTable | None = None
    regions: tuple[RegionTable, ...] = ()
    remanence: tuple[RemanenceTable, ...] = ()
    field: FieldTable = FieldTable(flux_density=(0.0, 0.0, 0.0))
    magnets: tuple[MagnetTable, ...] = ()
    coils: tuple[CoilTable, ...] = ()
    loads: tuple[LoadTable, ...] = ()
    supports: tuple[SupportTable, ...] = ()
    springs: tuple[SpringTable, ...] = ()
    rigid: tuple[RigidTable, ...] = ()
    hinges: tuple[HingeTable, ...] = ()
    repeated: tuple[RepeatedTable, ...] = ()
    stages: tuple[StageTable, ...] = ()
    probes: dict[f.ProbeName, f.Position] = {}
    results: ResultsTable = ResultsTable()
    solver: SolverTable = SolverTable()

    @model_validator(mode="after")
    def _is_held(self) -> ProblemFile:
        if not self.supports and not self.springs:
            raise key_error("supports", "is missing")
        return self

    @model_validator(mode="after")
    def _field_is_of_something(self) -> ProblemFile:
        fault = self.field.uniform_fault
        if "field" in self.model_fields_set and fault and not (self.field.varies or self.magnets or self.coils):
            raise key_error(f"field.{fault[0]}", fault[1])
        return self

    @model_validator(mode="after")
    def _is_made_of_something(self) -> ProblemFile:
        layers = bool(self.shell.layers)
        for key in ("material", "remanence"):
            if layers and getattr(self, key):
                raise key_error(key, "is given beside shell.layers; each layer has its own")
        if layers or self.regions:
            return self
        if "shell" not in self.model_fields_set:
            raise key_error("shell", "is missing")
        if self.shell.thickness is None:
            raise key_error("shell.thickness", "is missing, and shell.layers as well")
        if self.material is None:
            raise key_error("material", "is missing")
        return self

    def files(self) -> list[tuple[str, str]]:
        """Key, as in `remanence[1].file`, and name of every file that the problem names, in the order of the keys."""
        return list(_files(self, ""))


def material_tables() -> dict[str, type[Table]]:
    """The tables of all material laws, by name."""
    return {name: table_of("law", names_of(name), law, keys_of(law), MaterialTable) for name, law in MATERIALS.items()}


def remanence_tables() -> dict[str, type[Table]]:
    """The tables of all ways to magnetise, by kind."""
    return {name: table_of("kind", (name,), way.make, way.keys, RemanenceTable) for name, way in REMANENCES.items()}


def load_tables() -> dict[str, type[Table]]:
    """The tables of all loads, by kind."""
    return {name: table_of("kind", (name,), load, load.keys, LoadTable) for name, load in LOADS.items()}


def support_tables() -> dict[str, type[Table]]:
    """The tables of all supports, by kind."""
    return {name: table_of("kind", (name,), one, one.all_keys(), SupportTable) for name, one in SUPPORTS.items()}


def spring_tables() -> dict[str, type[Table]]:
    """The tables of all springs, by kind."""
    return {name: table_of("kind", (name,), one, one.keys, SpringTable) for name, one in SPRINGS.items()}


def repeated_tables() -> dict[str, type[Table]]:
    """The tables of all repetitions, by kind."""
    return {name: table_of("kind", (name,), one, one.keys, RepeatedTable) for name, one in REPEATED.items()}


def magnet_tables() -> dict[str, type[Table]]:
    """The tables of all magnets, by shape."""
    return {name: table_of("shape", (name,), one.make, one.keys, MagnetTable) for name, one in MAGNETS.items()}


def coil_tables() -> dict[str, type[Table]]:
    """The tables of all coils, by shape."""
    return {name: table_of("shape", (name,), one.make, one.keys, CoilTable) for name, one in COILS.items()}


def problem_file() -> type[ProblemFile]:
    """The model of a file, with all that is registered now."""
    registries = (MATERIALS, REMANENCES, LOADS, SUPPORTS, SPRINGS, REPEATED, MAGNETS, COILS)
    return _problem_file(*(tuple(registry.items()) for registry in registries))


@lru_cache(maxsize=1)
def _problem_file(*registered: tuple[tuple[str, Any], ...]) -> type[ProblemFile]:
    laws, ways, loads = material_tables(), remanence_tables(), load_tables()
    supports, springs, repeated = support_tables(), spring_tables(), repeated_tables()
    magnets, coils = magnet_tables(), coil_tables()
    law, magnetised = _one_of(laws, "law"), _list_of(_one_of(ways, "kind"))
    layer = create_model("LayerTable", __base__=LayerTable, material=(law, ...), remanence=(magnetised, ()))
    layers: dict[str, Any] = {"layers": (_list_of(layer), ())}
    shell = create_model("ShellTable", __base__=ShellTable, **layers)
    region = create_model(
        "RegionTable", __base__=RegionTable, material=(law | None, None), remanence=(magnetised | None, None), **layers
    )
    entries: dict[str, Any] = {
        "shell": (shell, shell()),
        "material": (law | None, None),
        "regions": (_list_of(region), ()),
        "remanence": (magnetised, ()),
        "loads": (_list_of(_one_of(loads, "kind")), ()),
        "supports": (Annotated[_list_of(_one_of(supports, "kind")), BeforeValidator(f.not_empty)], ()),
        "magnets": (_list_of(_one_of(magnets, "shape")), ()),
        "coils": (_list_of(_one_of(coils, "shape")), ()),
        "springs": (_list_of(_one_of(springs, "kind")), ()),
        "repeated": (_list_of(_one_of(repeated, "kind")), ()),
    }
    made = create_model("ProblemFile", __base__=ProblemFile, **entries)
    tables: tuple[type[Table], ...] = (made, shell, region, layer)
    tables += tuple(
        table for kinds in (laws, ways, loads, supports, springs, repeated, magnets, coils) for table in kinds.values()
    )
    made.classes = {table.__name__: table for table in tables}
    for table in tables:  # pickle finds classes in modules only
        setattr(table, "__reduce__", _pickled)  # noqa: B010
    return made


def _pickled(table: Table) -> tuple[Any, ...]:
    return _restored, (type(table).__name__, table.__getstate__())


def _restored(name: str, state: dict[Any, Any]) -> Table:
    table = problem_file().classes[name]
    restored: Table = table.__new__(table)
    restored.__setstate__(state)
    return restored


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
