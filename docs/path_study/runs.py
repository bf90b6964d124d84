"""Paths that are solved once and kept in a file, reduced to what tables and pictures need."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from element_study.runs import Store

import magshell as ms

FILE = pathlib.Path(__file__).parents[2] / "results" / "path-study" / "runs.json"

Measure = Callable[[ms.Path], Any]


@dataclass(frozen=True)
class Place:
    """A point of a path: a converged step, or a critical point.

    Attributes
    ----------
    kind : str
        "step", "limit point" or "bifurcation".
    stage : int
        From 0.
    load_factor, arc_length : float
    flux_density : list of 3 floats
        mT.
    pivots : list of int
        Negative pivots there; of a critical point, before and after it.
    probes : dict of str to list of 3 floats
        Displacements, mm.
    """

    kind: str
    stage: int
    load_factor: float
    arc_length: float
    flux_density: list[float]
    pivots: list[int]
    probes: dict[str, list[float]]

    def u(self, probe: str, component: int) -> float:
        """A displacement, mm."""
        return self.probes[probe][component - 1]

    @property
    def stable(self) -> bool:
        """No negative pivot (of a critical point: on neither side)."""
        return not any(self.pivots)


@dataclass(frozen=True)
class Trace:
    """A solved path.

    Attributes
    ----------
    unknowns, solves, cuts : int
    cpu : float
        s.
    reason : str
        Why it ended early; "" where it did not.
    places : list of Place
        Steps and critical points along the path, stage by stage; a branch begins with its critical point.
    measured : object
        What a function of the path returned.
    """

    unknowns: int
    solves: int
    cuts: int
    cpu: float
    reason: str
    places: list[Place]
    measured: Any

    @property
    def critical(self) -> list[Place]:
        """Limit points and bifurcations, in order."""
        return [place for place in self.places if place.kind != "step"]

    def stages(self, first: int, last: int | None = None) -> list[Place]:
        """Places of one stage, or of a range of them."""
        return [place for place in self.places if first <= place.stage <= (first if last is None else last)]


class Runs:
    """Traces by name, solved when they are asked for first."""

    def __init__(self) -> None:
        self.store = Store(FILE)

    def of(
        self,
        name: str,
        model: Callable[[], ms.Model],
        settings: ms.Settings | None = None,
        measure: Measure | None = None,
    ) -> Trace:
        """The trace of a model."""
        entry = self.store.get(name, lambda: asdict(_solved(name, model(), settings, measure)))
        return Trace(**{**entry, "places": [Place(**place) for place in entry["places"]]})

    @property
    def cpu(self) -> float:
        """CPU time of all traces, s."""
        return sum(entry["cpu"] for entry in self.store.entries.values())


def _solved(name: str, model: ms.Model, settings: ms.Settings | None, measure: Measure | None) -> Trace:
    print(f"  {name} ...", end=" ", flush=True)
    reason = ""
    try:
        path = ms.solve(model, settings)
    except ms.SolveError as failure:
        path, reason = failure.path, failure.reason
    print(f"{path.discretisation.dofs} unknowns, {path.solves} solves, {path.cpu_seconds:.1f} s {reason}", flush=True)
    return Trace(
        path.discretisation.dofs, path.solves, path.cuts, path.cpu_seconds, reason, _places(path),
        measure(path) if measure is not None and not reason else None,
    )  # fmt: skip


def _places(path: ms.Path) -> list[Place]:
    """Steps and critical points in the order in which the path meets them."""
    counts = [[] if step.negative_pivots is None else [step.negative_pivots] for step in path.steps]
    places = [_place(path, "step", step, count) for step, count in zip(path.steps, counts, strict=True)]
    points = [
        _place(path, point.kind, point, [count for count in point.negative_pivots if count is not None])
        for point in path.critical_points
    ]
    ordered = []
    for number, stage in enumerate(path.model.stages):
        here = [place for place in (*places, *points) if place.stage == number]
        if stage.branch is not None:
            ordered.append(points[stage.branch - 1])
        ordered += sorted(here, key=lambda place: place.arc_length)
    return ordered


def _place(path: ms.Path, kind: str, at: ms.Step | ms.CriticalPoint, pivots: list[int]) -> Place:
    probes = {name: (1e3 * at.state.u[node]).tolist() for name, node in path.model.probe_nodes.items()}
    field = (1e3 * np.asarray(at.flux_density)).tolist()
    return Place(kind, at.stage, float(at.load_factor), float(at.arc_length), field, pivots, probes)


def profile(path: ms.Path, at: ms.Step | ms.CriticalPoint) -> list[list[float]]:
    """Deformed edge of least X2, from least to largest X1: (n, 2) of x1 and x3, mm."""
    points = path.model.shell.mesh.points
    nodes = np.flatnonzero(points[:, 1] <= points[:, 1].min() + 1e-9)
    nodes = nodes[np.argsort(points[nodes, 0])]
    return (1e3 * (points + at.state.u)[nodes][:, [0, 2]]).tolist()
