"""How long the next step is, and when steps have become too short or too many.

It does not matter here whether a step is one of length or of time. All values are immutable; each outcome of a step
gives the control of the next one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

# Largest and smallest factors from one step that succeeded to the next.
GROWTH, SHRINKAGE = 2.5, 0.4
# A step that failed is made again with this part of its size, and at most LEAST_CUT of the size that was intended.
CUT, LEAST_CUT = 0.35, 0.5
# So many steps must come nearer to a goal by this share of the way to it.
MOST_STEPS, PROGRESS = 100, 0.01


class StepRules(NamedTuple):
    """What steps aim at.

    Attributes
    ----------
    target_solves : int
        Linear solves per step.
    smallest : float
        Size below which steps are given up.
    """

    target_solves: int
    smallest: float


class StepControl(NamedTuple):
    """Size of the next step.

    Attributes
    ----------
    rules : StepRules
    size : float
    failures : int
        Attempts in a row that failed.
    """

    rules: StepRules
    size: float
    failures: int = 0

    def succeeded(self, size: float, solves: int, *, shortened: bool = False) -> StepControl:
        """After a step of a size that took some solves; `shortened`: it could have been as long as the control said."""
        factor = float(np.clip(self.rules.target_solves / max(solves, 1), SHRINKAGE, GROWTH))
        grown = factor * size
        return self._replace(size=max(self.size, grown) if shortened else grown, failures=0)

    def failed(self, size: float, intended: float) -> StepControl:
        """After a step that failed: its own size, and that which was intended."""
        return self._replace(size=min(CUT * size, LEAST_CUT * intended), failures=self.failures + 1)

    @property
    def exhausted(self) -> bool:
        """Whether the next step would be too short, or has no size."""
        return not self.size >= self.rules.smallest


def stagnant(values: Sequence[float], wanted: float, largest_step: float) -> Sequence[float]:
    """The last of some values, if they came no nearer to a wanted one than those before; else none.

    Parameters
    ----------
    values : sequence of float
        After each step on the way to it.
    wanted : float
    largest_step : float
        Largest change of the value in a step that is allowed.
    """
    if len(values) <= MOST_STEPS:
        return []
    left = np.minimum.accumulate(np.abs(wanted - np.array(values)))
    least = min(PROGRESS, 0.1 * MOST_STEPS * largest_step) * left[0]
    return [] if left[-MOST_STEPS - 1] - left[-1] >= least else values[-MOST_STEPS:]
