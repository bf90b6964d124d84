"""Outputs along a path without their round-off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from magshell.arrays import FloatArray
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import Output
from magshell.solver.path import Path
from magshell.solver.step import Step


def without_round_off(path: Path, output: Output, steps: Iterable[Step]) -> Iterator[FloatArray]:
    """An output at each step; what is nothing but rounding is zero.

    That is 1e-9 of its largest component where the path is farthest from rest.
    """
    farthest = max(path.steps, key=lambda step: float(np.abs(step.state.u).max()))
    noise = 1e-9 * float(np.abs(output.evaluate(converged(path.discretisation, farthest))).max())
    for step in steps:
        values = np.array(output.evaluate(converged(path.discretisation, step)), dtype=float)
        values[np.abs(values) <= noise] = 0.0
        yield values
