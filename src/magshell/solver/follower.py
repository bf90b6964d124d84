"""Following a path: stage by stage, step by step, by what drives each stage, or by arc length where that fails."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from magshell.equations.instant import Increment
from magshell.evaluation.balance import Balance, balance
from magshell.shell.unknowns import COMPONENTS
from magshell.solver.attempt import Attempt, next_attempt
from magshell.solver.constraints import Metric
from magshell.solver.continuity import check_near, length_along
from magshell.solver.critical import LIMIT_POINT, CriticalPoint, locate, passed
from magshell.solver.diagnosis import diagnosis
from magshell.solver.events import Iteration, Observer
from magshell.solver.goals import Goal, LoadGoal, ProbeGoal, goals_of
from magshell.solver.newton import Solution, StepFailure, System, Trial, newton
from magshell.solver.path import Path
from magshell.solver.starts import Start, start_of
from magshell.solver.step import Step
from magshell.solver.step_control import StepControl, StepRules, stagnant
from magshell.solver.track import Direction, Point, Slope, close_factors, point_at
from magshell.solver.turning import turned
from magshell.solver.waypoint import Waypoint

# Failures in a row after which the arc length is held instead.
PATIENCE = 2
# Under load control a path ends where its load factor has gone back behind the start of the stage by so much.
BACK = 1.0
# First step along the mode of a branch, in sizes of the body.
BRANCH_STEP = 0.01


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
        self.goal, self.taken, self.by_arc = 0, 0, False
        self.control = StepControl(StepRules(self.settings.target_iterations, self.settings.smallest_step), 0.0)
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
        if self._lets_turn(start):
            self._keep_undeformed(start)
            self._release(start, goal)
            return
        point, solution = self._first(start, goal)
        self.track = [point]
        size = BRANCH_STEP if start.mode is not None else self.settings.first_step / abs(point.slope.load)
        self.control = self.control._replace(size=size, failures=0)
        self._head_for(0)
        if not self.path.steps:
            self._keep(point, solution, None, [])

    def _lets_turn(self, start: Start) -> bool:
        """Whether a stage starts from the undeformed state of a body that the field alone holds, as a needle."""
        return bool(self.path.model.turns) and self.stage == 0 and start.mode is None

    def _keep_undeformed(self, start: Start) -> None:
        """Without a field every angle is in equilibrium: the first step has no tangent and no slope."""
        state = start.state
        trial = Trial(state, 0.0, self.system.predicted(state, 0.0))
        solution = Solution(trial, self.system.assemble(trial), [0.0], None, None)
        still = Slope(Increment(np.zeros((len(state.u), COMPONENTS)), np.zeros_like(state.alpha)), 1.0)
        self._keep(Point(0.0, 0.0, state, still, trial.prediction, None), solution, None, [])

    def _release(self, start: Start, goal: Goal) -> None:
        """The second step: in the first field, a weak one, the body has turned as a whole (`turning.py`)."""
        load = self.settings.first_step
        if isinstance(goal, LoadGoal):
            load = min(load, 0.5 * goal.wanted)
        state = turned(self.discretisation, self.system.course.at(load))
        trial = Trial(state, load, self.system.predicted(state, load))
        solution = newton(self.system, trial, None, lambda *heard: self._report(trial, *heard))
        along: Direction = np.zeros_like(state.u), 1.0
        length = self.metric.norm(solution.trial.state.u, load)
        point = point_at(self.system, self.metric, solution, None, length, along)
        if isinstance(goal, ProbeGoal) and goal.slope(point.slope) * (goal.wanted - goal.value(point)) < 0.0:
            point = point._replace(slope=point.slope.reversed)
        self.track = [point]
        self.control = self.control._replace(size=self.settings.first_step / abs(point.slope.load), failures=0)
        self._head_for(0)
        self.taken = 1
        self._keep(point, solution, self._balance(solution), [])

    def _resume(self, start: Start, goal: Goal) -> None:
        """The points and the size of the next step where the last step of a stage left them."""
        own = [waypoint for waypoint in self.path.trail if waypoint.step.stage == self.stage]
        if self._lets_turn(start):
            own = [waypoint for waypoint in own if waypoint.step.number > 0]
            if not own:
                self._release(start, goal)
                return
        self.track = [self._point(waypoint) for waypoint in own]
        if len(own) < 3 and self.stage > 0:
            self.track.insert(0, self._first(start, goal)[0])
        last = own[-1]
        self.goal, self.taken, self.by_arc = last.goal, last.taken, last.by_arc
        self.control = self.control._replace(size=last.radius)
        self.path.cuts, self.system.linear_solver.factorisations = last.cuts, last.solves

    def _first(self, start: Start, goal: Goal) -> tuple[Point, Solution]:
        """The first point of a stage, and its state as a solution."""
        state = start.state
        trial = Trial(state, 0.0, self.system.predicted(state, 0.0))
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
        prediction = self.system.predicted(step.state, step.load_factor)
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
        while True:
            attempt = next_attempt(self.system, self.metric, self.track, goal, self.control.size, self.by_arc)
            solved = self._solved(attempt, goal)
            if solved is None:
                self.control = self.control.failed(attempt.size, attempt.intended)
                self.by_arc |= self.control.failures == PATIENCE
                if self.control.exhausted:
                    raise StepFailure(self._give_up(attempt.trial.load_factor))
                continue
            point, solution, critical = solved
            self.control = self.control.succeeded(attempt.size, solution.solves, shortened=attempt.at_goal)
            self.taken += 1
            if attempt.at_goal:
                self._head_for(self.goal + 1)
            self.track = [*self.track[-2:], point]
            self._keep(point, solution, self._balance(solution), critical)
            if attempt.at_goal:
                return
            self._stray(goal)

    def _stray(self, goal: Goal) -> None:
        """Raise StepFailure if the last steps came no nearer to the goal than the ones before, or went far back."""
        if self.system.course.stage.control == "load" and self.track[-1].load_factor < -BACK:
            raise StepFailure(
                f"{self._position()}: under load control the path went back behind the start of the stage, as far as "
                f"the stage leads forward.{self._turned()} {self._diagnosis(None)}"
            )
        values = [goal.value(step) for step in self.path.steps[-self.taken :]]
        if last := stagnant(values, goal.wanted, self.settings.largest_step):
            raise StepFailure(self._strayed(goal, last))

    def _solved(self, attempt: Attempt, goal: Goal) -> tuple[Point, Solution, list[CriticalPoint]] | None:
        """What a step leads to, and the critical points passed; None, and the observers know why, if it failed."""
        last, trial = self.track[-1], attempt.trial
        try:
            solution = newton(self.system, trial, attempt.constraint, lambda *heard: self._report(trial, *heard))
            found = solution.trial
            chord: Direction = found.state.u - last.state.u, found.load_factor - last.load_factor
            missed: Direction = found.state.u - trial.state.u, found.load_factor - trial.load_factor
            # No factors outlive their use: two sets of them at a time would be twice the memory.
            factors, solution = close_factors(self.metric, solution, chord), solution._replace(factors=None)
            point = point_at(self.system, self.metric, solution, factors, 0.0, chord)
            factors = None
            length = length_along(self.metric, last, point)
            check_near(self.metric.norm(*missed), length)
            point = point._replace(arc_length=last.arc_length + length)
            if not attempt.at_goal and (goal.wanted - goal.value(last)) * (goal.wanted - goal.value(point)) <= 0.0:
                raise StepFailure("the step goes beyond a stop")
            return point, solution, self._located(last, point)
        except StepFailure as failure:
            self.failure = StepFailure(str(failure), failure.inverted)  # without the frames, which hold the factors
            self.path.cuts += 1
            for observer in self.observers:
                observer.cut(trial.load_factor, str(failure))
            return None

    def _located(self, before: Point, after: Point) -> list[CriticalPoint]:
        """The critical points between two points; raises StepFailure if no path leads from one to the other."""
        if not passed(before, after):
            return []
        course, number = self.system.course, len(self.path.critical_points)
        return [
            CriticalPoint(
                number=number + count,
                kind=found.kind,
                stage=self.stage,
                load_factor=found.point.load_factor,
                flux_density=course.at(found.point.load_factor).flux_density,
                arc_length=found.point.arc_length,
                state=found.point.state,
                mode=found.mode,
                negative_pivots=found.negative_pivots,
            )
            for count, found in enumerate(locate(self.system, self.metric, before, after, self._report), start=1)
        ]

    def _balance(self, solution: Solution) -> Balance:
        loading = self.system.course.at(solution.trial.load_factor)
        return balance(self.discretisation, solution.trial.state, loading, solution.assembly.residual)

    def _report(self, trial: Trial, iteration: int, kind: str, residual: float) -> None:
        self.path.solves = self.system.linear_solver.factorisations
        told = Iteration(
            step=len(self.path.steps),
            stage=self.stage,
            load_factor=trial.load_factor,
            iteration=iteration,
            residual=residual,
            kind=kind,
            seconds=time.perf_counter() - self.begin,
        )
        for observer in self.observers:
            observer.iterated(told)

    def _keep(
        self, point: Point, solution: Solution, balanced: Balance | None, critical: Sequence[CriticalPoint]
    ) -> None:
        """Lengthen the path, and tell of it."""
        loading = self.system.course.at(point.load_factor)
        step = Step(
            number=len(self.path.steps),
            load_factor=point.load_factor,
            state=point.state,
            iterations=solution.solves,
            residual=solution.residuals[-1],
            balance=balanced,
            arc_length=point.arc_length,
            stage=self.stage,
            flux_density=loading.flux_density,
            loads=loading.loads,
            negative_pivots=point.negative_pivots,
            drives=loading.drives,
        )
        self.path.add(
            Waypoint(
                step=step,
                critical_points=tuple(critical),
                slope=point.slope,
                goal=self.goal,
                taken=self.taken,
                by_arc=self.by_arc,
                radius=self.control.size,
                cuts=self.path.cuts,
                solves=self.system.linear_solver.factorisations,
                cpu_seconds=time.process_time() - self.cpu,
            )
        )
        for observer in self.observers:
            observer.kept(self.path)
        for observer in self.observers:
            observer.converged(step)
        for one in critical:
            for observer in self.observers:
                observer.critical(one)

    def _give_up(self, load_factor: float) -> str:
        """Where the path ends, what fails there, and why."""
        cuts = self.path.cuts
        return (
            f"{self._position()}: after {cuts} cut{'s' * (cuts != 1)} the step to {load_factor:.6g} still fails: "
            f"{self.failure}.{self._turned()} {self._diagnosis(self.failure.inverted)}"
        )

    def _strayed(self, goal: Goal, values: Sequence[float]) -> str:
        """The same of a path that goes on without coming nearer to a goal."""
        turns = int(np.count_nonzero(np.diff(np.sign(np.diff(values)))))
        return (
            f"{self._position()}: the last {len(values)} steps came no nearer to the next stop, {goal.named}; "
            f"it went to and fro between {min(values):.4g} and {max(values):.4g} and turned {turns} times."
            f"{self._turned()} {self._diagnosis(None)}"
        )

    def _turned(self) -> str:
        """The first limit point of the stage, and what the states since are; "" without one."""
        turns = self._turns()
        if not turns:
            return ""
        first = turns[0]
        since = [step for step in self.path.steps if step.stage == self.stage and step.arc_length > first.arc_length]
        known = [step.negative_pivots for step in since if step.negative_pivots is not None]
        unstable = f"; {sum(map(bool, known))} of the {len(since)} states since are unstable" if known else ""
        more = len(turns) - 1
        again = f", and {more} more time{'s' * (more != 1)} after it" if more else ""
        return (
            f" The load factor turned at {first.load_factor:.6g} (critical point {first.number}){again}{unstable}. "
            "A path of equilibria does not show where the body jumps to under a growing load."
        )

    def _turns(self) -> list[CriticalPoint]:
        """The limit points of the stage."""
        return [at for at in self.path.critical_points if at.stage == self.stage and at.kind == LIMIT_POINT]

    def _position(self) -> str:
        last = self.path.steps[-1]
        magnitude = float(np.linalg.norm(last.flux_density))
        field = f" ({1e3 * magnitude:.4g} mT)" if magnitude > 0.0 else ""
        where = f" of stage {last.stage + 1}" if len(self.path.model.stages) > 1 else ""
        return f"stopped at load factor {last.load_factor:.6g}{where}{field}"

    def _diagnosis(self, inverted: int | None) -> str:
        last, turns = self.path.steps[-1], self._turns()
        turned = (turns[0].state, self.system.course.at(turns[0].load_factor)) if turns else None
        return diagnosis(self.discretisation, last.state, self.path.loading(last), inverted, turned)
