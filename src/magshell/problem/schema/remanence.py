"""The entries of `remanence`."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import BeforeValidator, StrictBool, model_validator

from magshell.problem import fields as f
from magshell.problem.schema.table import Table, key_error


class _Remanence(Table):
    group: f.Names | None = None


class ConstantRemanence(_Remanence):
    """The same vector everywhere, given as it is or as a magnitude along a direction."""

    kind: Literal["constant"]
    vector: f.FluxVector | None = None
    magnitude: f.PositiveFluxDensity | None = None
    direction: f.Direction | None = None

    @model_validator(mode="after")
    def _is_given_once(self) -> ConstantRemanence:
        polar = (self.magnitude is not None, self.direction is not None)
        if self.vector is None and polar == (False, False):
            raise key_error("vector", "is missing; give it, or magnitude and direction")
        if self.vector is not None and any(polar):
            raise key_error("vector", "is given beside magnitude or direction; give one or the other")
        if self.vector is None and not all(polar):
            present, missing = ("magnitude", "direction") if polar[0] else ("direction", "magnitude")
            raise key_error(missing, f"is missing beside {present}")
        return self


class MeridionalRemanence(_Remanence):
    """Along the meridians of a sphere, away from the pole on the +axis side, mirrored at the equator."""

    kind: Literal["meridional"]
    magnitude: f.PositiveFluxDensity
    axis: f.Direction = (0.0, 0.0, 1.0)
    mirrored: StrictBool = True


class CircumferentialRemanence(_Remanence):
    """Around an axis; with `towards`, in the sense that has a positive component along it."""

    kind: Literal["circumferential"]
    magnitude: f.PositiveFluxDensity
    axis: f.Direction = (0.0, 0.0, 1.0)
    towards: f.Direction | None = None


class RadialRemanence(_Remanence):
    """Away from an axis, or towards it."""

    kind: Literal["radial"]
    magnitude: f.PositiveFluxDensity
    axis: f.Direction = (0.0, 0.0, 1.0)
    through: f.Position = (0.0, 0.0, 0.0)
    inward: StrictBool = False


class TangentialRemanence(_Remanence):
    """In the surface, along a direction laid into its tangent plane."""

    kind: Literal["tangential"]
    magnitude: f.PositiveFluxDensity
    direction: f.Direction


class CurveRemanence(_Remanence):
    """Along a group of edges; with `towards`, in the sense that has a positive component along it."""

    kind: Literal["along-curve"]
    curve: f.Name
    magnitude: f.PositiveFluxDensity
    towards: f.Direction | None = None


class ProfileRemanence(_Remanence):
    """Magnitude and angle as piecewise linear tables over a coordinate."""

    kind: Literal["profile"]
    along: f.Direction
    positions: f.Positions
    magnitude: f.FluxDensities
    direction: f.Direction
    angle: f.Angles = (0.0,)
    towards: f.Direction | None = None
    origin: f.Position = (0.0, 0.0, 0.0)


class FileRemanence(_Remanence):
    """From a table of places or of elements, or an array."""

    kind: Literal["file"]
    file: f.FileName
    flux_density_unit: f.FluxDensityUnit
    length_unit: f.LengthUnit | None = None
    tolerance: f.PositiveLength | None = None


class _Template(_Remanence):
    magnitude: f.PositiveFluxDensity
    direction: f.Direction


class RolledRemanence(_Template):
    """Magnetised while the flat part was wrapped about a cylinder."""

    kind: Literal["rolled"]
    radius: f.PositiveLength
    through: f.Position
    along: f.Direction
    towards: f.Direction


class FoldTable(Table):
    """A fold of a flat part, sharp or with a radius."""

    through: f.Position
    along: f.Direction
    towards: f.Direction
    angle: f.Angle
    radius: f.NonNegativeLength = 0.0


class FoldedRemanence(_Template):
    """Magnetised while the flat part was folded."""

    kind: Literal["folded"]
    folds: Annotated[tuple[FoldTable, ...], BeforeValidator(f.not_empty)]


class DeformedRemanence(_Template):
    """Magnetised while the part was deformed, with displacements from a table or an array."""

    kind: Literal["deformed"]
    displacements: f.FileName
    length_unit: f.LengthUnit


Template: TypeAlias = RolledRemanence | FoldedRemanence | DeformedRemanence
Remanence: TypeAlias = (
    ConstantRemanence
    | MeridionalRemanence
    | CircumferentialRemanence
    | RadialRemanence
    | TangentialRemanence
    | CurveRemanence
    | ProfileRemanence
    | FileRemanence
    | Template
)
