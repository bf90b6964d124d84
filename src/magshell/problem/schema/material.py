"""The table `shell`, and what the tables `material` have in common."""

from __future__ import annotations

from typing import Literal

from pydantic import StrictBool

from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class ShellTable(Table):
    """What the surface is made into."""

    thickness: f.PositiveLength
    density: f.PositiveDensity | None = None
    element: f.Element = "quadratic"
    thickness_stretch: Literal["linear", "none", "plane-stress"] = "linear"
    micro_rotation: StrictBool = True


class MaterialTable(Table):
    """What the tables of all material laws have."""

    law: str
    shear_modulus: f.PositiveStress
    lame_lambda: f.NonNegativeStress
    coupling_modulus: f.NonNegativeStress | None = None
    length_scale: f.PositiveLength | None = None
