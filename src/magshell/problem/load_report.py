"""Mechanical loads in words: what each is and adds up to, and how strong they are together."""

from __future__ import annotations

from collections.abc import Iterator

from magshell.model.doubts.loads import Strength
from magshell.problem.building import Problem


def lines(problem: Problem, strong: Strength) -> Iterator[tuple[str, str]]:
    """Label and text for each load, and for the dimensionless numbers."""
    model = problem.model
    for load, forces in zip(model.loads, model.forces_at_rest, strict=True):
        text = load.words(model.shell, forces)
        if load.history is not None:
            text += f", times {', '.join(f'{each:g}' for each in load.history)} at the ends of the stages"
        yield load.group or "whole shell", text
    if strong.force or strong.moment:
        yield "12 (F L + M) / (E h³)", f"{strong.bending:.4g}"
    if strong.weight:
        yield "12 W L / (E h³)", f"{strong.weight_bending:.4g} with the weight W"
    if strong.pressure:
        yield "p L / (E h)", f"{strong.stretching:.4g}"
