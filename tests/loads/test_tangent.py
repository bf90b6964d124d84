"""The assembled tangent under loads: differences of the right side, and Newton's order, with couples on the nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import pytest
from solver.models import LENGTH, THICKNESS, central_difference, equation_numbers, rubber

import magshell as ms
from loads.bodies import arm, grouped
from magshell import Settings, solve
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.keys import Key
from magshell.linalg import make_solver, nested_dissection
from magshell.model.support import Condition, Support
from magshell.shell.state import State
from magshell.solver.newton import System, Trial, newton

SHARP = 1e-13
BEGIN = 0.5


def plate(loads: Sequence[Any]) -> ms.Model:
    """A clamped square of 20 thicknesses."""
    mesh = grouped(ms.mesh.rectangle(20e-3, 20e-3, (4, 4)))
    shell = ms.Shell(mesh, 1e-3, rubber(1e-3))
    return ms.Model(shell, [ms.Clamp(side) for side in ("left", "right", "bottom", "top")], loads=loads)


BENT: dict[str, tuple[Callable[[Sequence[Any]], ms.Model], list[Any]]] = {
    "dead": (arm, [ms.Moment("bottom", (2e-6, -1.2e-5, 4e-6)), ms.Force("half", (2e-4, 3e-4, 5e-4))]),
    "turning": (
        arm,
        [
            ms.Moment("bottom", (2e-6, -1.2e-5, 4e-6), follower=True),
            ms.Force("bottom", (2e-4, 3e-4, 5e-4), follower=True),
            ms.Pressure("half", -2.0),
        ],
    ),
    "inflated": (plate, [ms.Pressure("half", 3e3)]),
}


@dataclass(frozen=True)
class Guide(Support):
    """No rotation about one axis, which is oblique."""

    kind: ClassVar[str] = "guide"
    keys: ClassVar[dict[str, Key]] = {}

    group: str
    axis: tuple[float, float, float]

    def conditions(self):
        yield Condition(self.group, "omega", np.array(self.axis) / np.linalg.norm(self.axis), 0.0, optional=True)


HELD = {
    "free": [],
    "one rotation": [ms.Prescribe("right", "omega", 2, 0.3)],
    "one oblique rotation": [Guide("right", (1.0, 2.0, 0.5))],
    "two rotations": [ms.Prescribe("right", "omega", 1, 0.1), ms.Prescribe("right", "omega", 2, 0.3)],
}


@pytest.mark.parametrize("follower", [False, True], ids=["dead", "turning"])
@pytest.mark.parametrize("held", HELD.values(), ids=HELD)
def test_tangent_of_sections_under_a_moment(held: list[object], follower: bool) -> None:
    """Columns of directors and spins against central differences in equilibrium, scaled by the diagonal."""
    mesh = grouped(ms.mesh.rectangle(LENGTH, 5e-3, (4, 1)))
    shell = ms.Shell(mesh, THICKNESS, rubber())
    loads = [ms.Moment("right", (2e-5, -3e-5, 2e-5), follower), ms.Force("top", (0, 1e-3, 2e-3), follower)]
    loads += [ms.Pressure("half", 20.0)] if follower else []
    model = ms.Model(shell, [ms.Clamp("left"), *held], loads=loads)
    path = solve(model, Settings(tolerance=SHARP))
    discretisation, state = path.discretisation, path.steps[-1].state
    tip, step = int(np.argmin(np.linalg.norm(mesh.points - (LENGTH, 0, 0), axis=1))), 1e-6

    matrix = discretisation.assemble(Instant(state, model.loading(1.0))).matrix.toarray()
    scale = np.sqrt(np.abs(matrix.diagonal()))
    equations = equation_numbers(discretisation)[tip]
    turning = equations[[3, 4, 5, 7, 8, 9]]
    assert np.count_nonzero(turning >= 0) == 6 - np.count_nonzero(model.constraints.fixed[tip, 7:10])
    for equation in turning[turning >= 0]:
        unit = np.zeros(discretisation.dofs)
        unit[equation] = step
        increment = discretisation.direction(unit).nodal
        numeric = central_difference(discretisation, state, increment, step)
        off = np.abs(numeric - matrix[:, equation]) / (scale * scale[equation])
        assert off.max() < 1e-6, f"equation {equation}: {off.max():.1e} in equation {off.argmax()}"


@pytest.mark.parametrize("held", [one for one in HELD.values() if one], ids=[name for name, one in HELD.items() if one])
def test_rotations_that_are_turned_take_the_loads_along(held: list[object]) -> None:
    """What the right side has of imposed rotations, against differences: followers turn with them."""
    mesh = grouped(ms.mesh.rectangle(LENGTH, 5e-3, (4, 1)))
    loads = [ms.Moment("right", (2e-5, -3e-5, 2e-5), True), ms.Force("right", (0, 1e-3, 2e-3), True)]
    model = ms.Model(ms.Shell(mesh, THICKNESS, rubber()), [ms.Clamp("left"), *held], loads=loads)
    path = solve(model, Settings(tolerance=SHARP))
    discretisation, state, step = path.discretisation, path.steps[-1].state, 1e-6
    turned = np.zeros_like(discretisation.free, dtype=float)
    turned[mesh.nodes_of("right"), 7:10] = np.random.default_rng(1).uniform(-1, 1, (len(mesh.nodes_of("right")), 3))
    imposed = discretisation.imposed(turned)
    at = Instant(state, model.loading(1.0))
    found = discretisation.assemble(at).right_side - discretisation.assemble(at, imposed).right_side
    numeric = central_difference(discretisation, state, step * discretisation.to_global(imposed), step)
    off = np.abs(numeric - found).max() / np.abs(numeric).max()
    assert off < 1e-7, f"{off:.1e}"


class Recording(Discretisation):
    """Keeps the states at which residuals are made."""

    def __init__(self, model: ms.Model) -> None:
        super().__init__(model, nested_dissection)
        self.states: list[State] = []

    def assemble(self, instant, *arguments, **options):
        self.states.append(instant.state)
        return super().assemble(instant, *arguments, **options)


@cache
def converged(loads: str) -> State:
    """The state at the load factor BEGIN."""
    make, full = BENT[loads]
    part = [replace(load, history=(BEGIN,)) for load in full]
    return solve(make(part), Settings(tolerance=SHARP)).steps[-1].state


def errors(loads: str, ε: float) -> np.ndarray:
    """Distance of u from the solution before and after each of two iterations, m (root of the sum of squares)."""
    make, full = BENT[loads]
    discretisation, start = Recording(make(full)), converged(loads)
    load_factor = BEGIN * (1 + ε)
    at = Instant(start, discretisation.model.loading(load_factor))
    trial = Trial(start, load_factor, discretisation.predicted(at))
    settings = Settings(tolerance=SHARP, max_iterations=20)
    system = System(discretisation, make_solver("superlu"), discretisation.model.course(0), settings)
    newton(system, trial, None, lambda *_: None)
    *iterates, solution = discretisation.states
    return np.array([np.linalg.norm(state.u - solution.u) for state in iterates[:3]])


@pytest.mark.parametrize("loads", BENT)
def test_newton_has_orders_1_2_4_under_moments_and_pressure(loads: str) -> None:
    sizes = [0.02, 0.01, 0.005]
    found = [errors(loads, size) for size in sizes]
    for ε, (large, small) in zip(sizes[1:], pairwise(found), strict=True):
        orders = np.log2(large / small)
        # the next term of each expansion is smaller by a factor of the relative size of the increment; the second
        # iteration squares what the first leaves, and doubles its deviation
        off = np.abs(orders - [1, 2, 4])
        assert np.all(off < 2 * ε * np.array([1, 1, 2])), f"ε = {ε}: {orders}, errors {small}"
