"""What explains the distances from the tables: the law where strains are large, what a hinge holds."""

from __future__ import annotations

import dataclasses

import numpy as np

import magshell as ms
from published_study.problems import CLASSICAL, PROBLEMS, Published
from published_study.runs import Run, Runs

BY_NAME = {published.name: published for published in PROBLEMS}


def apart(published: Published, one: Run, other: Run) -> float:
    """Largest difference of two runs over the table's rows, over the column's range."""
    theirs = other.differences(published)
    return max(float(np.abs(theirs[name] - ours).max()) for name, ours in one.differences(published).items())


def law_sentence(runs: Runs) -> str:
    """The semi-cylinder with another law of the same linear limit."""
    published, divisions = BY_NAME["semi-cylinder"], (12, 12)

    def neo_hookean() -> ms.Model:
        model = published.model(CLASSICAL, divisions)
        shell = dataclasses.replace(model.shell, material=ms.MicropolarNeoHookean(*model.shell.material))
        return dataclasses.replace(model, shell=shell)

    one = runs.of(published, CLASSICAL, divisions)
    other = runs.get("semi-cylinder, neo-Hookean", published, neo_hookean)
    reached, difference = 100.0 * one.strain, 100.0 * apart(published, one, other)
    worst = [f"{100.0 * run.worst(published):.2f} %" for run in (other, one)]
    return (
        f"On {divisions[0]} × {divisions[1]} elements strains reach {reached:.0f} %, and the neo-Hookean law, which has"
        f" the same linear limit, differs from St Venant and Kirchhoff's by up to {difference:.2f} % of the range: its "
        f"largest distance from the table is {worst[0]} instead of {worst[1]}."
    )


def hinge_sentence(runs: Runs) -> str:
    """The roof with a hinge that also keeps the director normal to its axis."""
    published, divisions = BY_NAME["hinged-roof"], (8, 8)

    def held() -> ms.Model:
        model = published.model(CLASSICAL, divisions)
        return dataclasses.replace(model, supports=[*model.supports, ms.Prescribe("angle-stop", "w", 2, 0.0)])

    one = runs.of(published, CLASSICAL, divisions)
    other = runs.get("hinged-roof, director held", published, held)
    return (
        f"A hinge that also keeps the director from tilting along its axis changes the load by at most "
        f"{100.0 * apart(published, one, other):.2f} % of its range ({divisions[0]} × {divisions[1]} elements)."
    )
