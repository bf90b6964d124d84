"""What the paper says of its element, measured: the enhanced parameters, and the thickness stretch."""

from __future__ import annotations

from accuracy_study.examples import READINGS, Variant, changed, paper_divisions
from accuracy_study.page import Findings, number, percent, table
from accuracy_study.runs import Runs

STRETCHES = ("none", "plane-stress")
STRETCHED = ("strip-10", "strip-41")
STRIP_FIELDS = (2.0, 10.0, 50.0)


def study(runs: Runs) -> Findings:
    """Differences from the paper's element, and from the full model."""
    return Findings(tables={"enhancement": _enhancement(runs), "stretch": _stretch(runs)})


def _enhancement(runs: Runs) -> str:
    rows = []
    for example, reading in READINGS.items():
        six = Variant(example, paper_divisions(example), "paper", reading.fields)
        for field in reading.fields:
            value = reading.of(runs.of(six), field)
            others = (
                percent(reading.of(runs.of(changed(six, element=element)), field), value, 3)
                for element in ("paper-39", "paper-unenhanced")
            )
            rows.append((f"`{example}`", reading.words, f"{field:g}", number(value), *others))
    header = ("Example", "Displacement", "mT", "6 parameters", "39 (%)", "none (%)")
    return table(header, rows, 2)


def _stretch(runs: Runs) -> str:
    rows = []
    for example in STRETCHED:
        reading = READINGS[example]
        for element in ("paper", "quadratic"):
            full = Variant(example, paper_divisions(example), element, STRIP_FIELDS)
            for field in STRIP_FIELDS:
                value = reading.of(runs.of(full), field)
                others = [reading.of(runs.of(changed(full, thickness_stretch=stretch)), field) for stretch in STRETCHES]
                cells = (cell for other in others for cell in (number(other), percent(other, value)))
                rows.append((f"`{example}`", f"`{element}`", f"{field:g}", number(value), *cells))
    header = ("Example", "Element", "mT", "`linear`", "`none`", "off by (%)", "`plane-stress`", "off by (%)")
    return table(header, rows, 2)
