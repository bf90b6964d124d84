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
from magshell.assembly import Discretisation
from magshell.linalg import make_solver, nested_dissection
from magshell.magnetics import laws
from magshell.shell.elements import ELEMENTS
from magshell.shell.state import State
from magshell.solver.newton import System, Trial, newton
from solver.models import arm, central_difference, equation_numbers, strip

BEGIN = 0.2
SHARP = 1e-13


class Case(NamedTuple):
    """Which arm."""

    coupling: type
    element: str = "quadratic"
    stretch: str = "linear"

    @property
    def model(self) -> ms.Model:
        return arm(coupling=self.coupling(), element=self.element, stretch=self.stretch)


CASES = [*(Case(law) for law in laws()), *(Case(laws()[0], element) for element in ELEMENTS if element != "quadratic")]


class Recording(Discretisation):
    """Keeps the states at which residuals are made."""

    states: list[Any]

    def assemble(self, state, *arguments, **options):
        self.states.append(state)
        return super().assemble(state, *arguments, **options)


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
    trial = Trial(start, BEGIN * (1 + ε), discretisation.stresses_at(start))
    settings = Settings(tolerance=SHARP, mixed_tangent=mixed, max_iterations=20)
    system = System(discretisation, make_solver("superlu"), model.course(0), settings)
    newton(system, trial, None, lambda *_: None)
    *iterates, solution = discretisation.states
    return np.array([np.linalg.norm(state.u - solution.u) for state in iterates[:3]])


@pytest.mark.parametrize("case", CASES, ids=[f"{case.element}-{case.coupling.__name__}" for case in CASES])
def test_mixed_tangent_has_orders_1_2_4(case: Case) -> None:
    sizes = [0.01, 0.005, 0.0025]
    found = [errors(case, True, size) for size in sizes]
    for ε, (large, small) in zip(sizes[1:], pairwise(found), strict=True):
        orders = np.log2(large / small)
        # the next term of each expansion is smaller by a factor of the relative size of the increment
        assert orders == pytest.approx([1, 2, 4], abs=2 * ε), f"ε = {ε}: {orders}, errors {small}"


@pytest.mark.parametrize("stretch", ["linear", "none", "plane-stress"])
def test_plain_tangent_tends_to_the_same_orders(stretch: str) -> None:
    """Its second iteration starts farther out, so fourth order shows for smaller increments only."""
    case = Case(laws()[0], stretch=stretch)
    found = [errors(case, False, ε) for ε in (0.005, 0.0025, 0.00125)]
    first, second = (np.log2(large / small) for large, small in pairwise(found))
    assert second[:2] == pytest.approx([1, 2], abs=0.01), f"{first}, {second}"
    assert first[2] < second[2] < 4.05, f"{first}, {second}"
    assert second[2] > 1.8 * 2, f"two iterations of order 1.8 at least: {first}, {second}"


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

    matrix = discretisation.assemble(state, discretisation.model.loading(1.0)).matrix.toarray()
    scale = np.sqrt(np.abs(matrix.diagonal()))
    equations = equation_numbers(discretisation)[tip]
    for component in (7, 9):
        increment = np.zeros((len(model.shell.mesh.points), 10))
        increment[tip, component] = step
        numeric = central_difference(discretisation, state, increment, step)
        equation = equations[component]
        off = np.abs(numeric - matrix[:, equation]) / (scale * scale[equation])
        assert off.max() < 1e-6, (
            f"component {component}: {off.max():.1e} in equation {off.argmax()}, at the node {equations}"
        )
