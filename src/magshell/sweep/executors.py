"""Where cells are solved: in processes of this machine, or by the workers of a Dask cluster.

Both are executors of `concurrent.futures`; what is added is how many cells they take at a time, and that the death of a
process concerns only the cell that it was solving.
"""

from __future__ import annotations

import contextlib
import errno
import logging
import multiprocessing
import os
import pathlib
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from typing import Any, Protocol

from magshell.errors import InputError
from magshell.processes import interrupts_wait, let_broken_pipes_raise, single_threaded, work_for_the_parent

PATIENCE = "10s"
"""For the scheduler of a cluster to answer."""

Function = Callable[..., Any]


class Workers(Protocol):
    """What solves cells."""

    @property
    def places(self) -> int:
        """How many cells it takes at a time."""

    def submit(self, function: Function, *arguments: Any) -> Future[Any]:
        """Call a function there."""

    def close(self) -> None:
        """Shut down; cells that have not begun are dropped."""


class LocalWorkers:
    """Processes of this machine, each an executor of its own: one that is killed breaks no other.

    Parameters
    ----------
    places : int
    """

    def __init__(self, places: int) -> None:
        let_broken_pipes_raise()
        self.places = places
        self._context = multiprocessing.get_context("spawn")
        self._free: list[Executor] = []
        self._all: set[Executor] = set()

    def submit(self, function: Function, *arguments: Any) -> Future[Any]:
        """Call a function in a process that is free, or in a new one."""
        executor = self._free.pop() if self._free else None
        if executor is not None:
            try:
                return self._call(executor, function, arguments)
            except BrokenExecutor:
                self._all.discard(executor)
        executor = ProcessPoolExecutor(1, self._context, initializer=work_for_the_parent)
        self._all.add(executor)
        return self._call(executor, function, arguments)

    def _call(self, executor: Executor, function: Function, arguments: tuple[Any, ...]) -> Future[Any]:
        with interrupts_wait(), single_threaded():
            future = executor.submit(function, *arguments)
        future.add_done_callback(lambda done: self._free.append(executor))
        return future

    def close(self) -> None:
        """End all processes when they have finished what they do."""
        for executor in self._all:
            executor.shutdown(cancel_futures=True)


class DaskWorkers:
    """The workers of a Dask cluster, which must see the folder of the sweep under the same path.

    A cell whose worker dies is given to another one, until it has taken a few with it (the setting
    `distributed.scheduler.allowed-failures` of the scheduler).

    Parameters
    ----------
    address : str
        Of the scheduler, such as tcp://127.0.0.1:8786.
    directory : path
        Of the sweep.

    Raises
    ------
    InputError
        Dask is not installed, no scheduler answers, or a worker lacks magshell or does not see the folder.
    """

    def __init__(self, address: str, directory: str | os.PathLike[str]) -> None:
        self._address = address
        try:
            import distributed
        except ImportError:
            raise InputError("--dask: needs the package distributed: pip install 'magshell[dask]'") from None
        # Its tracebacks of a connection that is lost would hide the one line that says so.
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        client: Any = distributed.Client
        try:
            self._client: Any = client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise InputError(f"--dask {address}: no scheduler answers: {error}") from None
        try:
            self._check(address, pathlib.Path(directory).resolve())
        except BaseException:
            self._client.close()
            raise
        self._executor = self._client.get_executor(pure=False)

    def _check(self, address: str, directory: pathlib.Path) -> None:
        faults = self._client.run(_fault_here, str(directory), on_error="return")
        if not faults:
            raise InputError(f"--dask {address}: the scheduler has no workers; start some with: dask worker {address}")
        for worker, fault in faults.items():
            if fault:
                raise InputError(f"--dask {address}: the worker {worker} cannot solve cells: {fault}")

    @property
    def places(self) -> int:
        """As many as the workers have threads at the moment."""
        with self._there():
            return max(1, sum(self._client.nthreads().values()))

    def submit(self, function: Function, *arguments: Any) -> Future[Any]:
        """Call a function on some worker."""
        with self._there():
            future: Future[Any] = self._executor.submit(function, *arguments)
        return future

    def close(self) -> None:
        """Leave the cluster; what has not begun is dropped."""
        self._executor.shutdown(wait=False)
        self._client.close()

    @contextlib.contextmanager
    def _there(self) -> Iterator[None]:
        """Translate the many errors of Dask for a scheduler that is gone."""
        try:
            yield
        except Exception as error:
            raise ConnectionError(errno.ECONNRESET, "the scheduler does not answer any more", self._address) from error


def _fault_here(directory: str) -> str:
    """Why a worker cannot solve cells in a folder."""
    if not pathlib.Path(directory).is_dir():
        return f"it does not see the folder {directory}"
    return "" if os.access(directory, os.W_OK) else f"it may not write to {directory}"
