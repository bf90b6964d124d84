"""What the tables `material` have in common."""

from __future__ import annotations

from pydantic import model_validator

from magshell.materials import MODULI, lame_of
from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class MaterialTable(Table):
    """What the tables of all material laws have: two of the five moduli, and what the micro-rotation needs."""

    law: str
    shear_modulus: f.PositiveStress | None = None
    lame_lambda: f.NonNegativeStress | None = None
    youngs_modulus: f.PositiveStress | None = None
    poissons_ratio: f.Number | None = None
    bulk_modulus: f.PositiveStress | None = None
    coupling_modulus: f.CouplingModulus | None = None
    length_scale: f.LengthScale | None = None

    @model_validator(mode="after")
    def _has_two_moduli(self) -> MaterialTable:
        _ = self.lame
        return self

    @property
    def lame(self) -> tuple[float, float]:
        """Shear modulus and Lamé constant, Pa."""
        return lame_of({name: getattr(self, name) for name in MODULI})
