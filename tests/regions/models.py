"""A small strip with groups, and rubbers of which its regions are made."""

from __future__ import annotations

from typing import Any

import numpy as np

import magshell as ms
from magshell.mesh import Mesh

LENGTH, WIDTH, THICKNESS = 20e-3, 5e-3, 1e-3
SOFT = ms.MicropolarNeoHookean(100e3, 400e3, 100e3, 1e-5)
STIFF = ms.MicropolarMooneyRivlin(300e3, 900e3, 300e3, 1e-5)
ALONG = ms.remanence.constant([0.1, 0.0, 0.0])
FIELD = ms.UniformField([0.0, 0.0, 2e-3])


def strip(elements: tuple[int, int] = (4, 1)) -> Mesh:
    """Its inner and outer half are groups."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    half = 0.5 * LENGTH
    return mesh.select_elements("inner", x1=(0, half)).select_elements("outer", x1=(half, LENGTH))


def of_regions(*regions: ms.Region, **options: Any) -> ms.Shell:
    """The strip of a soft rubber with some regions."""
    defaults = {"thickness": THICKNESS, "material": SOFT, "remanence": ALONG}
    return ms.Shell(strip(), **{**defaults, **options}, regions=regions)


def solved(shell: ms.Shell, **options: Any) -> np.ndarray:
    """Displacements (nodes, 3) of the clamped strip in the field."""
    path = ms.solve(ms.Model(shell, [ms.Clamp("left")], FIELD, **options), ms.Settings(tolerance=1e-12))
    return path.steps[-1].state.displacement(len(shell.mesh.points))
