"""The table `field`, and what the entries of `supports`, `springs` and `loads` have in common."""

from __future__ import annotations

import math

from pydantic import model_validator

from magshell.magnetics.remanence.vectors import given_once
from magshell.problem import fields as f
from magshell.problem.schema.sources import CoilSystemTable, GradientTable, SampledTable
from magshell.problem.schema.table import Table, key_error


class FieldTable(Table):
    """The external field."""

    flux_density: f.FluxVector | None = None
    magnitude: f.PositiveFluxDensity | None = None
    direction: f.Direction | None = None
    history: f.History | None = None
    rotation_axis: f.Direction | None = None
    rotation: f.Rotation | None = None
    stops: f.FieldStops = ()
    coupling: f.Coupling = "couple"
    gradient: GradientTable | None = None
    sampled: SampledTable | None = None
    coils: CoilSystemTable | None = None
    spline_spacing: f.PositiveLength | None = None
    self_field: bool = False

    @property
    def varies(self) -> bool:
        """Whether there is more than the uniform part."""
        return self.self_field or any(part is not None for part in (self.gradient, self.sampled, self.coils))

    @property
    def uniform_fault(self) -> tuple[str, str] | None:
        """Key and fault of the uniform part; that it is missing matters where nothing else makes a field."""
        return given_once("flux_density", self.flux_density, self.magnitude, self.direction)

    @property
    def vector(self) -> tuple[float, float, float]:
        """The flux density at multiplier 1, T, however it is given."""
        if self.magnitude is None or self.direction is None:
            return self.flux_density or (0.0, 0.0, 0.0)
        x1, x2, x3 = (self.magnitude * component / math.hypot(*self.direction) for component in self.direction)
        return x1, x2, x3

    @model_validator(mode="after")
    def _is_given_once(self) -> FieldTable:
        if self.uniform_fault is not None and {"flux_density", "magnitude", "direction"} & self.model_fields_set:
            raise key_error(*self.uniform_fault)
        return self

    @model_validator(mode="after")
    def _axis_and_angles_go_together(self) -> FieldTable:
        if self.rotation is not None and self.rotation_axis is None:
            raise key_error("rotation_axis", "is missing beside rotation")
        if self.rotation is None and self.rotation_axis is not None:
            raise key_error("rotation", "is missing beside rotation_axis")
        return self

    @model_validator(mode="after")
    def _stops_lie_on_the_way(self) -> FieldTable:
        end = math.hypot(*self.vector) * max(map(abs, self.history or (1.0,)))
        stops = () if isinstance(self.stops, int) else self.stops
        for number, stop in enumerate(stops):
            if stop > end * (1.0 + 1e-12):
                raise key_error(f"stops[{number}]", f"{stop:g} T lies beyond the largest field of the path, {end:g} T")
            if number and stop <= stops[number - 1]:
                raise key_error(f"stops[{number}]", "does not exceed the one before; stops must rise")
        return self


class SupportTable(Table):
    """What the tables of all supports have."""

    kind: str
    group: f.Name


class SpringTable(Table):
    """What the tables of all springs have."""

    kind: str
    group: f.Name


class RepeatedTable(Table):
    """What the tables of all repetitions have."""

    kind: str
    group: f.Name
    image: f.Name


class LoadTable(Table):
    """What the tables of all loads have."""

    kind: str
