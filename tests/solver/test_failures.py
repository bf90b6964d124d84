"""Problems that cannot be solved say so, in the user's terms, with everything reached so far."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell import InputError, Settings, SolveError, solve
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import SingularMatrix, make_solver, nested_dissection
from magshell.solver.newton import StepFailure, System, Trial, newton
from solver.models import LENGTH, Record, contents, equation_numbers, rubber, strip


def failure(model: ms.Model, settings: Settings) -> tuple[SolveError, Record]:
    """The error of a solve, after what holds for every failed one was checked."""
    record = Record()
    with pytest.raises(SolveError) as caught:
        solve(model, settings, [record])
    error = caught.value
    path = error.path
    assert str(error) == error.reason == path.reason
    assert not path.converged
    assert path is record.path
    assert record.calls[-2:] == ["cut", "finished"]
    assert [contents(step.state) for step in path.steps] == record.bytes
    assert path.steps[-1].load_factor < 1.0
    assert all(step.residual <= settings.tolerance for step in path.steps[1:])
    assert path.cuts == len(record.cuts) > 0
    assert path.summary["converged"] is False
    return error, record


def test_absurd_field_is_followed_as_far_as_it_goes() -> None:
    """A slip of the unit by 10⁵: first steps turn elements inside out, and the message says what field was reached."""
    error, record = failure(strip(field=(0, 0, 1e3)), Settings(smallest_step=9e-3))
    assert error.path.solves < 120, f"{error.path.solves} solves"
    assert record.cuts[0][0] == 0.01
    assert "turned inside out" in record.cuts[0][1], record.cuts[0]
    reached = 1e3 * np.linalg.norm(error.path.steps[-1].flux_density)
    assert 100.0 < reached < 1000.0
    stopped = f"({reached:.4g} mT)"
    for part in ("stopped at load factor 0.000", stopped, "still fails", record.cuts[-1][1], "Likely cause"):
        assert part in error.reason, error.reason


def test_steps_before_the_failure_are_kept() -> None:
    """The strip follows 5 T for a while; the state at 2 mT, the first step, is that of 2 mT alone."""
    error, _ = failure(strip(field=(0, 0, 5.0)), Settings(first_step=4e-4, smallest_step=4e-4, target_iterations=12))
    steps = error.path.steps
    assert len(steps) > 2
    assert steps[1].load_factor == pytest.approx(4e-4, rel=1e-12)
    last = steps[-1]
    assert f"stopped at load factor {last.load_factor:.6g} ({5e3 * last.load_factor:.4g} mT)" in error.reason, (
        error.reason
    )
    tip = error.path.probe("tip")
    assert tip.u3[1] == pytest.approx(solve(strip(field=(0, 0, 2e-3))).probe("tip").u3[-1], rel=1e-6)


def test_strip_cannot_be_squashed_to_nothing() -> None:
    supports = [ms.Clamp("left"), ms.Prescribe("right", "u", 1, -LENGTH)]
    error, record = failure(strip((2, 1), supports, field=(0, 0, 0)), Settings(smallest_step=0.005))
    reached = error.path.steps[-1].load_factor
    assert 0.1 < reached < 1.0, reached
    assert f"stopped at load factor {reached:.6g}" in error.reason, error.reason
    assert f"after {len(record.cuts)} cuts" in error.reason, error.reason
    assert "Likely cause: the mesh is too coarse" in error.reason, error.reason


class Singular:
    """A linear solver that finds every matrix singular, in a given direction."""

    name = "singular"

    def __init__(self, direction: np.ndarray) -> None:
        self.direction = direction

    def factorise(self, matrix):
        raise SingularMatrix(self.direction)

    def solve(self, right_side):
        raise AssertionError("there are no factors")


@pytest.mark.parametrize(("column", "name"), [(0, "u1"), (2, "u3"), (4, "w2"), (6, "phi"), (8, "omega2")])
def test_singular_direction_is_named(column: int, name: str) -> None:
    model = strip()
    discretisation = Discretisation(model, nested_dissection)
    tip = model.probe_nodes["tip"]
    direction = np.zeros(discretisation.dofs)
    direction[equation_numbers(discretisation)[tip, column]] = 1.0
    start = discretisation.undeformed()
    trial = Trial(start, 0.1, discretisation.predicted(Instant(start, model.loading(0.1))))
    system = System(discretisation, Singular(direction), model.course(0), Settings())
    with pytest.raises(StepFailure) as caught:
        newton(system, trial, None, lambda *_: None)
    expected = f"the free direction is largest in {name} of node {tip} at (11, 0, 0) mm"
    assert expected in str(caught.value), str(caught.value)


def test_couple_that_never_reaches_the_deformation_is_refused() -> None:
    with pytest.raises(InputError, match=r"coupling_modulus is 0.*MicropolarCouple works on never reaches"):
        strip(material=rubber(coupling=0.0))


def two_parts() -> ms.mesh.Mesh:
    """Two separate squares."""
    squares = {
        "one": np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 1e-2,
        "two": np.array([[2, 0], [3, 0], [3, 1], [2, 1]]) * 1e-2,
    }
    return ms.mesh.blocks(squares, (2, 2)).select_edges("hold", x1=0)


@pytest.mark.parametrize(
    ("supports", "said"),
    [
        ([], "the body floats freely"),
        ([ms.Prescribe("left", "phi", value=0.0)], "the body floats freely"),
        ([ms.SymmetryPlane("left", (1, 0, 0)), ms.SymmetryPlane("bottom", (0, 1, 0))], "translation along X3"),
        ([ms.Prescribe("left", "u", 3, 0.0), ms.Prescribe("right", "u", 3, 0.0)], "translation along X1"),
    ],
)
def test_free_motion_is_named(supports: list[object], said: str) -> None:
    with pytest.raises(InputError, match="supports: ") as caught:
        strip(supports=supports)
    assert said in str(caught.value), str(caught.value)


def test_free_motions_are_all_named() -> None:
    with pytest.raises(InputError) as caught:
        strip(supports=[ms.SymmetryPlane("left", (1, 0, 0))])
    for motion in ("translation along X2", "translation along X3", "rotation about X1"):
        assert motion in str(caught.value), str(caught.value)


def test_part_that_floats_is_named() -> None:
    shell = ms.Shell(two_parts(), 1e-3, rubber(), ms.remanence.constant([0.1, 0, 0]))
    with pytest.raises(InputError, match=r"part 2 of 2 .* floats freely"):
        ms.Model(shell, [ms.Clamp("hold")], ms.UniformField([0, 0, 1e-3]))


def test_load_that_does_nothing() -> None:
    with pytest.raises(InputError, match="flux_density is zero and no support moves"):
        strip(field=(0, 0, 0))
    with pytest.raises(InputError, match="remanence: it is zero everywhere and no support moves"):
        strip(remanence=(0, 0, 0))


def test_make_solver_is_the_one_in_use() -> None:
    assert solve(strip((2, 1))).solver_name == make_solver("multifrontal").name
