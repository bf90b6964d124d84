"""Memory that is told before a solve: the entries of the factors are those that the solver makes."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

import magshell as ms
from magshell import Model
from magshell.cli import main
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import make_solver, nested_dissection
from magshell.linalg.multifrontal.solver import Multifrontal, MultifrontalFactors
from magshell.solver.memory import PER_ENTRY, Need, memory_free, need_of
from solver.models import arm, strip


@pytest.mark.parametrize("make", [lambda: strip((24, 8)), lambda: arm((20, 6)), lambda: arm((20, 6), element="paper")])
def test_entries_of_the_factors(make: Callable[[], Model]) -> None:
    """Counted on nodes, and made from the unknowns."""
    model, solver = make(), make_solver("multifrontal")
    discretisation = Discretisation(model, nested_dissection)
    start = Instant(discretisation.undeformed(), model.course(0).at(0.0))
    matrix = discretisation.assemble(replace(start, prediction=discretisation.predicted(start))).matrix
    assert matrix is not None
    solver.factorise(matrix)
    fronts = solver._analysis.fronts
    made = fronts.lower[-1] + fronts.upper[-1]
    need = need_of(model)
    assert need.factors == pytest.approx(made, rel=0.02), f"{need.factors / made:.3f}"
    assert need.tangent == matrix.nnz


def test_more_elements_need_more() -> None:
    few, more = (need_of(strip((2 * n, n))) for n in (8, 16))
    assert more.memory - few.memory > PER_ENTRY["multifrontal"] * (more.factors - few.factors) > 0.0


def test_what_is_free() -> None:
    free = memory_free()
    assert free is None or 1e6 < free < 1e14


@pytest.fixture
def problem(tmp_path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A run of which the memory matters."""
    monkeypatch.setattr("magshell.cli.memory.FEW_ELEMENTS", 1)
    (tmp_path / "small.toml").write_text(ms.problem.examples.text("strip-10"))
    return ["run", str(tmp_path / "small.toml"), "--out", str(tmp_path / "out")]


@pytest.mark.parametrize(
    ("needed", "free", "said"),
    [
        (2e9, 1e9, "warning: memory: about 2 GB; 1 GB are free: the solve may be killed"),
        (2e9, 64e9, "memory: about 2 GB; 64 GB are free"),
        (2e9, None, "memory: about 2 GB"),
        (2e8, 5e8, "memory: about 0.2 GB; 0.5 GB are free"),
        (2e8, 64e9, None),
        (2e8, None, None),
    ],
)
def test_said_before_a_run(needed: float, free: float | None, said: str | None, problem, monkeypatch, capsys) -> None:
    def not_today(*_: object) -> None:
        raise ms.InputError("not today")

    monkeypatch.setattr("magshell.solver.memory.need_of", lambda model, solver: Need(needed, 1e6, 1e6))
    monkeypatch.setattr("magshell.solver.memory.memory_free", lambda: free)
    monkeypatch.setattr("magshell.solver.solve", not_today)
    assert main(problem) == 2
    shown = capsys.readouterr().out
    assert (said in shown) if said else ("memory" not in shown), shown


def test_too_many_entries_for_superlu(problem, monkeypatch, capsys) -> None:
    """Said before, and when SuperLU finds no memory for them."""

    def no_memory(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("magshell.linalg.superlu.MOST_ENTRIES", 1000)
    monkeypatch.setattr("scipy.sparse.linalg.splu", no_memory)
    monkeypatch.setattr("magshell.solver.memory.need_of", lambda model, solver: Need(1e8, 1e6, 1e6))
    assert main([*problem, "--set", 'solver.linear_solver="superlu"']) == 2
    shown = capsys.readouterr()
    assert "warning: the tangent has 1.0 million entries; SuperLU takes up to 0.0 million" in shown.out
    assert 'SuperLU takes up to 0.0 million. Take fewer elements, or linear_solver = "multifrontal"' in shown.err


def test_no_memory(problem, monkeypatch, capsys) -> None:
    def no_memory(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("magshell.linalg.multifrontal.solver.MultifrontalFactors.__init__", no_memory)
    monkeypatch.setattr("magshell.solver.memory.need_of", lambda model, solver: Need(1e8, 1e6, 1e6))
    assert main(problem) == 1
    assert capsys.readouterr().err == "error: small.toml: there is not enough memory\n"


def test_check_says_it(capsys) -> None:
    assert main(["check", "strip-10"]) == 0
    assert "memory of a solve" in capsys.readouterr().out


@pytest.mark.parametrize("follow", [ms.solve, lambda model: ms.buckling(model, modes=2)], ids=["path", "buckling"])
def test_factors_do_not_outlive_their_use(follow: Callable[[Model], object], monkeypatch) -> None:
    """When a tangent is factorised, no other factors are there: on a path with critical points, and in buckling."""
    alive: weakref.WeakSet[MultifrontalFactors] = weakref.WeakSet()
    factorise, most = Multifrontal.factorise, []

    def watched(solver: Multifrontal, matrix: Any) -> Any:
        most.append(len(alive))
        factors = factorise(solver, matrix)
        alive.add(factors)
        return factors

    monkeypatch.setattr(Multifrontal, "factorise", watched)
    follow(ms.problem.load("hinged-roof" if follow is ms.solve else "cantilever-moment").model)
    assert len(most) > 5
    assert max(most) == 0
