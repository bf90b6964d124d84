"""What the report says of a remanence: its sense, in words."""

from __future__ import annotations

from collections.abc import Iterator

from magshell.magnetics.remanence import REMANENCES
from magshell.magnetics.remanence.sampled import averaged
from magshell.mesh.geometry import centres
from magshell.problem import schema
from magshell.problem.building import Problem
from magshell.wording import counted


def doubts(problem: Problem) -> Iterator[str]:
    """Elements that have no place of their own."""
    shell = problem.model.shell
    points = centres(shell.mesh.points, shell.mesh.elements)[:, None]
    elements = averaged(shell.overall_remanence, shell.mesh, points)
    if elements.size:
        yield (
            f"remanence: {counted(len(elements), 'element')} (first element {elements[0]}) with several places of the "
            "table as near: the mean is taken. Give places at the centres of the elements"
        )


def sense(entry: schema.RemanenceTable) -> str:
    """Where an entry points."""
    way = REMANENCES[entry.kind]
    return way.words(**way.values(entry))
