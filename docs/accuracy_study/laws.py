"""The three coupling laws against each other."""

from __future__ import annotations

import math

from accuracy_study.examples import READINGS, Variant, changed, paper_divisions
from accuracy_study.page import Findings, number, percent, table
from accuracy_study.runs import Runs

OTHERS = ("micro-rotation", "deformation-gradient")
COARSER = {"pump": (12, 10), "gripper": (20, 4), "thin-cross": (2, 2), "hollow-cross": (4, 4)}
"""Meshes where the default element needs less than the paper's."""


def study(runs: Runs) -> Findings:
    """Displacements with each law at a low field and at the end."""
    rows = []
    for example, reading in READINGS.items():
        divisions = COARSER.get(example, paper_divisions(example))
        couple = Variant(example, divisions, "quadratic", reading.fields)
        others = [runs.of(changed(couple, coupling=law)) for law in OTHERS]
        for field in reading.fields:
            value = reading.of(runs.of(couple), field)
            differences = (percent(reading.of(run, field), value) for run in others)
            rows.append((f"`{example}`", reading.words, f"{field:g}", number(value), *differences))
    ends = [f"`{run[0]}` with the law `{run[1]}` ends at {run[2]:.0f} mT" for run in _stopped(runs)]
    header = ("Example", "Displacement", "mT", "`couple`", "`micro-rotation` (%)", "`deformation-gradient` (%)")
    content = table(header, rows, 2)
    return Findings(tables={"laws": content + (f"\n\n{'; '.join(ends)}." if ends else "")})


def _stopped(runs: Runs) -> list[tuple[str, str, float]]:
    """Example, law and last field, mT, of every path that did not reach its end."""
    found = []
    for example, reading in READINGS.items():
        divisions = COARSER.get(example, paper_divisions(example))
        for law in OTHERS:
            run = runs.of(Variant(example, divisions, "quadratic", reading.fields, coupling=law))
            if not math.isclose(run.fields[-1], reading.final):
                found.append((example, law, run.fields[-1]))
    return found
