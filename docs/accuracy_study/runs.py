"""Solves, one at a time, that are kept in a file and never made twice."""

from __future__ import annotations

import math
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Protocol

import numpy as np
from element_study.runs import Store

import magshell as ms

FILE = pathlib.Path(__file__).parents[2] / "results" / "accuracy-study" / "runs.json"


class Specimen(Protocol):
    """Something to solve: a dataclass whose attributes say all about it."""

    fields: tuple[float, ...]
    """Fields to be hit, mT, rising."""

    @property
    def settings(self) -> ms.Settings:
        """How its path is followed."""

    def model(self) -> ms.Model:
        """Its model; the last of the fields is load factor 1."""


@dataclass(frozen=True)
class Run:
    """A load path.

    Attributes
    ----------
    unknowns, elements, solves, cuts : int
    cpu : float
        s.
    reason : str
        Why the path ended early; "" where it did not.
    fields : sequence of float
        Of all converged steps, mT.
    probes : dict of str to list of (3,)
        Displacements at all converged steps, mm.
    """

    unknowns: int
    elements: int
    solves: int
    cuts: int
    cpu: float
    reason: str
    fields: Sequence[float]
    probes: dict[str, list[list[float]]]

    def at(self, probe: str, component: int, field: float) -> float:
        """Component (1, 2, 3) of a probe's displacement at a field in mT, mm; nan where the path ended before."""
        off = np.abs(np.array(self.fields) - field)
        step = int(off.argmin())
        return self.probes[probe][step][component - 1] if off[step] < 1e-9 * max(self.fields) else math.nan


class Runs:
    """Runs by specimen, made when they are asked for first."""

    def __init__(self, file: pathlib.Path = FILE) -> None:
        self.store = Store(file)

    def of(self, specimen: Specimen) -> Run:
        """The run of a specimen."""
        return Run(**self.store.get(name_of(specimen), lambda: _solved(specimen)))

    @property
    def cpu(self) -> float:
        """CPU time of all runs in the store, s."""
        return sum(entry["cpu"] for entry in self.store.entries.values() if isinstance(entry, dict))


def name_of(specimen: Any) -> str:
    """Kind and attributes that are not the default: its name in the store."""
    told = [
        f"{field.name}={value!r}"
        for field in fields(specimen)
        if (value := getattr(specimen, field.name)) != field.default
    ]
    return f"{type(specimen).__name__}({', '.join(told)})"


def _solved(specimen: Specimen) -> dict[str, object]:
    """Solve, and keep what the tables need."""
    print(f"  {name_of(specimen)} ...", end=" ", flush=True)
    reason = ""
    model = specimen.model()
    try:
        path = ms.solve(model, specimen.settings)
    except ms.SolveError as failure:
        path, reason = failure.path, failure.reason
    print(f"{path.discretisation.dofs} unknowns, {path.solves} solves, {path.cpu_seconds:.1f} s {reason}", flush=True)
    magnitude = 1e3 * model.field.magnitude
    return {
        "unknowns": path.discretisation.dofs,
        "elements": len(model.shell.mesh.elements),
        "solves": path.solves,
        "cuts": path.cuts,
        "cpu": path.cpu_seconds,
        "reason": reason,
        "fields": [step.load_factor * magnitude for step in path.steps],
        "probes": {name: (1e3 * path.probe(name).u).tolist() for name in model.probes},
    }
