"""Solution: Newton's method, path following, the resulting path."""

from magshell.solver.critical import CriticalPoint
from magshell.solver.events import Iteration, Observer
from magshell.solver.path import Path, Probe, Step
from magshell.solver.settings import Settings
from magshell.solver.stepping import resume, solve

__all__ = ["CriticalPoint", "Iteration", "Observer", "Path", "Probe", "Settings", "Step", "resume", "solve"]
