"""The table `field` and the entries of `supports` and `loads`."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import StrictBool, ValidationInfo, field_validator, model_validator

from magshell.problem import fields as f
from magshell.problem.schema.table import Table, key_error


class FieldTable(Table):
    """The external field."""

    flux_density: f.FluxVector
    history: f.History | None = None
    rotation_axis: f.Direction | None = None
    rotation: f.Rotation | None = None
    stops: tuple[f.PositiveFluxDensity, ...] = ()
    coupling: Literal["couple", "micro-rotation", "deformation-gradient"] = "couple"

    @model_validator(mode="after")
    def _axis_and_angles_go_together(self) -> FieldTable:
        if self.rotation is not None and self.rotation_axis is None:
            raise key_error("rotation_axis", "is missing beside rotation")
        if self.rotation is None and self.rotation_axis is not None:
            raise key_error("rotation", "is missing beside rotation_axis")
        return self

    @model_validator(mode="after")
    def _stops_lie_on_the_way(self) -> FieldTable:
        end = sum(component**2 for component in self.flux_density) ** 0.5 * max(map(abs, self.history or (1.0,)))
        for number, stop in enumerate(self.stops):
            if stop > end * (1.0 + 1e-12):
                raise key_error(f"stops[{number}]", f"{stop:g} T lies beyond the largest field of the path, {end:g} T")
            if number and stop <= self.stops[number - 1]:
                raise key_error(f"stops[{number}]", "does not exceed the one before; stops must rise")
        return self


class _Support(Table):
    group: f.Name


class ClampTable(_Support):
    """No displacement, no rotation; the thickness stretch stays free."""

    kind: Literal["clamp"]


class SimpleTable(_Support):
    """No displacement."""

    kind: Literal["simple"]


class SymmetryTable(_Support):
    """Mirror plane with this normal."""

    kind: Literal["symmetry"]
    normal: f.Direction


class PrescribeTable(_Support):
    """A nodal field, or one component of it, that reaches `value`."""

    kind: Literal["prescribe"]
    field: Literal["u", "w", "phi", "omega"]
    component: Literal[1, 2, 3] | None = None
    value: float | tuple[float, float, float] = 0.0
    history: f.History | None = None

    @field_validator("value", mode="before")
    @classmethod
    def _has_the_unit_of_the_field(cls, value: object, info: ValidationInfo) -> object:
        if "field" not in info.data:
            return 0.0
        one = info.data["field"] == "phi" or info.data.get("component") is not None
        return f.prescribed_value(value, info.data["field"], one)

    @model_validator(mode="after")
    def _phi_is_a_scalar(self) -> PrescribeTable:
        if self.field == "phi" and self.component is not None:
            raise key_error("component", "makes no sense with the field phi, which has only one; leave it out")
        return self


class _Load(Table):
    history: f.History | None = None


class ForceTable(_Load):
    """A force, dead or turning with the micro-rotation."""

    kind: Literal["force"]
    group: f.Name
    total: f.ForceVector
    follower: StrictBool = False


class MomentTable(_Load):
    """A moment on the micro-rotation, dead or turning with it, or on the director."""

    kind: Literal["moment"]
    group: f.Name
    total: f.MomentVector
    follower: StrictBool = False


class TractionTable(_Load):
    """A dead force per undeformed area."""

    kind: Literal["traction"]
    group: f.Name
    traction: f.StressVector


class PressureTable(_Load):
    """A pressure along the deformed normal."""

    kind: Literal["pressure"]
    group: f.Name
    pressure: f.Pressure


class GravityTable(_Load):
    """Weight."""

    kind: Literal["gravity"]
    acceleration: f.AccelerationVector
    group: f.Name | None = None


Support: TypeAlias = ClampTable | SimpleTable | SymmetryTable | PrescribeTable
Load: TypeAlias = ForceTable | MomentTable | TractionTable | PressureTable | GravityTable
