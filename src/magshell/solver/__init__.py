"""Solution: Newton's method, path following, the resulting path."""

from magshell.solver.critical import CriticalPoint
from magshell.solver.events import Iteration, Observer
from magshell.solver.path import Path, Probe, SolveError
from magshell.solver.settings import Settings
from magshell.solver.step import Step
from magshell.solver.stepping import resume, solve

__all__ = [
    "CriticalPoint",
    "Iteration",
    "Observer",
    "Path",
    "Probe",
    "Settings",
    "SolveError",
    "Step",
    "resume",
    "solve",
]
