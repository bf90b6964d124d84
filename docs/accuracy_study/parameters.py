"""What the coupling modulus eta and the length scale l change, and where they stop mattering."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from accuracy_study.examples import READINGS, Divisions, Variant, changed
from accuracy_study.page import LABEL, LEGEND, TEXT, Findings, dress, figure, percent, table
from accuracy_study.runs import Runs
from magshell.output.style import COLOURS, PALE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ETAS = (0.01, 0.03, 0.1, 0.3, 1.0, 10.0, 100.0)
LENGTHS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
USUAL = 0.1
SAMPLES: dict[str, Divisions] = {"strip-10": (15, 3), "strip-41": (20, 2), "thin-cross": (2, 2)}


def study(runs: Runs) -> Findings:
    """Deflections over those at eta = mu/10, l = h/10."""
    findings = Findings()
    lines = {"eta": _lines(runs, "eta", ETAS), "length": _lines(runs, "length", LENGTHS)}
    findings.tables["eta"] = _table("$\\eta/\\mu$", ETAS, lines["eta"])
    findings.tables["length"] = _table("$l/h$", LENGTHS, lines["length"])
    findings.pictures["parameters"] = _picture(lines)
    return findings


def _lines(runs: Runs, parameter: str, values: tuple[float, ...]) -> dict[tuple[str, float], list[float]]:
    """By example and field, displacements over the usual one."""
    lines = {}
    for example, divisions in SAMPLES.items():
        reading = READINGS[example]
        usual = Variant(example, divisions, "quadratic", reading.fields)
        every = [runs.of(changed(usual, **{parameter: value})) for value in values]
        for field in reading.fields:
            at_usual = reading.of(runs.of(usual), field)
            lines[example, field] = [reading.of(run, field) / at_usual for run in every]
    return lines


def _table(symbol: str, values: tuple[float, ...], lines: dict[tuple[str, float], list[float]]) -> str:
    header = ("Example", "mT", *(f"{symbol} = {value:g}" if value == values[0] else f"{value:g}" for value in values))
    rows = [(f"`{name}`", f"{field:g}", *(percent(r, 1.0) for r in line)) for (name, field), line in lines.items()]
    return table(header, rows)


def _picture(lines: dict[str, dict[tuple[str, float], list[float]]]) -> Figure:
    new = figure((13.0, 5.2))
    panels = new.subplots(1, 2)
    for axes, parameter, values, label in zip(
        panels, lines, (ETAS, LENGTHS), (r"coupling modulus  $\eta/\mu$", "length scale  $l/h$"), strict=True
    ):
        dress(axes, label)
        axes.set_xscale("log")
        axes.axvline(USUAL, color=PALE, linewidth=1.0, linestyle=":")
        for (name, field), line in lines[parameter].items():
            low = field == READINGS[name].low
            colour = COLOURS[list(SAMPLES).index(name)]
            axes.plot(
                values, 100.0 * (np.array(line) - 1.0), color=colour, linestyle="-" if low else "--", linewidth=1.8,
                marker="o" if low else "s", markersize=5, markerfacecolor=colour if low else "white",
                label=f"{name}, {field:g} mT",
            )  # fmt: skip
    panels[0].set_ylabel("change of the displacement (%)", **LABEL)
    panels[0].set_title(r"$l = h/10$", **TEXT)
    panels[1].set_title(r"$\eta = \mu/10$", **TEXT)
    panels[1].legend(loc="lower left", **LEGEND)
    return new
