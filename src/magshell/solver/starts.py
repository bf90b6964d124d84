"""Where a stage starts: at the last state before it, or at a critical point and along its mode."""

from __future__ import annotations

from typing import NamedTuple

from magshell.arrays import FloatArray
from magshell.model.course import Amounts
from magshell.shell.state import State
from magshell.solver.newton import StepFailure
from magshell.solver.path import Path


class Start(NamedTuple):
    """The first state of a stage.

    Attributes
    ----------
    state : State
    arc_length : float
        Of the path there.
    amounts : Amounts or None
        What acts there; None: nothing yet.
    mode : ndarray or None, shape (nodes, 11)
        Direction of the first step, on a branch.
    """

    state: State
    arc_length: float
    amounts: Amounts | None
    mode: FloatArray | None


def start_of(path: Path, number: int) -> Start:
    """The start of a stage, given the path through the stages before it.

    Raises
    ------
    StepFailure
        It branches off at a critical point that the path has not passed.
    """
    stage = path.model.stages[number]
    if stage.branch is not None:
        found = path.critical_points
        if stage.branch > len(found):
            raise StepFailure(
                f"stage {number + 1} wants to branch off at critical point {stage.branch}, but the path before it has "
                f"{len(found) or 'none'}"
            )
        point = found[stage.branch - 1]
        amounts = path.courses[point.stage].amounts(point.load_factor)
        return Start(point.state, point.arc_length, amounts, stage.side * point.mode)
    before = [step for step in path.steps if step.stage < number]
    if not before:
        return Start(path.discretisation.undeformed(), 0.0, None, None)
    last = before[-1]
    return Start(last.state, last.arc_length, path.courses[last.stage].amounts(last.load_factor), None)
