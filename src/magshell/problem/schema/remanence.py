"""What the entries of `remanence` have in common."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, model_validator

from magshell.magnetics.remanence import REMANENCES
from magshell.problem import fields as f
from magshell.problem.schema.table import Table, key_error


class RemanenceTable(Table):
    """What the tables of all ways to magnetise have."""

    group: f.Names | None = None
    kind: str

    @model_validator(mode="after")
    def _goes_together(self) -> RemanenceTable:
        way = REMANENCES[self.kind]
        fault = way.fault(**way.values(self))
        if fault is not None:
            raise key_error(*fault)
        return self


class FoldTable(Table):
    """A fold of a flat part, sharp or with a radius."""

    through: f.Position
    along: f.Direction
    towards: f.Direction
    angle: f.Angle
    radius: f.NonNegativeLength = 0.0


Folds = Annotated[tuple[FoldTable, ...], BeforeValidator(f.not_empty)]
