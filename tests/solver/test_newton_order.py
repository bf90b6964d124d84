"""Newton's method converges quadratically: orders measured by halving the load increment.

From a converged state, an increment of the load factor of relative size ε leaves an error that falls with ε at first
order before the first iteration, second after it and fourth after two, if the tangent is consistent.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest

import magshell as ms
from magshell import Settings, UniformField, solve
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant, difference
from magshell.linalg import make_solver, nested_dissection
from magshell.magnetics import laws
from magshell.shell.elements import ELEMENTS
from magshell.shell.state import State
from magshell.solver.constraints import Constraint, Metric, ProbeValue, Sphere
from magshell.solver.newton import System, Trial, newton
from solver.models import arm, central_difference, equation_numbers, in_parts, strip

BEGIN = 0.2
SHARP = 1e-13


class Case(NamedTuple):
    """Which arm."""

    coupling: type
    element: str = "quadratic"
    stretch: str = "linear"
    parts: bool = False

    @property
    def model(self) -> ms.Model:
        model = arm(coupling=self.coupling(), element=self.element, stretch=self.stretch)
        return in_parts(model) if self.parts else model

    def __str__(self) -> str:
        return f"{self.element}-{self.coupling.__name__}" + self.parts * "-parts"


CASES = [*(Case(law) for law in laws()), *(Case(laws()[0], element) for element in ELEMENTS if element != "quadratic")]


class Recording(Discretisation):
    """Keeps the states at which residuals are made, each once."""

    states: list[Any]

    def assemble(self, instant, *arguments, **options):
        if not self.states or self.states[-1] is not instant.state:
            self.states.append(instant.state)
        return super().assemble(instant, *arguments, **options)


@cache
def converged(case: Case) -> State:
    """The arm's state at the load factor BEGIN."""
    model = case.model
    weaker = ms.Model(model.shell, model.supports, UniformField(BEGIN * model.field.vector), coupling=model.coupling)
    return solve(weaker, Settings(tolerance=SHARP)).steps[-1].state


def errors(case: Case, mixed: bool, ε: float) -> np.ndarray:
    """Distance of u from the solution before and after each of two iterations, m (root of the sum of squares)."""
    model, start = case.model, converged(case)
    discretisation = Recording(model, nested_dissection)
    discretisation.states = []
    load_factor = BEGIN * (1 + ε)
    trial = Trial(start, load_factor, discretisation.predicted(Instant(start, model.loading(load_factor))))
    settings = Settings(tolerance=SHARP, mixed_tangent=mixed, max_iterations=20)
    system = System(discretisation, make_solver("superlu"), model.course(0), settings)
    newton(system, trial, None, lambda *_: None)
    *iterates, solution = discretisation.states
    return np.array([np.linalg.norm(state.u - solution.u) for state in iterates[:3]])


@pytest.mark.parametrize("case", CASES, ids=map(str, CASES))
def test_mixed_tangent_has_orders_1_2_4(case: Case) -> None:
    sizes = [0.01, 0.005, 0.0025]
    found = [errors(case, True, size) for size in sizes]
    for ε, (large, small) in zip(sizes[1:], pairwise(found), strict=True):
        orders = np.log2(large / small)
        # the next term of each expansion is smaller by a factor of the relative size of the increment
        assert orders == pytest.approx([1, 2, 4], abs=2 * ε), f"ε = {ε}: {orders}, errors {small}"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("mixed", [True, False], ids=["mixed", "plain"])
@pytest.mark.parametrize("case", [Case(law, parts=True) for law in laws()], ids=str)
def test_orders_with_layers_and_jumps(case: Case, mixed: bool) -> None:
    """Fourth order shows for smaller increments: the parts are thin, and of different stiffness."""
    large, small = (errors(case, mixed, ε) for ε in (0.0025, 0.00125))
    orders = np.log2(large / small)
    assert orders == pytest.approx([1, 2, 4], abs=0.15), f"{orders}, errors {small}"
    assert orders[:2] == pytest.approx([1, 2], abs=0.005), f"{orders}, errors {small}"


@pytest.mark.parametrize("stretch", ["linear", "none", "plane-stress"])
def test_plain_tangent_tends_to_the_same_orders(stretch: str) -> None:
    """Its second iteration starts farther out, so fourth order shows for smaller increments only."""
    case = Case(laws()[0], stretch=stretch)
    found = [errors(case, False, ε) for ε in (0.005, 0.0025, 0.00125)]
    first, second = (np.log2(large / small) for large, small in pairwise(found))
    assert second[:2] == pytest.approx([1, 2], abs=0.01), f"{first}, {second}"
    assert first[2] < second[2] < 4.05, f"{first}, {second}"
    assert second[2] > 1.8 * 2, f"two iterations of order 1.8 at least: {first}, {second}"


