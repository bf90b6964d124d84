"""What gmsh changes in a process that uses it directly, as some tests here do, is changed back."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest


@pytest.fixture(autouse=True)
def broken_pipes_raise() -> Iterator[None]:
    """`gmsh.initialize` lets a broken pipe end the process."""
    yield
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.getsignal(signal.SIGPIPE))
