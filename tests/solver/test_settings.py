"""Settings refuse what cannot be meant."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, fields

import pytest

from magshell import InputError, Settings, solve
from solver.models import strip

NUMBERS = [field.name for field in fields(Settings) if field.type in ("float", "int")]


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [0, -1, float("nan"), float("inf")])
def test_number_that_is_not_positive_and_finite(name: str, value: float) -> None:
    with pytest.raises(InputError, match=rf"{name} is .*positive and finite"):
        Settings(**{name: value})


def test_loose_tolerance() -> None:
    with pytest.raises(InputError, match=r"tolerance is 0\.1; a result needs less than"):
        Settings(tolerance=0.1)


@pytest.mark.parametrize(
    "steps",
    [
        {"first_step": 0.5, "largest_step": 0.1},
        {"largest_step": 1.5},
    ],
)
def test_steps_out_of_order(steps: dict[str, float]) -> None:
    with pytest.raises(InputError, match=r"steps must satisfy first_step .* <= largest_step"):
        Settings(**steps)


def test_smallest_step_is_a_length() -> None:
    Settings(first_step=1e-7)
    with pytest.raises(InputError, match=r"smallest_step is 0\.1 body sizes; a path needs less than 1e-2"):
        Settings(smallest_step=0.1)


def test_unknown_linear_solver_names_the_nearest() -> None:
    with pytest.raises(InputError, match=r"linear_solver is 'super-lu'\. Did you mean 'superlu'"):
        solve(strip(), Settings(linear_solver="super-lu"))


def test_settings_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        Settings().tolerance = 1e-3  # type: ignore[misc]


def test_numbers_are_all_there() -> None:
    assert len(NUMBERS) == 6, NUMBERS
    assert set(NUMBERS) >= {"tolerance", "max_iterations", "first_step"}
