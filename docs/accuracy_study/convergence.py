"""Every example on four meshes with both elements: observed order, limit, and how far the paper's mesh is from it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from accuracy_study.examples import READINGS, Divisions, Variant, paper_divisions
from accuracy_study.page import LEGEND, TEXT, Findings, dress, figure, number, percent, table
from accuracy_study.richardson import Limit, limit
from accuracy_study.runs import Run, Runs
from magshell.output.style import COLOURS, INK, PALE
from magshell.reproduction.references import QUOTED

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _times(one: Divisions, *factors: int) -> list[Divisions]:
    return [(one[0] * factor, one[1] * factor) for factor in factors]


MESHES: dict[str, dict[str, list[Divisions]]] = {
    "strip-10": {"paper": _times((5, 2), 1, 2, 3, 4), "quadratic": _times((5, 2), 1, 2, 3, 4)},
    "strip-17": {"paper": _times((15, 2), 1, 2, 3, 4), "quadratic": _times((5, 2), 1, 2, 3, 4)},
    "strip-20": {"paper": _times((15, 2), 1, 2, 3, 4), "quadratic": _times((5, 2), 1, 2, 3, 4)},
    "strip-41": {"paper": _times((20, 2), 1, 2, 3, 4), "quadratic": _times((8, 2), 1, 2, 3, 4)},
    "hollow-cross": {"paper": _times((3, 3), 1, 2, 3, 4), "quadratic": _times((1, 1), 3, 4, 5, 6)},
    "thin-cross": {"paper": _times((1, 1), 2, 3, 4, 6), "quadratic": _times((1, 1), 1, 2, 3, 4)},
    "h-shape": {"paper": _times((1, 1), 1, 2, 3, 4), "quadratic": _times((1, 1), 1, 2, 3, 4)},
    "pump": {"paper": _times((6, 5), 2, 3, 4, 5), "quadratic": _times((6, 5), 1, 2, 3, 4)},
    "gripper": {"paper": _times((10, 2), 2, 3, 4, 5), "quadratic": _times((10, 2), 1, 2, 3, 4)},
}
"""Divisions, coarse to fine; of the crosses and the H those of the centre or of each block.

The probes of strips and gripper lie on the middle line, which is a line of elements' edges on each of these meshes.
"""

ELEMENTS = ("paper", "quadratic")
NAMES = {"paper": "paper", "quadratic": "default"}


class Sequence(NamedTuple):
    """One displacement of one example with one element on all meshes."""

    values: list[float]
    sizes: list[float]
    unknowns: list[int]
    limit: Limit


def sequence(runs: Runs, example: str, element: str, field: float) -> Sequence:
    """Values and limit; sizes are in units of the paper's mesh."""
    reading, every = READINGS[example], mesh_runs(runs, example, element)
    paper = elements_of(runs, example)
    sizes = [math.sqrt(paper / run.elements) for run in every]
    values = [reading.of(run, field) for run in every]
    return Sequence(values, sizes, [run.unknowns for run in every], limit(sizes, values))


def mesh_runs(runs: Runs, example: str, element: str) -> list[Run]:
    """The runs of the four meshes."""
    return [
        runs.of(Variant(example, divisions, element, READINGS[example].fields))
        for divisions in MESHES[example][element]
    ]


def paper_run(runs: Runs, example: str, element: str = "paper") -> Run:
    """The run on the paper's mesh."""
    return runs.of(Variant(example, paper_divisions(example), element, READINGS[example].fields))


def elements_of(runs: Runs, example: str) -> int:
    """Number of elements of the paper's mesh."""
    return paper_run(runs, example).elements


def converged(runs: Runs, example: str, field: float) -> float:
    """The limit of the default element."""
    return sequence(runs, example, "quadratic", field).limit.value


