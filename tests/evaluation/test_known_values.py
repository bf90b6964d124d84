"""Stresses and resultants against known values; the docs print the same table (`docs/make_stress_study.py`)."""

from __future__ import annotations

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from stress_study.problems import PROBLEMS, Value, solved_problem


@pytest.mark.parametrize("name", PROBLEMS)
def test_values_are_within_their_claims(name: str) -> None:
    for value in solved_problem(name):
        assert abs(value.error) < value.within, value


def test_a_value_knows_its_error() -> None:
    assert Value("a", "b", "m", 1.01, 1.0, 0.02).error == pytest.approx(0.01)
