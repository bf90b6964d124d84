"""How many mutations there are, and what no mutation may do: take long, take much memory, say nothing of where."""

from __future__ import annotations

import os
import re
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from hypothesis import HealthCheck, settings

MUTATIONS = int(os.environ.get("MAGSHELL_MUTATIONS", "0"))
"""In all, as `make verify` asks for; 0: the few hundred of `make test`, each time the same."""
FEW = 200
SECONDS = 120.0
"""What hangs takes longer on any machine."""
MEMORY = 4 << 30


def share(part: float) -> Callable[[Any], Any]:
    """Settings of a test that takes this part of all mutations."""
    return settings(
        max_examples=max(1, round(part * (MUTATIONS or FEW))),
        derandomize=not MUTATIONS,
        database=None,
        deadline=None,
        suppress_health_check=[
            HealthCheck.too_slow,
            HealthCheck.data_too_large,
            HealthCheck.filter_too_much,
            HealthCheck.function_scoped_fixture,
        ],
    )


@contextmanager
def bounded() -> Iterator[None]:
    """Fail if the block takes long or much memory (where the system can tell)."""
    if sys.platform != "linux":
        yield
        return

    def late(number: int, frame: FrameType | None) -> None:
        raise AssertionError(f"hangs: not done in {SECONDS:g} s")

    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    before, hard = resource.getrlimit(resource.RLIMIT_AS)
    previous = signal.signal(signal.SIGALRM, late)
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, hard))
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)
        resource.setrlimit(resource.RLIMIT_AS, (before, hard))


def located(error: Exception, name: str) -> None:
    """Every line of an error begins with the file and says something of bearable length."""
    lines = str(error).splitlines()
    assert lines, "an error without words"
    for line in lines:
        assert re.match(rf"{re.escape(name)}(, line \d+)?: \S", line), f"not located: {line!r}"
        assert line.isprintable(), f"not printable: {line!r}"
        assert len(line) < 1000, f"{len(line)} characters: {line[:200]!r}"
