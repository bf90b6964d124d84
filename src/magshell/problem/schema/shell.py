"""The table `shell`."""

from __future__ import annotations

from typing import Literal

from pydantic import StrictBool, model_validator

from magshell.problem import fields as f
from magshell.problem.schema.region import LayerTable, Thickness
from magshell.problem.schema.table import Table, key_error


class ShellTable(Table):
    """What the surface is made into."""

    thickness: Thickness | None = None
    density: f.PositiveDensity | None = None
    layers: tuple[LayerTable, ...] = ()
    offset: f.Offset = "middle"
    levels: f.Levels = 2
    element: f.Element = "quadratic"
    thickness_stretch: Literal["linear", "none", "plane-stress"] = "linear"
    micro_rotation: StrictBool = True

    @model_validator(mode="after")
    def _layers_have_their_own(self) -> ShellTable:
        if self.layers and self.thickness is not None:
            raise key_error("thickness", "is given beside layers; each layer has its own")
        return self
