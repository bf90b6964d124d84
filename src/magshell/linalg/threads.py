"""Threads of a factorisation."""

from __future__ import annotations

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
                    library.set_num_threads(1)
            self._wanted += 1

    def __exit__(self, *error: object) -> None:
        with self._lock:
            self._wanted -= 1
            if not self._wanted:
                for library, number in zip(_libraries(), self._before, strict=True):
                    library.set_num_threads(number)


#: With it BLAS computes with the thread that calls it: fronts are small, and sums keep their order.
one_blas_thread = _OneThread()
