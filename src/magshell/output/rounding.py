"""Outputs along a path without their round-off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import Output
from magshell.solver.path import Path
from magshell.solver.step import Step

STILL = 1e-12
"""Displacement, in sizes of the body, that is round-off."""


def without_round_off(path: Path, outputs: Sequence[Output], steps: Iterable[Step]) -> Iterator[list[FloatArray]]:
    """Outputs at each step; what is nothing but rounding is zero.

    That is 1e-9 of an output's largest component where the path is farthest from rest.
    """
    farthest = converged(path.discretisation, max(path.steps, key=lambda step: float(np.abs(step.state.u).max())))
    noise = [1e-9 * float(np.abs(output.evaluate(farthest)).max()) for output in outputs]
    del farthest
    for step in steps:
        reached = converged(path.discretisation, step)
        found = [np.array(output.evaluate(reached), dtype=float) for output in outputs]
        for values, least in zip(found, noise, strict=True):
            values[np.abs(values) <= least] = 0.0
        yield found
