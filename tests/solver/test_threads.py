"""Threads and processes that solve at once: the bits of one that solves alone.

BLAS has two threads meanwhile. Fronts of this mesh are large enough to be shared by them, and their sums then have
another order.
"""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import magshell as ms
from magshell.equations.instant import Instant
from magshell.errors import InputError
from magshell.linalg.threads import one_blas_thread
from magshell.solver.events import Observer

THREADS = 4
TESTS = Path(__file__).parents[1]


def model(length: float = 20e-3) -> ms.Model:
    mesh = ms.mesh.rectangle(length, 5e-3, (16, 4))
    shell = ms.Shell(mesh, 1e-3, ms.MicropolarNeoHookean(303e3, 7.3e6), ms.remanence.constant([0.1, 0, 0]))
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 2e-3]), probes={"tip": (length, 0, 0)})


def bits(path: ms.Path) -> str:
    """A digest of every number of every state."""
    arrays = [array for step in path.steps for array in (*step.state, step.load_factor)]
    return hashlib.sha256(b"".join(np.asarray(array).tobytes() for array in arrays)).hexdigest()


def solved(one: ms.Model) -> str:
    return bits(ms.solve(one, ms.Settings(first_step=1.0)))


def at_once(work: Callable[[Any], Any], given: list[Any]) -> list[Any]:
    """What threads that start together make of what each is given."""
    ready = threading.Barrier(len(given))

    def run(one: Any) -> Any:
        ready.wait()
        return work(one)

    with ThreadPoolExecutor(len(given)) as pool:
        return [*pool.map(run, given)]


def in_a_fork(work: Callable[[], str]) -> str:
    """What a forked copy of this process answers."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(write, work().encode())
            os._exit(0)
        finally:  # whatever happens, no second copy goes on with the tests
            os._exit(1)
    os.close(write)
    with os.fdopen(read) as answer:
        found = answer.read()
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    return found


@pytest.fixture(scope="module")
def two_threads_of_blas() -> Iterator[None]:
    with threadpool_limits(2):
        yield


@pytest.fixture(scope="module")
def alone(two_threads_of_blas: None) -> str:
    return solved(model())


def test_threads_with_one_model(alone: str, two_threads_of_blas: None) -> None:
    assert at_once(solved, [model()] * THREADS) == [alone] * THREADS


def test_threads_with_two_models(alone: str, two_threads_of_blas: None) -> None:
    long = model(24e-3)
    assert at_once(solved, [model(), long]) == [alone, solved(long)]


def test_as_many_threads_of_blas_as_there_are(alone: str) -> None:
    with threadpool_limits(1):
        assert solved(model()) == alone


def _solve_in_processes() -> None:
    """Digests as JSON: alone, in processes that are given the models, in a fork while BLAS has its threads."""
    with threadpool_limits(2):
        short, long = model(), model(24e-3)
        found = [solved(short), solved(long)]
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
            found += pool.map(solved, [short, long])
        print(json.dumps([*found, in_a_fork(lambda: solved(short)), in_a_fork(lambda: solved(long))]))


@pytest.mark.verify
@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_processes() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "solver.test_threads"], cwd=TESTS, capture_output=True, text=True, check=True
    )
    short, long, *others = json.loads(found.stdout)
    assert others == [short, long, short, long]


@pytest.fixture(scope="module")
def path() -> ms.Path:
    return ms.solve(model())


def test_threads_with_one_path(path: ms.Path) -> None:
    """Residuals and energies of different steps, evaluated again and again at once.

    (Python 3.11 lets only one thread at a time into `Converged.assembly`, later ones do not.)
    """
    discretisation = path.discretisation

    def evaluated(number: int, times: int = 20) -> list[bytes]:
        instant = Instant(path.steps[number].state, path.loading(path.steps[number]))
        found = [discretisation.assemble(instant, tangent=False) for _ in range(times)]
        return [one.residual.tobytes() + one.energy.tobytes() for one in found]

    numbers = [*range(len(path.steps))]
    expected = [20 * evaluated(number, 1) for number in numbers]
    assert at_once(evaluated, numbers) == expected


def test_threads_with_one_history(path: ms.Path) -> None:
    alone = ms.solve(path.model).history
    expected = alone.rows(path.steps)
    vars(path).pop("history", None)
    found = at_once(lambda _: path.history.rows(path.steps), [None] * THREADS)
    assert found == [expected] * THREADS


def test_a_path_that_another_thread_lengthens(path: ms.Path) -> None:
    """It is refused, where it would end up with the steps of both."""
    refused: list[str] = []

    class Meddler(Observer):
        def kept(self, growing: ms.Path) -> None:
            try:
                ms.resume(growing)
            except InputError as error:
                refused.append(str(error))

    alone = ms.solve(path.model, observers=[Meddler()])
    assert len(refused) == len(path.steps)
    assert "is being solved" in refused[0]
    assert bits(alone) == bits(path)


def test_limits_of_others_stay() -> None:
    """Whoever limits BLAS while a thread solves has their limit before and after."""

    def blas() -> set[int]:
        return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}

    def other() -> set[int]:
        with one_blas_thread:
            return blas()

    with threadpool_limits(2):
        assert blas() == {2}
        with ThreadPoolExecutor(1) as pool:
            assert pool.submit(other).result() == {1}
        assert blas() == {2}


@contextmanager
def _held() -> Iterator[None]:
    """Another thread computes meanwhile."""
    entered, leave = threading.Event(), threading.Event()

    def hold() -> None:
        with one_blas_thread:
            entered.set()
            leave.wait()

    thread = threading.Thread(target=hold)
    thread.start()
    entered.wait()
    try:
        yield
    finally:
        leave.set()
        thread.join()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_fork_while_another_thread_computes() -> None:
    """The copy, which has not that thread, is not held to what it wanted."""
    with threadpool_limits(2), _held():
        assert in_a_fork(lambda: str({library["num_threads"] for library in threadpool_info()})) == "{2}"


if __name__ == "__main__":
    _solve_in_processes()
