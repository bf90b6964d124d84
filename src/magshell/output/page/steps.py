"""Which steps a page shows: all of them, or as many as a browser opens with ease."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from magshell.evaluation.outputs import chosen
from magshell.evaluation.patches import patches_of

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

MOST_BYTES = 100_000_000
"""Of the numbers in a page, if all changed in every step. Measured without a graphics card, a page of 90 MB opens in
2 s and takes 330 MB of memory, one of 270 MB 4 s and 640 MB, one of 520 MB 10 s and 1.1 GB."""
BYTES_PER_NUMBER = 2 * 4 / 3
"""Sixteen bits in base64."""


def shown_steps(path: Path) -> list[Step]:
    """The steps of a page; if all would be too many bytes, some, evenly spread between those that must not be missed.

    These are the first and the last, the last of each stage, and those before and after a critical point.
    """
    count = len(path.steps)
    most = max(2, int(MOST_BYTES / _bytes_of_step(path)))
    if count <= most:
        return path.steps
    telling = _telling(path)
    if len(telling) >= most:
        kept = {telling[i] for i in np.linspace(0, len(telling) - 1, most).astype(int)}
    else:
        others = [number for number in range(count) if number not in telling]
        free = most - len(telling)
        kept = {*telling, *(others[int((i + 0.5) * len(others) / free)] for i in range(free))}
    return [path.steps[number] for number in sorted(kept)]


def _telling(path: Path) -> list[int]:
    """Places in the path of the steps that must not be missed."""
    steps = path.steps
    stage_ends = {i for i in range(len(steps) - 1) if steps[i].stage != steps[i + 1].stage}
    after = np.searchsorted([step.arc_length for step in steps[:-1]], [p.arc_length for p in path.critical_points])
    return sorted({0, len(steps) - 1, *stage_ends, *(int(i) + side for i in after if i for side in (-1, 0))})


def _bytes_of_step(path: Path) -> float:
    """Of all outputs, as if each changed in every step."""
    mesh = path.discretisation.mesh
    rows, cells = len(patches_of(path.model.shell).nodes), len(mesh.elements)
    outputs = chosen(path.model.outputs)
    return BYTES_PER_NUMBER * sum((cells if output.where == "cell" else rows) * output.components for output in outputs)
