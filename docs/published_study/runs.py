"""Solves a problem through the rows of its table, and says how far from them it is."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from element_study.runs import Store

import magshell as ms
from magshell.shell.deformed import evaluate
from published_study.problems import Divisions, Published, Variant

CACHE = pathlib.Path(__file__).parents[2] / "results" / "published-study" / "runs.json"


class Run(NamedTuple):
    """A load path through the rows of a table.

    Attributes
    ----------
    unknowns, steps, solves, cuts : int
    cpu : float
        s.
    reason : str
        Why the path ended early; "" where it did not.
    loads : list of float
        Over the largest of the table, at all converged steps.
    values : dict of str to list of float
        Columns of the table at all converged steps, in its units.
    rows : list of int
        Steps that are rows of the table, as far as the path goes.
    limits : list of float
        Loads at limit points.
    strain : float
        Largest Green strain in size, of all directions and points, at the end.
    """

    unknowns: int
    steps: int
    solves: int
    cuts: int
    cpu: float
    reason: str
    loads: list[float]
    values: dict[str, list[float]]
    rows: list[int]
    limits: list[float]
    strain: float

    def differences(self, published: Published) -> dict[str, np.ndarray]:
        """What a row has more than the table, over the column's range from 0; loads where displacements lead."""
        data, found = published.data, {}
        compared = {"load_ratio": self.loads} if published.by_displacement else self.values
        for name, ours in compared.items():
            table = data[name][: len(self.rows)]
            found[name] = (np.array(ours)[self.rows] - table) / np.ptp(np.append(data[name], 0.0))
        return found

    def worst(self, published: Published) -> float:
        """Largest distance of a row from the table, over the column's range; nan if the path ended early."""
        if self.reason:
            return float("nan")
        return max(float(np.abs(column).max()) for column in self.differences(published).values())


def solved(published: Published, model: ms.Model) -> Run:
    """Solve a model of the problem now."""
    reason = ""
    try:
        path = ms.solve(model)
    except ms.SolveError as failure:
        path, reason = failure.path, failure.reason
    loads = [float(step.loads[0]) for step in path.steps]
    values = {
        column.name: (column.factor * path.probe(column.probe).u[:, column.component - 1]).tolist()
        for column in published.columns
    }
    led, data = (
        (published.columns[0].name, values) if published.by_displacement else ("load_ratio", {"load_ratio": loads})
    )
    wanted, steps = published.data[led], np.array(data[led])
    nearest = [int(np.abs(steps - value).argmin()) for value in wanted]
    rows = [i for i, value in zip(nearest, wanted, strict=True) if abs(steps[i] - value) < 1e-9 * wanted.max()]
    limits = [
        float(path.courses[point.stage].amounts(point.load_factor).loads[0])
        for point in path.critical_points
        if point.kind == "limit point"
    ]
    return Run(
        path.discretisation.dofs, len(path.steps) - 1, path.solves, path.cuts, path.cpu_seconds, reason, loads, values,
        rows, limits, _largest_strain(path),
    )  # fmt: skip


def _largest_strain(path: ms.Path) -> float:
    """Of all Green strains at the points of the last state, in size."""
    F = evaluate(path.discretisation.reference, path.steps[-1].state).F
    E = 0.5 * (np.einsum("epkia,epkib->epkab", F, F) - np.eye(3))
    return float(np.abs(np.linalg.eigvalsh(E)).max())


class Runs:
    """Runs that are kept in a file and made when they are asked for first."""

    def __init__(self) -> None:
        self.store = Store(CACHE)

    def of(self, published: Published, variant: Variant, divisions: Divisions) -> Run:
        """The run of a variant on a mesh."""
        name = f"{published.name}, {variant.name}, {divisions[0]}x{divisions[1]}"
        return self.get(name, published, lambda: published.model(variant, divisions))

    def get(self, name: str, published: Published, model: Callable[[], ms.Model]) -> Run:
        """The run of a model of the problem, by name."""

        def make() -> dict[str, Any]:
            run = solved(published, model())
            worst = 100.0 * run.worst(published)
            print(
                f"{name}: {run.unknowns} unknowns, {run.solves} solves, {run.cpu:.1f} s, {worst:.2f} % {run.reason}",
                flush=True,
            )
            return run._asdict()

        return Run(**self.store.get(name, make))

    @property
    def cpu(self) -> float:
        """CPU time of all runs in the store, s."""
        return sum(entry["cpu"] for entry in self.store.entries.values())
