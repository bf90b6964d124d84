"""Tables of the page on the published shells."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from blocks import write_blocks
from element_study.convergence import Series
from element_study.tables import table

from published_study.problems import CLASSICAL, LIMIT_POINT, MICROPOLAR, Divisions, Published, Variant
from published_study.runs import Run

PAGE = pathlib.Path(__file__).parents[1] / "published-shells.md"
COMMAND = "docs/make_published_study.py"
Found = Mapping[Variant, Mapping[Divisions, Run]]


class Study(NamedTuple):
    """A problem and all its runs."""

    published: Published
    found: Found

    @property
    def finest(self) -> Run:
        """Of the classical shell."""
        return self.found[CLASSICAL][self.published.meshes[CLASSICAL][-1]]

    @property
    def usual(self) -> Run:
        """Of the classical shell on the built-in mesh."""
        return self.found[CLASSICAL][self.published.usual]

    def measure(self, run: Run) -> float:
        """The number that stands for the accuracy of a mesh."""
        return run.limits[0] if self.published.measure == LIMIT_POINT else run.values[self.published.measure][-1]

    def series(self, variant: Variant) -> Series:
        """That number on all meshes of a variant."""
        runs = {mesh: run for mesh, run in self.found[variant].items() if not run.reason}
        sizes = np.array([1.0 / mesh[0] for mesh in runs])
        columns = zip(*((run.unknowns, self.measure(run), run.cpu) for run in runs.values()), strict=True)
        return Series(variant.name, sizes, *(np.array(column, dtype=float) for column in columns))


def mesh_name(divisions: Divisions) -> str:
    """As in tables."""
    return f"{divisions[0]} × {divisions[1]}"


def percent(share: float) -> str:
    """With two digits behind the point."""
    return f"{100.0 * share:.2f} %"


def claim_table(studies: Sequence[Study]) -> str:
    """Largest distance from the table on the built-in and on the finest mesh."""
    rows = []
    for published, found in studies:
        for divisions in dict.fromkeys([published.usual, published.meshes[CLASSICAL][-1]]):
            run = found[CLASSICAL][divisions]
            rows.append([
                published.title if divisions == published.usual else "", mesh_name(divisions), str(run.unknowns),
                str(run.solves), f"{run.cpu:.1f}", percent(run.worst(published)), _where(published, run),
                percent(published.allowed),
            ])  # fmt: skip
    head = ("Problem", "Mesh", "Unknowns", "Linear solves", "CPU (s)", "Largest distance", "At", "Claimed")
    return table(head, rows)


def _where(published: Published, run: Run) -> str:
    """The row farthest from the table."""
    differences = run.differences(published)
    column = max(differences, key=lambda name: np.abs(differences[name]).max())
    at = int(np.abs(differences[column]).argmax())
    led = published.columns[0].name if published.by_displacement else "load_ratio"
    sign = "displacement" if published.by_displacement else "load"
    return f"{sign} {published.data[led][at]:g}" + (f", `{column}`" if len(differences) > 1 else "")


def theory_table(studies: Sequence[Study]) -> str:
    """How far the shell of ten parameters is from that of seven, on the same mesh."""
    rows = []
    for published, found in studies:
        divisions = published.meshes[MICROPOLAR][-1]
        seven, ten = found[CLASSICAL][divisions], found[MICROPOLAR][divisions]
        theirs = ten.differences(published)
        apart = max(float(np.abs(theirs[name] - ours).max()) for name, ours in seven.differences(published).items())
        rows.append(
            [
                published.title,
                mesh_name(divisions),
                percent(apart),
                *(percent(run.worst(published)) for run in (seven, ten)),
            ]
        )
    return table(("Problem", "Mesh", "Largest difference", "7 from the table", "10 from the table"), rows)


def limit_table(studies: Sequence[Study]) -> str:
    """Measure, table, limit and order of the classical shell."""
    rows = []
    for study in studies:
        published, one = study.published, study.series(CLASSICAL)
        data = published.data
        if published.measure == LIMIT_POINT:
            tabulated, what = float(_first_maximum(data["load_ratio"])), "load at the first limit point"
        else:
            tabulated, what = float(data[published.measure][-1]), f"`{published.measure}` at the last row"
        rows.append(
            [published.title, what, f"{tabulated:g}", f"{study.measure(study.finest):.4g}", f"{one.limit:.4g}",
             f"{one.order:.1f}", f"{100.0 * (one.limit / tabulated - 1.0):+.2f} %"]
        )  # fmt: skip
    return table(("Problem", "Quantity", "Table", "Finest mesh", "Limit", "Order", "Limit from the table"), rows)


def _first_maximum(loads: np.ndarray) -> float:
    return float(loads[int(np.argmax(np.diff(loads) < 0.0))])


def write(studies: Sequence[Study], sentences: Mapping[str, str]) -> None:
    """Put every table and sentence between its marks on the page."""
    blocks = {"claims": claim_table(studies), "limits": limit_table(studies), "theories": theory_table(studies)}
    blocks |= sentences
    print("\n\n".join(blocks.values()))
    write_blocks(PAGE, blocks, COMMAND)
