"""The tables `shell` and `material`."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import StrictBool

from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class ShellTable(Table):
    """What the surface is made into."""

    thickness: f.PositiveLength
    density: f.PositiveDensity | None = None
    element: Literal["quadratic", "paper", "paper-unenhanced", "paper-39"] = "quadratic"
    thickness_stretch: Literal["linear", "none", "plane-stress"] = "linear"
    micro_rotation: StrictBool = True


class _Material(Table):
    shear_modulus: f.PositiveStress
    lame_lambda: f.NonNegativeStress
    coupling_modulus: f.NonNegativeStress | None = None
    length_scale: f.PositiveLength | None = None


class NeoHookean(_Material):
    """Micropolar neo-Hookean material."""

    law: Literal["micropolar-neo-hookean"]


class MooneyRivlin(_Material):
    """Micropolar Mooney–Rivlin material."""

    law: Literal["micropolar-mooney-rivlin"]
    second_invariant_share: f.Number = 0.25


class StVenantKirchhoff(_Material):
    """Micropolar St Venant–Kirchhoff material."""

    law: Literal["micropolar-st-venant-kirchhoff"]


Material: TypeAlias = NeoHookean | MooneyRivlin | StVenantKirchhoff
