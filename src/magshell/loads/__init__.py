"""Mechanical loads: one kind per file, `load.py` says what a load is."""

from __future__ import annotations

from magshell.loads.force import Force
from magshell.loads.gravity import Gravity
from magshell.loads.load import Applied, Load, Pairs
from magshell.loads.moment import Moment
from magshell.loads.pressure import Pressure
from magshell.loads.traction import Traction

__all__ = ["Applied", "Force", "Gravity", "Load", "Moment", "Pairs", "Pressure", "Traction"]
