"""Threads of a factorisation."""

from __future__ import annotations

import os
import threading
from functools import cache
from typing import Any

from magshell.openblas import is_limited
from magshell.processes import threads_of


def threads() -> int:
    """As many as this process may use: OMP_NUM_THREADS, or the cores; one where memory is limited.

    (Each thread that calls OpenBLAS has a work array of its own there, for which it waits for ever.)
    """
    if is_limited():
        return 1
    return threads_of("OMP_NUM_THREADS")


@cache
def _libraries() -> list[Any]:
    """The BLAS libraries that are loaded."""
    import scipy.linalg.cython_blas  # noqa: F401
    from threadpoolctl import ThreadpoolController

    return [library for library in ThreadpoolController().lib_controllers if library.user_api == "blas"]


class _OneThread:
    """Limits the libraries to one thread while any caller needs it; the last one restores them."""

    def __init__(self) -> None:
        self._lock, self._wanted, self._before = threading.Lock(), 0, list[int]()

    def __enter__(self) -> None:
        with self._lock:
            if not self._wanted:
                self._before = [library.get_num_threads() for library in _libraries()]
                for library in _libraries():
                    _set(library, 1)
            self._wanted += 1

    def __exit__(self, *error: object) -> None:
        with self._lock:
            self._wanted -= 1
            if not self._wanted:
                for library, number in zip(_libraries(), self._before, strict=True):
                    _set(library, number)
                    _let_go(library)

    def forget(self) -> None:
        """In a process that was forked: the threads of its parent are not here, whatever they wanted."""
        wanted, self._lock, self._wanted = self._wanted, threading.Lock(), 0
        if wanted:
            for library, number in zip(_libraries(), self._before, strict=True):
                _set(library, number)
                _let_go(library)


def _set(library: Any, number: int) -> None:
    """Set the threads of a library, from whichever thread this is."""
    _let_go(library)
    library.set_num_threads(number)


def _let_go(library: Any) -> None:
    """From version 3.8 on, threadpoolctl listens to the first thread that sets a number, until told otherwise."""
    if hasattr(library, "clear_controlling_thread"):
        library.clear_controlling_thread(force=True)


#: With it BLAS computes with the thread that calls it, so that sums keep their order.
one_blas_thread = _OneThread()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=one_blas_thread.forget)
