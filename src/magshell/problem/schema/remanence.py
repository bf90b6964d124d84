"""The entries of `remanence`."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import StrictBool, model_validator

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


Remanence: TypeAlias = ConstantRemanence | MeridionalRemanence | CircumferentialRemanence
