"""The history of a path: its numbers step by step, each step evaluated once, work summed from step to step."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from magshell.equations.discretisation import Discretisation
from magshell.evaluation.converged import Converged, Reached, converged
from magshell.evaluation.series import Number, columns, evaluated
from magshell.evaluation.work import Acting, Work, no_work
from magshell.solver.critical import CriticalPoint
from magshell.solver.step import Step

ABOUT = ("stage", "arc_length", "negative_pivots")


class History:
    """The rows of `history.csv`.

    Parameters
    ----------
    discretisation : Discretisation
    steps, critical_points : sequence of Step, sequence of CriticalPoint
        Of the path, which may grow.
    """

    def __init__(
        self,
        discretisation: Discretisation,
        steps: Sequence[Step] = (),
        critical_points: Sequence[CriticalPoint] = (),
    ) -> None:
        self._discretisation, self._path, self._critical_points = discretisation, steps, critical_points
        self._steps: list[Step] = []
        self._rows: list[list[Number]] = []
        self._work: list[Work] = []
        self._last: Acting | None = None
        self._lock = threading.RLock()

    @property
    def columns(self) -> list[str]:
        """Names: field, probes, what only the path knows, and then the columns of all series."""
        model = self._discretisation.model
        probes = [f"{name}.u{i}" for name in model.probe_nodes for i in (1, 2, 3)]
        return ["load_factor", "B1", "B2", "B3", *probes, *ABOUT, *columns(model)]

    def row(self, step: Step) -> list[Number]:
        """Numbers of a step, in the order of the columns; None where there is none.

        Those of the steps before it are evaluated first, as work is summed; what was asked for is kept.
        """
        with self._lock:
            for one in [*self._path[len(self._rows) : step.number], step]:
                if one.number == len(self._rows):
                    self._steps.append(one)
                    self._rows.append(self._evaluated(one))
            return self._rows[step.number]

    def rows(self, steps: Sequence[Step]) -> list[list[Number]]:
        """Of all steps of the path, from the first."""
        return [self.row(step) for step in steps]

    def _evaluated(self, step: Step) -> list[Number]:
        reached = converged(self._discretisation, step)
        before, work = self._before(step)
        reached.work = work if before is None else work.plus(reached.work_from(before))
        self._work.append(reached.work)
        self._last = reached.acting
        u = [step.state.u[node].tolist() for node in self._discretisation.model.probe_nodes.values()]
        of_path = [step.stage + 1, float(step.arc_length), step.negative_pivots]
        course = self._discretisation.model.course(step.stage)
        field = [None if np.isnan(B) else float(B) for B in course.reported(step.load_factor, step.flux_density)]
        head = [float(step.load_factor), *field, *(number for one in u for number in one)]
        return [*head, *of_path, *evaluated(reached)]

    def _before(self, step: Step) -> tuple[Acting | None, Work]:
        """What acts at the state on the path before a step, and the work up to there."""
        if self._last is None or (step.number == 1 and self._discretisation.model.turns):
            return None, no_work(self._discretisation)
        last = self._steps[-2]
        stage = self._discretisation.model.stages[step.stage]
        if step.stage == last.stage or stage.branch is None:
            return self._last, self._work[-1]
        return self._at(self._critical_points[stage.branch - 1])

    def _at(self, point: CriticalPoint) -> tuple[Acting, Work]:
        """A critical point, where a branch starts, and the work on the way to it."""
        number = next(
            one.number
            for one, after in pairwise(self._steps)
            if after.stage == point.stage and one.arc_length <= point.arc_length <= after.arc_length
        )
        there = self._converged(point)
        return there.acting, self._work[number].plus(there.work_from(self._converged(self._steps[number]).acting))

    def _converged(self, reached: Reached) -> Converged:
        return converged(self._discretisation, reached)
