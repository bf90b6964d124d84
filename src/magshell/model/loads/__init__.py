"""Mechanical loads: one kind per file, `load.py` says what a load is."""

from __future__ import annotations

from magshell.model.loads.force import Force
from magshell.model.loads.gravity import Gravity
from magshell.model.loads.load import Applied, Load, Pairs
from magshell.model.loads.moment import Moment
from magshell.model.loads.pressure import Pressure
from magshell.model.loads.traction import Traction

LOADS: dict[str, type[Load]] = {load.kind: load for load in (Force, Moment, Traction, Pressure, Gravity)}
"""The loads that problem files know, by their kind."""

__all__ = ["LOADS", "Applied", "Force", "Gravity", "Load", "Moment", "Pairs", "Pressure", "Traction"]
