"""Tables of what makes a field that varies in space: magnets, coils, gradients, grids; and how they move."""

from __future__ import annotations

from pydantic import model_validator

from magshell.problem import fields as f
from magshell.problem.schema.table import Table, key_error

ORIGIN = (0.0, 0.0, 0.0)


class MotionTable(Table):
    """What varies along the path: strength, place and angle, at the end of each stage."""

    name: f.ProbeName | None = None
    history: f.History | None = None
    displacement: f.Displacements | None = None
    rotation_axis: f.Direction | None = None
    rotation: f.Rotation | None = None
    rotation_centre: f.Position | None = None

    @model_validator(mode="after")
    def _axis_and_angles_go_together(self) -> MotionTable:
        for one, other in (
            ("rotation", "rotation_axis"),
            ("rotation_axis", "rotation"),
            ("rotation_centre", "rotation"),
        ):
            if getattr(self, one) is not None and getattr(self, other) is None:
                raise key_error(other, f"is missing beside {one}")
        return self


class SourceTable(MotionTable):
    """What the tables of all magnets and coils have."""

    shape: str
    position: f.Position = ORIGIN
    orientation_axis: f.Direction | None = None
    orientation: f.Angle | None = None

    @model_validator(mode="after")
    def _axis_and_angle_go_together(self) -> SourceTable:
        for one, other in (("orientation", "orientation_axis"), ("orientation_axis", "orientation")):
            if getattr(self, one) is not None and getattr(self, other) is None:
                raise key_error(other, f"is missing beside {one}")
        return self


class MagnetTable(SourceTable):
    """What the tables of all magnets have."""


class CoilTable(SourceTable):
    """What the tables of all coils have."""


class GradientTable(MotionTable):
    """A constant gradient."""

    tensor: f.GradientTensor
    centre: f.Position = ORIGIN


class SampledTable(MotionTable):
    """B on a grid, from a file."""

    file: f.FileName
    flux_density_unit: f.FluxDensityUnit
    length_unit: f.LengthUnit


class CoilSystemTable(Table):
    """Coils by their calibration."""

    name: f.ProbeName | None = None
    calibration: f.FileName
    currents: f.Currents
    centre: f.Position = ORIGIN
