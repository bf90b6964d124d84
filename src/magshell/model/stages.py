"""Stages of the load path: what drives each of them, and where it ends."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from magshell.arguments import instance, real, shown
from magshell.errors import InputError, suggest
from magshell.multipliers import spaced

CONTROLS = ("load", "arc-length", "displacement")


@dataclass(frozen=True)
class Stage:
    """A part of the load path.

    The load factor of a stage grows from 0, the loading where the stage before ended, to 1, the loading that the
    histories of field, loads and supports name for its end.

    Parameters
    ----------
    name : str, optional
        For messages and files.
    control : {"load", "arc-length", "displacement"}
        What is given: the load factor (where that fails, at a limit point, the stage goes on by arc length to the next
        stop); the length of the path from step to step, past any limit point until load factor 1 is reached; or the
        displacement of a probe, while the load factor is found.
    stops : sequence of float or int, optional
        Load factors in (0, 1) that the path must hit, in this order; 1 is always hit. A whole number: so many, evenly
        spaced.
    probe, component, target : str, int, float, optional
        A probe, one of its components (1, 2, 3) and the displacement (m) at which the stage ends. Needed under
        displacement control; with arc length, an end in place of load factor 1.
    branch : int, optional
        Start at this critical point of the path so far (from 1, as reported), along its mode, in place of the last
        state.
    side : {1, -1}, optional
        Which way along the mode.

    Raises
    ------
    InputError
        Unknown control, values out of range, parts that do not go together.
    """

    name: str = ""
    control: str = "load"
    stops: Sequence[float] | int = ()
    probe: str | None = None
    component: int | None = None
    target: float | None = None
    branch: int | None = None
    side: int = 1

    def __post_init__(self) -> None:
        instance("stage: name", self.name, str, "a text")
        where = f"stage '{self.name}'" if self.name else "stage"
        if self.control not in CONTROLS:
            raise InputError(f"{where}: control is '{self.control}'. {suggest(self.control, CONTROLS)}")
        stops = spaced(self.stops, 1.0, where)
        if isinstance(stops, str) or not isinstance(stops, Iterable):
            raise InputError(f"{where}: stops is {shown(stops)}; it must be a list of load factors, or how many")
        stops = tuple(real(f"{where}: stops[{number}]", stop) for number, stop in enumerate(stops))
        if any(not 0.0 < stop <= 1.0 for stop in stops) or any(b <= a for a, b in pairwise(stops)):
            raise InputError(f"{where}: stops are {list(stops)}; they must rise, from above 0 to at most 1")
        object.__setattr__(self, "stops", stops)
        parts = {"probe": self.probe, "component": self.component, "target": self.target}
        given = [name for name, value in parts.items() if value is not None]
        missing = [name for name, value in parts.items() if value is None]
        if given and self.control == "load":
            raise InputError(f"{where}: {given[0]} makes no sense under load control, which ends at load factor 1")
        if missing and (given or self.control == "displacement"):
            raise InputError(f"{where}: {missing[0]} is missing; a probe, a component and a target go together")
        if given and stops:
            raise InputError(f"{where}: stops are load factors; with a target there are none to hit")
        if self.component not in (None, 1, 2, 3):
            raise InputError(f"{where}: component is {self.component}; allowed are 1, 2, 3")
        if self.target is not None and not np.isfinite(self.target):
            raise InputError(f"{where}: target is {self.target}; it must be finite (m)")
        if self.branch is not None and (self.control != "arc-length" or self.branch < 1):
            raise InputError(
                f"{where}: branch is {self.branch}; it is the number of a critical point, from 1, and needs arc-length "
                "control"
            )
        if self.side not in (1, -1):
            raise InputError(f"{where}: side is {self.side}; allowed are 1 and -1")
