"""Each built-in problem is solved once for all tests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest

from magshell import Path, problem, solve

BALANCE = 1e-8


@pytest.fixture(scope="session")
def solved() -> Callable[[str], Path]:
    """Path of a built-in problem, by name.

    The residual of the free nodes is what unbalances the reactions: their sum is at most √nodes times its norm
    (Cauchy–Schwarz). The tolerance is set accordingly; all other settings are the file's.
    """

    @cache
    def path(name: str) -> Path:
        built = problem.load(name)
        tolerance = BALANCE / len(built.model.shell.mesh.points) ** 0.5
        return solve(built.model, replace(built.settings, tolerance=tolerance))

    return path
