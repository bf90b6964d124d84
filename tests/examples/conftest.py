"""Each built-in problem is solved once for all tests."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from magshell import Path, problem, solve


@pytest.fixture(scope="session")
def solved() -> Callable[[str], Path]:
    """Path of a built-in problem, by name, with the settings that a user gets."""

    @cache
    def path(name: str) -> Path:
        built = problem.load(name)
        return solve(built.model, built.settings)

    return path
