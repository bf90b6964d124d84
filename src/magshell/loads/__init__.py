"""Mechanical loads: one kind per file, `load.py` says what a load is."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.loads.force import Force
from magshell.loads.gravity import Gravity
from magshell.loads.load import Applied, Load, Pairs
from magshell.loads.moment import Moment
from magshell.loads.pressure import Pressure
from magshell.loads.traction import Traction

__all__ = ["Applied", "Force", "Gravity", "Load", "Moment", "Pairs", "Pressure", "Traction"]


def nodal_forces(mesh: Any, element: Any, loads: Sequence[Any]) -> FloatArray:
    """External forces (nodes, 10) of dead loads."""
    carriers = element.carriers(mesh.elements, len(mesh.points))
    shell: Any = SimpleNamespace(mesh=mesh, element=element, micro_rotation=True, carriers=carriers)
    nodal = np.zeros((len(mesh.points), 10))
    for load in loads:
        nodal += load.applied(shell, np.zeros((0, 3))).forces(None)
    return nodal
