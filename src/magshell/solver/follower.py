"""Following a path: stage by stage, step by step, by what drives each stage, or by arc length where that fails."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.state import State
from magshell.solver.balance import Balance, balance
from magshell.solver.constraints import Constraint, Metric, Sphere
from magshell.solver.critical import LIMIT_POINT, CriticalPoint, locate, passed
from magshell.solver.events import Iteration, Observer
from magshell.solver.goals import Goal, LoadGoal, ProbeGoal, goals_of
from magshell.solver.newton import Solution, StepFailure, System, Trial, newton
from magshell.solver.path import Path, Step
from magshell.solver.track import Direction, Point, Slope, arc, crossing, point_at, trial_at

GROWTH, CUT = 2.5, 0.35
# Failures in a row after which the arc length is held instead.
PATIENCE = 2
# Steps that a path may take by arc length to its next goal.
WANDERING = 1000
# Largest angle between a step and the direction of the path at either end: beyond it the path has been left.
SHARPEST = np.pi / 3
# Largest distance of a solution from its trial state, in lengths of the step: beyond it another path may have been met.
MISS = 0.2
# A step whose load grows by less than this share of what the slopes at both its ends say has jumped over a fold.
JUMP = 0.5
# First step along the mode of a branch, in sizes of the body.
BRANCH_STEP = 0.01


class Follower:
    """Steps from goal to goal.

    What drives a stage (the load factor, a displacement or the arc length) is held in each step. Where holding a load
    factor or a displacement fails, the arc length is held instead until the next goal.
    """

    def __init__(self, path: Path, system: System, observers: Sequence[Observer]) -> None:
        self.path, self.system, self.observers = path, system, observers
        self.settings, self.discretisation = path.settings, path.discretisation
        mesh = path.model.shell.mesh
        self.metric = Metric(1.0 / (len(mesh.points) * mesh.size**2))
        self.stage, self.track = 0, list[Point]()
        self.radius, self.by_arc, self.reason = 0.0, False, ""
        self.begin = time.perf_counter()

    def run(self, stages: int) -> None:
        """Follow the path through its first stages; raises StepFailure with the reason."""
        for number in range(stages):
            state, arc_length, mode = self.enter(number)
            goals = goals_of(self.path.model, self.system.course)
            self._begin(state, arc_length, mode, goals[0])
            for goal in goals:
                self.by_arc = self.system.course.stage.control == "arc-length"
                self._reach(goal)

    def enter(self, number: int) -> tuple[State, float, FloatArray | None]:
        """Make a stage the present one; its first state, the arc length there and, on a branch, the mode."""
        model, self.stage = self.path.model, number
        stage, start = model.stages[number], None
        state, arc_length, mode = self.discretisation.undeformed(), 0.0, None
        if stage.branch is not None:
            critical = self._critical(stage.branch)
            state, arc_length, mode = critical.state, critical.arc_length, stage.side * critical.mode
            start = self.path.courses[critical.stage].amounts(critical.load_factor)
        elif self.path.steps:
            last = self.path.steps[-1]
            state, arc_length = last.state, last.arc_length
            start = self.path.courses[last.stage].amounts(last.load_factor)
        course = model.course(number, start)
        self.path.courses.append(course)
        self.system = self.system._replace(course=course)
        return state, arc_length, mode

    def _critical(self, number: int) -> CriticalPoint:
        found = self.path.critical_points
        if number > len(found):
            raise StepFailure(
                f"stage {self.stage + 1} wants to branch off at critical point {number}, but the path before it has "
                f"{len(found) or 'none'}"
            )
        return found[number - 1]

    def _begin(self, state: State, arc_length: float, mode: FloatArray | None, goal: Goal) -> None:
        """The first point of a stage, and the size of its first step."""
        trial = Trial(state, 0.0, self.discretisation.stresses_at(state))
        solution = Solution(trial, self.system.assemble(trial), [0.0], None)
        point = point_at(self.system, self.metric, solution, arc_length, (np.zeros_like(state.u), 1.0))
        if mode is not None:
            length = self.metric.norm(mode[:, :3], 0.0)
            slope = Slope(mode / length, np.zeros_like(state.alpha), 0.0)
            point, self.radius = point._replace(slope=slope, negative_pivots=None), BRANCH_STEP
        else:
            self.radius = self.settings.first_step / point.slope.load
            if isinstance(goal, ProbeGoal) and goal.slope(point.slope) * (goal.wanted - goal.value(point)) < 0.0:
                point = point._replace(slope=point.slope.reversed)
        self.track = [point]
        if not self.path.steps:
            self._keep(point, solution, None)

    def _reach(self, goal: Goal) -> None:
        """Steps until the goal is met."""
        steps, failures = 0, 0
        while True:
            last, (trial, constraint, at_goal) = self.track[-1], self._next(goal)
            distance = self.metric.norm(trial.state.u - last.state.u, trial.load_factor - last.load_factor)
            point = self._solved(trial, constraint, goal, at_goal)
            if point is not None:
                grown = distance * self._growth()
                self.radius = max(self.radius, grown) if at_goal else grown
                failures, steps = 0, steps + 1
                if at_goal:
                    return
                if self.by_arc and steps > WANDERING:
                    raise StepFailure(
                        f"{_position(self.path)}: {WANDERING} steps by arc length have not led to the next stop"
                    )
                continue
            failures += 1
            self.by_arc |= failures == PATIENCE
            self.radius = CUT * distance
            if self.radius < self.settings.smallest_step:
                break
        raise StepFailure(_give_up(self.path, self.stage, trial.load_factor, self.reason))

    def _next(self, goal: Goal) -> tuple[Trial, Constraint | None, bool]:
        """The next trial state, what is held in its step, and whether the step leads to the goal."""
        track, longest = self.track, self._longest() if isinstance(goal, LoadGoal) else self.radius
        values = [goal.value(point) for point in track[-3:]]
        at = crossing(track, values, goal.slope(track[-1].slope), goal.wanted, 2.0 * longest)
        if at is not None and at <= 1.3 * longest:
            wanted = goal.wanted if isinstance(goal, LoadGoal) else None
            return self._trial(at, wanted), goal.hold_wanted(), True
        trial = self._trial(longest if at is None else 0.5 * at)
        nearer = (goal.value(trial) - values[-1]) * (goal.wanted - values[-1]) > 0.0
        if nearer and not self.by_arc:
            return trial, goal.hold(trial), False
        chord: Direction = trial.state.u - track[-1].state.u, trial.load_factor - track[-1].load_factor
        sphere = Sphere(self.metric, track[-1].state.u, track[-1].load_factor, *chord, self.metric.norm(*chord))
        return trial, sphere, False

    def _trial(self, distance: float, load_factor: float | None = None) -> Trial:
        return trial_at(self.discretisation, self.system.course, self.track, distance, load_factor)

    def _longest(self) -> float:
        """The radius, or less where the load factor would change by more than the largest step."""
        track, largest = self.track, self.settings.largest_step
        loads = [point.load_factor for point in track[-3:]]
        limits = [
            crossing(track, loads, track[-1].slope.load, loads[-1] + change, self.radius)
            for change in (largest, -largest)
        ]
        return min((limit for limit in limits if limit is not None), default=self.radius)

    def _solved(self, trial: Trial, constraint: Constraint | None, goal: Goal, at_goal: bool) -> Point | None:
        """The point that a step leads to, which is then kept; None, and the observers know why, if it failed."""
        last = self.track[-1]
        try:
            solution = newton(self.system, trial, constraint, lambda *heard: self._report(trial, *heard))
            found = solution.trial
            chord: Direction = found.state.u - last.state.u, found.load_factor - last.load_factor
            point = point_at(self.system, self.metric, solution, 0.0, chord)
            length = arc(self.metric, chord, last.slope, point.slope)
            point = point._replace(arc_length=last.arc_length + length)
            missed: Direction = found.state.u - trial.state.u, found.load_factor - trial.load_factor
            self._check(point, chord, length, self.metric.norm(*missed))
            if not at_goal and (goal.wanted - goal.value(last)) * (goal.wanted - goal.value(point)) <= 0.0:
                raise StepFailure("the step goes beyond a stop")
            critical = self._located(last, point)
        except StepFailure as failure:
            self.reason = str(failure)
            self.path.cuts += 1
            for observer in self.observers:
                observer.cut(trial.load_factor, self.reason)
            return None
        self.track = [*self.track[-2:], point]
        self._keep(point, solution, self._balance(solution))
        for one in critical:
            self.path.critical_points.append(one)
            for observer in self.observers:
                observer.critical(one)
        return point

    def _check(self, point: Point, chord: Direction, length: float, missed: float) -> None:
        """Whether a point lies on the path that was followed so far; raises StepFailure with what speaks against it."""
        last, distance = self.track[-1], self.metric.norm(*chord)
        if missed > MISS * length:
            raise StepFailure("the solution is not where the path was expected")
        sharpest = np.cos(SHARPEST) * distance
        for slope in (last.slope, point.slope):
            if self.metric.product(slope.direction, chord) < sharpest:
                raise StepFailure("the step leaves the path, or turns back on it")
        least = min(last.slope.load, point.slope.load)
        if least > 0.0 and chord[1] < JUMP * least * length:
            raise StepFailure("the step jumps over a part of the path where the load factor falls")

    def _located(self, before: Point, after: Point) -> list[CriticalPoint]:
        """The critical points between two points; raises StepFailure if no path leads from one to the other."""
        if not passed(before, after):
            return []
        course, number = self.system.course, len(self.path.critical_points)
        return [
            CriticalPoint(
                number + count, kind, self.stage, point.load_factor, course.at(point.load_factor).flux_density,
                point.arc_length, point.state, mode, pivots,
            )
            for count, (kind, point, mode, pivots) in enumerate(
                locate(self.system, self.metric, before, after, self._report), start=1
            )
        ]  # fmt: skip

    def _balance(self, solution: Solution) -> Balance:
        loading = self.system.course.at(solution.trial.load_factor)
        return balance(self.discretisation, solution.trial.state, loading, solution.assembly.residual)

    def _report(self, trial: Trial, iteration: int, kind: str, residual: float) -> None:
        self.path.solves = self.system.linear_solver.factorisations
        seconds = time.perf_counter() - self.begin
        for observer in self.observers:
            observer.iterated(
                Iteration(len(self.path.steps), self.stage, trial.load_factor, iteration, residual, kind, seconds)
            )

    def _keep(self, point: Point, solution: Solution, balanced: Balance | None) -> None:
        loading = self.system.course.at(point.load_factor)
        step = Step(
            len(self.path.steps), point.load_factor, point.state, solution.solves, solution.residuals[-1], balanced,
            point.arc_length, self.stage, loading.flux_density, loading.loads, point.negative_pivots,
        )  # fmt: skip
        self.path.steps.append(step)
        for observer in self.observers:
            observer.converged(step)

    def _growth(self) -> float:
        """Factor of the step size after the solves that the last step took."""
        return float(np.clip(self.settings.target_iterations / max(self.path.steps[-1].iterations, 1), 0.4, GROWTH))


def _position(path: Path) -> str:
    last = path.steps[-1]
    magnitude = float(np.linalg.norm(last.flux_density))
    field = f" ({1e3 * magnitude:.4g} mT)" if magnitude > 0.0 else ""
    where = f" of stage {last.stage + 1}" if len(path.model.stages) > 1 else ""
    return f"stopped at load factor {last.load_factor:.6g}{where}{field}"


def _give_up(path: Path, stage: int, load_factor: float, reason: str) -> str:
    turns = [point for point in path.critical_points if point.kind == LIMIT_POINT and point.stage == stage]
    turned = (
        f" The load factor turned at {turns[-1].load_factor:.6g} (critical point {turns[-1].number})." if turns else ""
    )
    return (
        f"{_position(path)}: after {path.cuts} cut{'s' * (path.cuts != 1)} "
        f"the step to {load_factor:.6g} still fails: {reason}.{turned} Likely causes: a mesh too coarse for the local "
        "bending, a path that bends too sharply, or a unit slip; `magshell check` shows the magnitudes"
    )
