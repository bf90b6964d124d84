"""Each built-in problem is solved once for all tests."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from examples.problems import PART_OF_THE_PUMP, part_of_the_pump, read
from magshell import Path, solve
from magshell.problem.building import build


@pytest.fixture(scope="session")
def solved() -> Callable[[str], Path]:
    """Path of a built-in problem, by name, with the element of the source and the settings that a user gets."""

    @cache
    def path(name: str) -> Path:
        source, file = part_of_the_pump() if name == PART_OF_THE_PUMP else read(name)
        built = build(file, source)
        return solve(built.model, built.settings)

    return path
