"""What the tables `material` have in common."""

from __future__ import annotations

from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class MaterialTable(Table):
    """What the tables of all material laws have."""

    law: str
    shear_modulus: f.PositiveStress
    lame_lambda: f.NonNegativeStress
    coupling_modulus: f.NonNegativeStress | None = None
    length_scale: f.PositiveLength | None = None
