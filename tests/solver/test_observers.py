"""What observers are told, in which order, also when a solve is interrupted or fails."""

from __future__ import annotations

import re

import pytest

from magshell import Observer, Settings, solve
from magshell.linalg.multifrontal.solver import Multifrontal
from solver.models import Record, contents, strip


def test_calls_come_in_order() -> None:
    record = Record()
    path = solve(strip(), Settings(first_step=1.0), [record])
    letters = {"started": "S", "converged": "C", "iterated": "i", "cut": "x", "finished": "F"}
    order = "".join(letters[call] for call in record.calls)
    assert re.fullmatch("SC(i+[xC])*F", order), order
    assert order.count("C") == len(path.steps)
    assert order.count("x") == path.cuts > 0
    assert record.path is path
    assert record.discretisation is path.discretisation
    assert record.settings is path.settings
    assert all(told is kept for told, kept in zip(record.steps, path.steps, strict=True))


def test_iterations_are_numbered_and_counted() -> None:
    record = Record()
    path = solve(strip(), observers=[record])
    assert 0 <= path.solves - sum(iteration.iteration > 0 for iteration in record.iterations) <= len(path.steps)
    for step in path.steps[1:]:
        own = [one for one in record.iterations if one.step == step.number and one.load_factor == step.load_factor]
        assert [one.iteration for one in own] == list(range(step.iterations + 1))
        assert own[-1].residual == step.residual <= path.settings.tolerance
        assert all(one.residual > path.settings.tolerance for one in own[:-1])
    seconds = [one.seconds for one in record.iterations]
    assert seconds == sorted(seconds)
    assert {one.kind for one in record.iterations} <= {"u", "w", "phi", "omega", "alpha"}


@pytest.mark.parametrize("first_step", [0.01, 1.0])
def test_every_factorisation_is_counted(monkeypatch: pytest.MonkeyPatch, first_step: float) -> None:
    """Those of cut steps, and those that only give the path's direction, included."""
    factorise, counted = Multifrontal.factorise, []

    def counting(solver, matrix):
        counted.append(matrix.shape)
        return factorise(solver, matrix)

    monkeypatch.setattr(Multifrontal, "factorise", counting)
    path = solve(strip(), Settings(first_step=first_step))
    assert path.solves == path.summary["iterations"] == len(counted)


def test_bare_observer_may_watch() -> None:
    assert solve(strip((2, 1)), observers=[Observer()]).converged


class Interrupting(Record):
    """Presses Ctrl-C at a call."""

    def __init__(self, call: str, number: int) -> None:
        super().__init__()
        self.left = {call: number}

    def _count(self, call: str) -> None:
        if call in self.left:
            self.left[call] -= 1
            if self.left[call] == 0:
                raise KeyboardInterrupt

    def converged(self, step):
        super().converged(step)
        self._count("converged")

    def iterated(self, iteration):
        super().iterated(iteration)
        self._count("iterated")


@pytest.mark.parametrize(("call", "number"), [("converged", 4), ("iterated", 20)])
def test_interrupt_passes_through_after_the_observers_heard_of_it(call: str, number: int) -> None:
    watching, interrupting = Record(), Interrupting(call, number)
    with pytest.raises(KeyboardInterrupt):
        solve(strip(), observers=[watching, interrupting])
    path = watching.path
    assert path is interrupting.path is not None
    assert path.reason == "interrupted"
    assert not path.converged
    assert watching.calls[-1] == interrupting.calls[-1] == "finished"
    assert [step.number for step in path.steps] == list(range(len(path.steps)))
    assert len(path.steps) > 2
    assert [contents(step.state) for step in path.steps] == watching.bytes
    assert path.probe("tip").u3[-1] > 0.0
    assert path.summary["reason"] == "interrupted"


def test_error_of_an_observer_is_not_swallowed() -> None:
    class Full(Observer):
        def converged(self, step):
            raise OSError("disk full")

    record = Record()
    with pytest.raises(OSError, match="disk full"):
        solve(strip(), observers=[Full(), record])
    assert record.calls[-1] == "finished"
    assert record.path is not None
    assert not record.path.converged
