"""Tables of the page on the published shells."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from blocks import write_blocks
from element_study.tables import table

from published_study.problems import CLASSICAL, MICROPOLAR, Divisions, Published, Variant
from published_study.runs import Run

PAGE = pathlib.Path(__file__).parents[1] / "published-shells.md"
COMMAND = "docs/make_published_study.py"
ORDER = 2
"""Of the extrapolation to a limit: at least this is seen wherever there is one."""


class Errors(NamedTuple):
    """Unknowns of the meshes of a variant, and their largest distances from the limit over the rows of the table."""

    unknowns: np.ndarray
    values: np.ndarray


class Study(NamedTuple):
    """A problem and all its runs."""

    published: Published
    found: Mapping[Variant, Mapping[Divisions, Run]]

    @property
    def finest(self) -> Run:
        """Of the classical shell."""
        return self.found[CLASSICAL][self.published.meshes[CLASSICAL][-1]]

    @property
    def limit(self) -> dict[str, np.ndarray]:
        """Differences from the table that the two finest meshes of the classical shell extrapolate to."""
        coarse, fine = self.published.meshes[CLASSICAL][-2:]
        weight = 1.0 / ((fine[0] / coarse[0]) ** ORDER - 1.0)
        near, far = (self.found[CLASSICAL][mesh].differences(self.published) for mesh in (fine, coarse))
        return {name: near[name] + weight * (near[name] - far[name]) for name in near}

    @property
    def stiffer(self) -> dict[str, np.ndarray]:
        """What ten parameters add to the differences from the table, on the finest mesh of both."""
        mesh = self.published.meshes[MICROPOLAR][-1]
        seven, ten = (self.found[variant][mesh].differences(self.published) for variant in (CLASSICAL, MICROPOLAR))
        return {name: ten[name] - seven[name] for name in seven}

    def errors(self, variant: Variant) -> Errors:
        """Of the meshes that reach the end, from the limit of `quadratic` with as many parameters."""
        limit = self.limit
        if variant.parameters == 10:
            limit = {name: row + self.stiffer[name] for name, row in limit.items()}
        runs = [run for run in self.found[variant].values() if not run.reason]
        distances = [{name: row - limit[name] for name, row in run.differences(self.published).items()} for run in runs]
        return Errors(np.array([run.unknowns for run in runs]), np.array([largest(one) for one in distances]))


def largest(differences: Mapping[str, np.ndarray]) -> float:
    """In size, over rows and columns."""
    return max(float(np.abs(column).max()) for column in differences.values())


def mesh_name(divisions: Divisions) -> str:
    """As in tables."""
    return f"{divisions[0]} × {divisions[1]}"


def percent(share: float) -> str:
    """With two digits behind the point."""
    return f"{100.0 * share:.2f} %"


def claim_table(studies: Sequence[Study]) -> str:
    """Largest distance from the table on the built-in mesh, on the finest one and in the limit."""
    rows = []
    for study in studies:
        published, runs = study.published, study.found[CLASSICAL]
        usual, finest = published.usual, published.meshes[CLASSICAL][-1]
        for divisions in dict.fromkeys([usual, finest]):
            run = runs[divisions]
            effort = (mesh_name(divisions), str(run.unknowns), str(run.solves), f"{run.cpu:.1f}")
            distance = (percent(run.worst(published)), _where(published, run.differences(published)))
            first = divisions == usual
            rows.append(
                [published.title if first else "", *effort, *distance, percent(published.allowed) if first else ""]
            )
        limit = study.limit
        rows.append(["", "limit", "", "", "", percent(largest(limit)), _where(published, limit), ""])
    head = ("Problem", "Mesh", "Unknowns", "Linear solves", "CPU (s)", "Largest distance", "At", "Claimed")
    return table(head, rows)


def _where(published: Published, differences: Mapping[str, np.ndarray]) -> str:
    """The row farthest from the table."""
    column = max(differences, key=lambda name: np.abs(differences[name]).max())
    at = int(np.abs(differences[column]).argmax())
    if published.by_displacement:
        return f"displacement {published.data[published.columns[0].name][at]:g}"
    return f"load {published.data['load_ratio'][at]:g}" + (f", `{column}`" if len(differences) > 1 else "")


def theory_table(studies: Sequence[Study]) -> str:
    """How far the shell of ten parameters is from that of seven, on the same mesh."""
    rows = []
    for study in studies:
        published = study.published
        divisions = published.meshes[MICROPOLAR][-1]
        distances = (percent(study.found[variant][divisions].worst(published)) for variant in (CLASSICAL, MICROPOLAR))
        rows.append([published.title, mesh_name(divisions), percent(largest(study.stiffer)), *distances])
    return table(("Problem", "Mesh", "Largest difference", "7 from the table", "10 from the table"), rows)


def write(studies: Sequence[Study], sentences: Mapping[str, str]) -> None:
    """Put every table and sentence between its marks on the page."""
    blocks = {"claims": claim_table(studies), "theories": theory_table(studies), **sentences}
    print("\n\n".join(blocks.values()))
    write_blocks(PAGE, blocks, COMMAND)
