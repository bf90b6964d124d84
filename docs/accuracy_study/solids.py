"""The converged shell against three-dimensional solids: the micropolar one, and that of Zhao et al."""

from __future__ import annotations

from typing import TYPE_CHECKING

from accuracy_study.examples import READINGS, Divisions, Variant, changed
from accuracy_study.page import LABEL, LEGEND, Findings, dress, figure, number, percent, table
from accuracy_study.runs import Run, Runs
from magshell.output.style import COLOURS, PALE
from magshell.reproduction.references import SOLID, SOLID_FIELDS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ZHAO = {
    "strip-10": (0.0930, 0.3913, 0.7687),
    "strip-17": (0.2703, 0.6833, 0.8753),
    "strip-20": (0.3464, 0.7348, 0.8927),
    "strip-41": (0.6861, 0.8698, 0.9474),
}
"""Tip deflection over length at `SOLID_FIELDS` by three-dimensional finite elements with the energy of Zhao et al."""

CROSS_FIELDS = (2.0, 5.0, 10.0, 20.0, 30.0, 40.0)
CROSS = (9.301, 15.383, 19.046, 21.356, 22.234, 22.720)
"""Height of the tip A over the tip D of the thin cross, mm, by three-dimensional micropolar finite elements."""

FINE: Divisions = (4, 4)
MESHES: dict[str, Divisions] = {"strip-10": (15, 4), "strip-17": (20, 4), "strip-20": (20, 4), "strip-41": (24, 4)}


def study(runs: Runs) -> Findings:
    """Differences in per cent at every field."""
    findings = Findings()
    strips = {name: _strip(runs, name) for name in MESHES}
    rows = []
    for name, variants in strips.items():
        for place, field in enumerate(SOLID_FIELDS):
            couple, law, thin, classical = (READINGS[name].of(run, field) for run in variants)
            solid, zhao = SOLID[name][place], ZHAO[name][place]
            rows.append(
                (
                    f"`{name}`", f"{field:g}", number(solid), number(couple), percent(couple, solid),
                    number(zhao), number(law), percent(law, zhao), percent(thin, zhao), percent(classical, zhao),
                )
            )  # fmt: skip
    header = (
        "Strip", "mT", "Micropolar solid", "Shell, `couple`", "Difference (%)", "Solid of Zhao et al.",
        "Shell, `deformation-gradient`", "Difference (%)", "The same, l = h/100 (%)", "Classical shell (%)",
    )  # fmt: skip
    findings.tables["solids"] = table(header, rows)
    findings.tables["solid-cross"] = _cross(runs)
    findings.pictures["solids"] = _picture(strips)
    return findings


def _strip(runs: Runs, name: str) -> tuple[Run, ...]:
    """The couple; Zhao's law, the same with next to no couple stress, and without micro-rotation."""
    couple = Variant(name, MESHES[name], "quadratic", SOLID_FIELDS)
    zhao = changed(couple, coupling="deformation-gradient")
    return runs.of(couple), runs.of(zhao), runs.of(changed(zhao, length=0.01)), runs.of(changed(zhao, classical=True))


def _cross(runs: Runs) -> str:
    reading = READINGS["thin-cross"]
    run = runs.of(Variant("thin-cross", FINE, "quadratic", CROSS_FIELDS))
    values = [reading.of(run, field) for field in CROSS_FIELDS]
    header = ("Thin cross, $u_3$ at A (mm)", *(f"{field:g} mT" for field in CROSS_FIELDS))
    rows = [
        ("micropolar solid", *(f"{value:.3f}" for value in CROSS)),
        ("shell", *(f"{value:.3f}" for value in values)),
        ("difference (%)", *(percent(value, solid, 2) for value, solid in zip(values, CROSS, strict=True))),
    ]
    return table(header, rows)


def _picture(strips: dict[str, tuple[Run, ...]]) -> Figure:
    new = figure((13.0, 4.8))
    labels = (
        "shell with the couple, micropolar solid",
        "shell with Zhao's law, solid of Zhao et al.",
        "the same with l = h/100",
        "the same without micro-rotation",
    )
    panels = new.subplots(1, len(SOLID_FIELDS), sharey=True)
    for place, (axes, field) in enumerate(zip(panels, SOLID_FIELDS, strict=True)):
        dress(axes, "strip, length / thickness")
        axes.axhline(0.0, color=PALE, linewidth=1.2)
        for kind, (label, colour) in enumerate(zip(labels, COLOURS, strict=False)):
            off = [
                100.0 * (READINGS[name].of(variants[kind], field) / (SOLID if kind == 0 else ZHAO)[name][place] - 1.0)
                for name, variants in strips.items()
            ]
            axes.plot(
                range(len(strips)), off, color=colour, marker="os^x"[kind], markersize=7, linewidth=1.8, label=label
            )
        axes.set_xticks(range(len(strips)), ["10", "17.5", "20.5", "41"])
        axes.set_title(f"{field:g} mT", fontsize=14)
    panels[0].set_ylabel("shell − solid (%)", **LABEL)
    panels[-1].legend(**LEGEND)
    return new
