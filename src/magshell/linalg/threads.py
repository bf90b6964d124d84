"""Threads of a factorisation."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
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
def _libraries() -> Any:
    import scipy.linalg.cython_blas  # noqa: F401
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """BLAS computes with the thread that calls it: fronts are small, and sums keep their order."""
    with _libraries().limit(limits=1, user_api="blas"):
        yield
