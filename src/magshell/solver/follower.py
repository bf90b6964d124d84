"""Following a path: stage by stage, step by step, by what drives each stage, or by arc length where that fails."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.equations.instant import Increment
from magshell.evaluation.balance import Balance, balance
from magshell.solver.constraints import Constraint, Metric, Sphere
from magshell.solver.critical import LIMIT_POINT, CriticalPoint, locate, passed
from magshell.solver.diagnosis import diagnosis
from magshell.solver.events import Iteration, Observer
from magshell.solver.goals import Goal, LoadGoal, ProbeGoal, goals_of
from magshell.solver.newton import Solution, StepFailure, System, Trial, newton
from magshell.solver.path import Path
from magshell.solver.starts import Start, start_of
from magshell.solver.step import Step
from magshell.solver.track import Direction, Point, Slope, arc, close_factors, crossing, known, point_at, trial_at
from magshell.solver.waypoint import Waypoint

GROWTH, CUT = 2.5, 0.35
# Failures in a row after which the arc length is held instead.
PATIENCE = 2
# A step that failed is made again with at most this part of its length along the path.
LEAST_CUT = 0.5
# So many steps must come nearer to the next goal by this share of the way to it.
MOST_STEPS, PROGRESS = 100, 0.01
# Largest angle between a step and the direction of the path at either end: beyond it the path has been left.
SHARPEST = np.pi / 3
# Largest distance of a solution from its trial state, in lengths of the step: beyond it another path may have been met.
MISS = 0.2
# A step whose load grows by less than this share of what the slopes at both its ends say has jumped over a fold.
JUMP = 0.5
# First step along the mode of a branch, in sizes of the body.
BRANCH_STEP = 0.01


class Attempt(NamedTuple):
    """A step to be made.

    Attributes
    ----------
    trial : Trial
    constraint : Constraint or None
        What is held besides the supports; None: the load factor.
    at_goal : bool
        Whether it leads to the goal.
    distance : float
        Along the path, as it is expected.
    """

    trial: Trial
    constraint: Constraint | None
    at_goal: bool
    distance: float


class Follower:
    """Steps from goal to goal.

    What drives a stage (the load factor, a displacement or the arc length) is held in each step. Where holding a load
    factor or a displacement fails, the arc length is held instead until the next goal. What the next step depends on is
    a waypoint of the path when a step has converged, so a path that has steps already goes on with them.
    """

    def __init__(self, path: Path, system: System, observers: Sequence[Observer]) -> None:
        self.path, self.system, self.observers = path, system, observers
        self.settings, self.discretisation = path.settings, path.discretisation
        mesh = path.model.shell.mesh
        self.metric = Metric(1.0 / (len(mesh.points) * mesh.size**2))
        self.stage, self.track = 0, list[Point]()
        self.goal, self.taken, self.by_arc, self.radius = 0, 0, False, 0.0
        self.failure = StepFailure("")
        self.begin, self.cpu = time.perf_counter(), time.process_time() - path.cpu_seconds

    def run(self, stages: int) -> None:
        """Follow the path through its first stages; raises StepFailure with the reason."""
        trail = self.path.trail
        for number in range(trail[-1].step.stage if trail else 0, stages):
            start = self.enter(number)
            goals = goals_of(self.path.model, self.system.course)
            if trail and number == trail[-1].step.stage:
                self._resume(start, goals[0])
            else:
                self._begin(start, goals[0])
            for goal in goals[self.goal :]:
                self._reach(goal)

    def enter(self, number: int) -> Start:
        """Make a stage the present one."""
        start, self.stage = start_of(self.path, number), number
        course = self.path.model.course(number, start.amounts)
        self.path.courses[number:] = [course]
        self.system = self.system._replace(course=course)
        return start

    def _begin(self, start: Start, goal: Goal) -> None:
        """The first point of a stage, and the size of its first step."""
        point, solution = self._first(start, goal)
        self.track = [point]
        self.radius = BRANCH_STEP
        if start.mode is None:
            self.radius = self.settings.first_step / abs(point.slope.load)
        self._head_for(0)
        if not self.path.steps:
            self._keep(point, solution, None, [])

    def _resume(self, start: Start, goal: Goal) -> None:
        """The points and the size of the next step where the last step of a stage left them."""
        own = [waypoint for waypoint in self.path.trail if waypoint.step.stage == self.stage]
        self.track = [self._point(waypoint) for waypoint in own]
        if len(own) < 3 and self.stage > 0:
            self.track.insert(0, self._first(start, goal)[0])
        last = own[-1]
        self.goal, self.taken, self.by_arc, self.radius = last.goal, last.taken, last.by_arc, last.radius
        self.path.cuts, self.system.linear_solver.factorisations = last.cuts, last.solves

    def _first(self, start: Start, goal: Goal) -> tuple[Point, Solution]:
        """The first point of a stage, and its state as a solution."""
        state = start.state
        trial = Trial(state, 0.0, self.discretisation.predicted(state))
        solution = Solution(trial, self.system.assemble(trial), [0.0], None, None)
        along: Direction = np.zeros_like(state.u), 1.0
        point = point_at(self.system, self.metric, solution, None, start.arc_length, along)
        if start.mode is not None:
            length = self.metric.norm(start.mode[:, :3], 0.0)
            slope = Slope(Increment(start.mode / length, np.zeros_like(state.alpha)), 0.0)
            return point._replace(slope=slope, negative_pivots=None), solution
        if isinstance(goal, ProbeGoal) and goal.slope(point.slope) * (goal.wanted - goal.value(point)) < 0.0:
            return point._replace(slope=point.slope.reversed), solution
        return point, solution

    def _point(self, waypoint: Waypoint) -> Point:
        step = waypoint.step
        prediction = self.discretisation.predicted(step.state)
        return Point(step.arc_length, step.load_factor, step.state, waypoint.slope, prediction, step.negative_pivots)

    def _head_for(self, goal: int) -> None:
        """Make a goal of the stage the next one."""
        self.goal, self.taken = goal, 0
        self.by_arc = self.system.course.stage.control == "arc-length"

    def _reach(self, goal: Goal) -> None:
        """Steps until the goal is met.

        A step that fails is made again at most half as long, so that failures in a row have an end; `_stray` bounds the
        steps that succeed.
        """
        failures = 0
        while True:
            attempt = self._next(goal)
            last, trial = self.track[-1], attempt.trial
            distance = self.metric.norm(trial.state.u - last.state.u, trial.load_factor - last.load_factor)
            solved = self._solved(attempt, goal)
            if solved is not None:
                point, solution, critical = solved
                grown = distance * self._growth(solution.solves)
                self.radius = max(self.radius, grown) if attempt.at_goal else grown
                self.taken += 1
                if attempt.at_goal:
                    self._head_for(self.goal + 1)
                self.track = [*self.track[-2:], point]
                self._keep(point, solution, self._balance(solution), critical)
                if attempt.at_goal:
                    return
                failures = 0
                self._stray(goal)
                continue
            failures += 1
            self.by_arc |= failures == PATIENCE
            self.radius = min(CUT * distance, LEAST_CUT * attempt.distance)
            if not self.radius >= self.settings.smallest_step:
                raise StepFailure(self._give_up(trial.load_factor))

    def _stray(self, goal: Goal) -> None:
        """Raise StepFailure if the last steps came no nearer to the goal than the ones before."""
        values = [goal.value(step) for step in self.path.steps[-self.taken :]]
        if len(values) <= MOST_STEPS:
            return
        left = np.minimum.accumulate(np.abs(goal.wanted - np.array(values)))
        least = min(PROGRESS, 10.0 * self.settings.largest_step) * left[0]
        if left[-MOST_STEPS - 1] - left[-1] < least:
            raise StepFailure(self._strayed(goal, values[-MOST_STEPS:]))

    def _next(self, goal: Goal) -> Attempt:
        """The next trial state, and what is held in its step."""
        longest = self._longest() if isinstance(goal, LoadGoal) else self.radius
        track = known(self.track, longest)
        values, last = [goal.value(point) for point in track], track[-1]
        at = crossing(track, values, goal.slope(last.slope), goal.wanted, 2.0 * longest)
        if at is not None and at <= 1.3 * longest:
            wanted = goal.wanted if isinstance(goal, LoadGoal) else None
            return Attempt(self._trial(at, wanted), goal.hold_wanted(), True, at)
        distance = longest if at is None else 0.5 * at
        trial = self._trial(distance)
        nearer = (goal.value(trial) - values[-1]) * (goal.wanted - values[-1]) > 0.0
        if nearer and not self.by_arc:
            return Attempt(trial, goal.hold(trial), False, distance)
        chord: Direction = trial.state.u - last.state.u, trial.load_factor - last.load_factor
        sphere = Sphere(self.metric, last.state.u, last.load_factor, *chord, self.metric.norm(*chord))
        return Attempt(trial, sphere, False, distance)

    def _trial(self, distance: float, load_factor: float | None = None) -> Trial:
        return trial_at(self.discretisation, self.system.course, known(self.track, distance), distance, load_factor)

    def _longest(self) -> float:
        """The radius, or less where the load factor would change by more than the largest step."""
        track, largest = known(self.track, self.radius), self.settings.largest_step
        loads = [point.load_factor for point in track]
        limits = [
            crossing(track, loads, track[-1].slope.load, loads[-1] + change, self.radius)
            for change in (largest, -largest)
        ]
        return min((limit for limit in limits if limit is not None), default=self.radius)

    def _solved(self, attempt: Attempt, goal: Goal) -> tuple[Point, Solution, list[CriticalPoint]] | None:
        """What a step leads to, and the critical points passed; None, and the observers know why, if it failed."""
        last, trial = self.track[-1], attempt.trial
        try:
            solution = newton(self.system, trial, attempt.constraint, lambda *heard: self._report(trial, *heard))
            found = solution.trial
            chord: Direction = found.state.u - last.state.u, found.load_factor - last.load_factor
            # No factors outlive their use: two sets of them at a time would be twice the memory.
            factors, solution = close_factors(self.metric, solution, chord), solution._replace(factors=None)
            point = point_at(self.system, self.metric, solution, factors, 0.0, chord)
            factors = None
            length = arc(self.metric, chord, last.slope, point.slope)
            point = point._replace(arc_length=last.arc_length + length)
            missed: Direction = found.state.u - trial.state.u, found.load_factor - trial.load_factor
            self._check(point, chord, length, self.metric.norm(*missed))
            if not attempt.at_goal and (goal.wanted - goal.value(last)) * (goal.wanted - goal.value(point)) <= 0.0:
                raise StepFailure("the step goes beyond a stop")
            return point, solution, self._located(last, point)
        except StepFailure as failure:
            self.failure = StepFailure(str(failure), failure.inverted)  # without the frames, which hold the factors
            self.path.cuts += 1
            for observer in self.observers:
                observer.cut(trial.load_factor, str(failure))
            return None

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

    def _keep(
        self, point: Point, solution: Solution, balanced: Balance | None, critical: Sequence[CriticalPoint]
    ) -> None:
        """Lengthen the path, and tell of it."""
        loading = self.system.course.at(point.load_factor)
        step = Step(
            len(self.path.steps), point.load_factor, point.state, solution.solves, solution.residuals[-1], balanced,
            point.arc_length, self.stage, loading.flux_density, loading.loads, point.negative_pivots,
        )  # fmt: skip
        self.path.add(
            Waypoint(
                step, tuple(critical), point.slope, self.goal, self.taken, self.by_arc, self.radius, self.path.cuts,
                self.system.linear_solver.factorisations, time.process_time() - self.cpu,
            )
        )  # fmt: skip
        for observer in self.observers:
            observer.kept(self.path)
        for observer in self.observers:
            observer.converged(step)
        for one in critical:
            for observer in self.observers:
                observer.critical(one)

    def _growth(self, solves: int) -> float:
        """Factor of the step size after the solves that the last step took."""
        return float(np.clip(self.settings.target_iterations / max(solves, 1), 0.4, GROWTH))

    def _give_up(self, load_factor: float) -> str:
        """Where the path ends, what fails there, and why."""
        path, cuts = self.path, self.path.cuts
        turns = [point for point in path.critical_points if point.kind == LIMIT_POINT and point.stage == self.stage]
        turned = (
            f" The load factor turned at {turns[-1].load_factor:.6g} (critical point {turns[-1].number})."
            if turns
            else ""
        )
        return (
            f"{self._position()}: after {cuts} cut{'s' * (cuts != 1)} the step to {load_factor:.6g} still fails: "
            f"{self.failure}.{turned} {self._diagnosis(self.failure.inverted)}"
        )

    def _strayed(self, goal: Goal, values: Sequence[float]) -> str:
        """The same of a path that goes on without coming nearer to a goal."""
        turns = int(np.count_nonzero(np.diff(np.sign(np.diff(values)))))
        return (
            f"{self._position()}: the last {MOST_STEPS} steps came no nearer to the next stop, {goal.named}; "
            f"it went to and fro between {min(values):.4g} and {max(values):.4g} and turned {turns} times. "
            f"{self._diagnosis(None)}"
        )

    def _position(self) -> str:
        last = self.path.steps[-1]
        magnitude = float(np.linalg.norm(last.flux_density))
        field = f" ({1e3 * magnitude:.4g} mT)" if magnitude > 0.0 else ""
        where = f" of stage {last.stage + 1}" if len(self.path.model.stages) > 1 else ""
        return f"stopped at load factor {last.load_factor:.6g}{where}{field}"

    def _diagnosis(self, inverted: int | None) -> str:
        last = self.path.steps[-1]
        return diagnosis(self.discretisation, last.state, self.path.loading(last), inverted)
