"""What the entries of `regions` and `layers` have in common, and thickness that varies."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, StrictBool, Tag, model_validator

from magshell.errors import InputError
from magshell.problem import fields as f
from magshell.problem.schema.material import MaterialTable
from magshell.problem.schema.remanence import RemanenceTable
from magshell.problem.schema.table import Table, key_error


class ThicknessProfile(Table):
    """Thickness that is piecewise linear along a direction."""

    along: f.Direction
    positions: f.Positions
    values: Annotated[tuple[f.PositiveLength, ...], BeforeValidator(f.not_empty)]

    @model_validator(mode="after")
    def _goes_together(self) -> ThicknessProfile:
        if any(later <= earlier for earlier, later in zip(self.positions, self.positions[1:], strict=False)):
            raise key_error("positions", "do not rise")
        if len(self.values) != len(self.positions):
            raise key_error("values", f"has {len(self.values)} entries; there are {len(self.positions)} positions")
        return self


class ThicknessFile(Table):
    """Thickness from a table of numbers."""

    file: f.FileName
    thickness_unit: f.LengthUnit
    length_unit: f.LengthUnit | None = None
    stepped: StrictBool = False
    tolerance: f.PositiveLength | None = None


def _which(data: Any) -> str:
    if isinstance(data, ThicknessFile) or (isinstance(data, dict) and "file" in data):
        return "file"
    return "profile" if isinstance(data, dict | ThicknessProfile) else "length"


def _file_or_profile(data: Any) -> Any:
    if isinstance(data, dict) and "file" not in data and "along" not in data:
        raise InputError("is a table without file and along; give one of them, or a length")
    return data


Thickness = Annotated[
    Annotated[f.PositiveLength, Tag("length")]
    | Annotated[ThicknessProfile, Tag("profile")]
    | Annotated[ThicknessFile, Tag("file")],
    Discriminator(_which),
    BeforeValidator(_file_or_profile),
]


class LayerTable(Table):
    """A layer of the thickness."""

    thickness: Thickness
    material: MaterialTable
    remanence: tuple[RemanenceTable, ...] = ()
    density: f.PositiveDensity | None = None


class RegionTable(Table):
    """Elements with properties of their own."""

    group: f.Names
    thickness: Thickness | None = None
    material: MaterialTable | None = None
    remanence: tuple[RemanenceTable, ...] | None = None
    density: f.PositiveDensity | None = None
    layers: tuple[LayerTable, ...] = ()
    offset: f.Offset | None = None
    levels: f.Levels | None = None

    @model_validator(mode="after")
    def _layers_have_their_own(self) -> RegionTable:
        for key in ("thickness", "material", "remanence"):
            if self.layers and getattr(self, key) is not None:
                raise key_error(key, "is given beside layers; each layer has its own")
        return self
