"""Solution: Newton's method, load stepping, the resulting path."""

from magshell.solve.events import Iteration, Observer
from magshell.solve.path import Path, Probe, Step
from magshell.solve.settings import Settings
from magshell.solve.stepping import solve

__all__ = ["Iteration", "Observer", "Path", "Probe", "Settings", "Step", "solve"]