def study(runs: Runs) -> Findings:
    """Tables of values on the paper's mesh and of all meshes; a picture of the errors."""
    findings = Findings()
    findings.tables["paper-mesh"] = _paper_table(runs)
    findings.tables["meshes-low"] = _mesh_table(runs, final=False)
    findings.tables["meshes-final"] = _mesh_table(runs, final=True)
    findings.pictures["meshes"] = _picture(runs)
    return findings


def _paper_table(runs: Runs) -> str:
    quoted = {(entry.example, entry.field): f"{entry.value:g}" for entry in QUOTED}
    rows = []
    for example, reading in READINGS.items():
        for field in reading.fields:
            theirs = reading.of(paper_run(runs, example), field)
            ours = reading.of(paper_run(runs, example, "quadratic"), field)
            limits = {element: sequence(runs, example, element, field).limit.value for element in ELEMENTS}
            best = limits["quadratic"]
            rows.append(
                (
                    f"`{example}`",
                    reading.words,
                    f"{field:g}",
                    quoted.get((example, field), ""),
                    number(theirs),
                    number(best),
                    percent(theirs, best),
                    percent(ours, best, 2),
                    percent(limits["paper"], best, 2),
                )
            )
    header = (
        "Example", "Displacement", "mT", "Quoted by the paper", "Paper's element and mesh", "Converged", "Off by (%)",
        "Default element, same mesh (%)", "Limit of the paper's element (%)",
    )  # fmt: skip
    return table(header, rows, 2)


def _mesh_table(runs: Runs, final: bool) -> str:
    rows = []
    for example, reading in READINGS.items():
        for element in ELEMENTS:
            found = sequence(runs, example, element, reading.fields[final])
            meshes = MESHES[example][element]
            order = f"{found.limit.order:.1f}" if math.isfinite(found.limit.order) else "–"
            values = (f"{number(value)} ({n})" for value, (n, _) in zip(found.values, meshes, strict=True))
            limit_ = number(found.limit.value) if math.isfinite(found.limit.order) else "–"
            rows.append((f"`{example}`", NAMES[element], *values, order, limit_))
    return table(("Example", "Element", "Mesh 1", "Mesh 2", "Mesh 3", "Mesh 4", "Order", "Limit"), rows, 2)


def _picture(runs: Runs) -> Figure:
    new = figure((13.0, 12.0))
    panels = new.subplots(3, 3, sharex=True, sharey=True)
    for axes, (example, reading) in zip(panels.flat, READINGS.items(), strict=True):
        dress(axes)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.axhline(1.0, color=PALE, linewidth=1.0, linestyle=":")
        axes.axvline(1.0, color=PALE, linewidth=1.0, linestyle=":")
        for element, colour in zip(ELEMENTS, (COLOURS[1], COLOURS[0]), strict=True):
            for field, style in zip(reading.fields, ("-", "--"), strict=True):
                found = sequence(runs, example, element, field)
                best = converged(runs, example, field)
                errors = [100.0 * abs(value / best - 1.0) or math.nan for value in found.values]
                marker = "o" if style == "-" else "s"
                axes.plot(
                    found.sizes, errors, color=colour, linestyle=style, marker=marker, markersize=5, linewidth=1.8,
                    markerfacecolor=colour if style == "-" else "white",
                    label=f"{NAMES[element]}, {'low' if style == '-' else 'final'} field",
                )  # fmt: skip
        low, final = reading.fields
        axes.set_title(f"{example}   {low:g} / {final:g} mT", **TEXT)
        axes.set_ylim(1e-3, 40.0)
        axes.set_xlim(0.29, 4.5)
        axes.set_xticks([0.5, 1.0, 2.0], ["½", "1", "2"])
        axes.minorticks_off()
    panels[0, 0].legend(**LEGEND)
    for axes in panels[-1]:
        axes.set_xlabel("element size, paper's mesh = 1", fontsize=14, color=INK)
    for axes in panels[:, 0]:
        axes.set_ylabel("error (%)", fontsize=14, color=INK)
    return new
