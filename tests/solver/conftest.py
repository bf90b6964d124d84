"""Paths that several files look at."""

from __future__ import annotations

import pytest

import magshell as ms
from solver.arches import arch


@pytest.fixture(scope="session")
def snapped() -> ms.Path:
    """The arch under load control, which goes over to the arc length at the limit point."""
    return ms.solve(arch())