def constrained_errors(kind: str, ε: float) -> np.ndarray:
    """As `errors`, with the load factor as an unknown: a displacement is held, or a sphere about the unloaded state.

    The end is turned with the load factor as well, so that supports move while it is sought. The trial state is that at
    load factor 0.5 with all displacements and rotations larger by ε.
    """
    begin = turned_half_way()
    discretisation = Recording(TURNED_IN_A_FIELD, nested_dissection)
    discretisation.states = []
    increment = ε * difference(begin, discretisation.undeformed())
    state = discretisation.moved(begin, increment)
    prediction = discretisation.predicted(Instant(begin, TURNED_IN_A_FIELD.loading(0.5)), increment)
    tip, load_factor = TURNED_IN_A_FIELD.probe_nodes["tip"], 0.5 * (1 + ε)
    held: Constraint = ProbeValue(tip, 2, float(state.u[tip, 2]))
    if kind == "sphere":
        metric = Metric(1.0 / (len(state.u) * discretisation.mesh.size**2))
        held = Sphere(metric, 0 * state.u, 0.0, state.u, load_factor, metric.norm(state.u, load_factor))
    settings = Settings(tolerance=SHARP, max_iterations=20)
    system = System(discretisation, make_solver("superlu"), TURNED_IN_A_FIELD.course(0), settings)
    solution = newton(system, Trial(state, load_factor, prediction), held, lambda *_: None).trial
    if kind == "sphere":
        assert metric.norm(solution.state.u, solution.load_factor) == pytest.approx(held.radius, rel=1e-14)
    else:
        assert solution.state.u[tip, 2] == pytest.approx(state.u[tip, 2], rel=1e-14)
    return np.array([np.linalg.norm(one.u - solution.state.u) for one in discretisation.states[:3]])


TURNED_IN_A_FIELD = strip(supports=[ms.Clamp("left"), ms.Prescribe("right", "omega", 2, -0.3)])


@cache
def turned_half_way() -> State:
    """The state at load factor 0.5."""
    model = TURNED_IN_A_FIELD
    path = solve(
        ms.Model(model.shell, model.supports, model.field, stages=[ms.Stage(stops=(0.5,))]), Settings(tolerance=SHARP)
    )
    return next(step.state for step in path.steps if step.load_factor == 0.5)


@pytest.mark.parametrize("kind", ["displacement", "sphere"])
def test_a_load_factor_that_is_sought_leaves_the_orders(kind: str) -> None:
    """What is missing halves with ε, and extrapolated the orders are met."""
    found = [constrained_errors(kind, ε) for ε in (0.005, 0.0025, 0.00125)]
    first, second = (np.log2(large / small) for large, small in pairwise(found))
    assert 2.0 * second - first == pytest.approx([1, 2, 4], abs=0.03), f"{first}, {second}"


def test_mixed_tangent_is_farther_ahead_after_two_iterations() -> None:
    case = Case(laws()[0])
    mixed, plain = errors(case, True, 0.01)[2], errors(case, False, 0.01)[2]
    assert mixed < 0.1 * plain, f"errors after two iterations: mixed {mixed:.1e} m, plain {plain:.1e} m"


BENT = strip(field=(0, 0, 10e-3))
TURNED = strip(supports=[ms.Clamp("left"), ms.Prescribe("right", "omega", 2, 0.5)], field=(0, 0, 0))


@pytest.mark.parametrize("model", [BENT, TURNED], ids=["free", "one-rotation-held"])
def test_tangent_of_the_free_rotations_at_the_end(model: ms.Model) -> None:
    """Columns of the tangent against central differences, rows and columns scaled by the diagonal.

    Where one rotation of three is held, its reaction couple c does not vanish, and the others see ½ [c]× in addition.
    """
    path = solve(model, Settings(tolerance=SHARP))
    discretisation, state = path.discretisation, path.steps[-1].state
    tip, step = model.probe_nodes["tip"], 1e-6

    matrix = discretisation.assemble(Instant(state, discretisation.model.loading(1.0))).matrix.toarray()
    scale = np.sqrt(np.abs(matrix.diagonal()))
    equations = equation_numbers(discretisation)[tip]
    for component in (7, 9):
        increment = np.zeros((len(model.shell.mesh.points), 11))
        increment[tip, component] = step
        numeric = central_difference(discretisation, state, increment, step)
        equation = equations[component]
        off = np.abs(numeric - matrix[:, equation]) / (scale * scale[equation])
        assert off.max() < 1e-6, (
            f"component {component}: {off.max():.1e} in equation {off.argmax()}, at the node {equations}"
        )
