"""The independent solutions that the accuracy study compares with."""

from __future__ import annotations

import math
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from accuracy_study.elastica import TABLE, tip_deflection
from accuracy_study.richardson import limit
from accuracy_study.tube import Tube

MU0 = 4e-7 * math.pi


@pytest.mark.parametrize("order", [0.7, 2.0, 4.0])
def test_limit_of_a_power_of_uneven_sizes(order: float) -> None:
    sizes = (2.0, 1.0, 2.0 / 3.0, 0.5)
    found = limit(sizes, [7.0 - 0.3 * size**order for size in sizes])
    assert found.value == pytest.approx(7.0, abs=1e-12), f"{found}"
    assert found.order == pytest.approx(order, abs=1e-9), f"{found}"


@pytest.mark.parametrize("values", [(3.0, 1.0, 1.1), (1.0, 1.0, 1.0), (3.0, 2.0, 1.0)])
def test_values_without_an_order_end_at_the_last(values: tuple[float, ...]) -> None:
    found = limit((1.0, 0.5, 0.25), values)
    assert math.isnan(found.order), f"{values}: {found}"
    assert found.value == values[-1]


@pytest.mark.parametrize("q", TABLE)
def test_elastica_has_the_tabulated_deflection(q: float) -> None:
    found = tip_deflection(q)
    assert found == pytest.approx(TABLE[q], abs=0.6e-5), f"q = {q}: {found}, table {TABLE[q]}"


def test_elastica_of_a_large_load_stands_up_without_loops() -> None:
    """Upright but for a bend of length 1/√q: 1 - w = ∫(1 - cos δ) = (2 - √2)/√q, with δ' = 2 √q sin(δ/2)."""
    for q in (53.0, 60.0):
        bend = (2.0 - math.sqrt(2.0)) / math.sqrt(q)
        found = 1.0 - tip_deflection(q)
        assert found == pytest.approx(bend, rel=4.0 * math.exp(-math.sqrt(q))), f"q = {q}: {found}, {bend}"


def test_elastica_of_a_small_load_is_a_beam() -> None:
    """θ'' = -q, so that w = q/3 to the third power of q."""
    q = 1e-3
    assert tip_deflection(q) == pytest.approx(q / 3.0, rel=q**2)


def test_long_tube_is_a_ring_in_plane_strain() -> None:
    """In a tube that does not change along its axis the couple bends rings; the normal turns by β with D β¨/R² = c.

    W_n of the inextensible ring: β = (V + n W)/R with n V + W = 0, so W = n R β/(n² - 1), and D n² β_n/R² = -b_n.
    """
    mu, lam, radius, thickness, couple = 135e3, 3250e3, 20e-3, 0.02e-3, 1.0
    tube = Tube(radius, 8.0, thickness, mu, lam, 0.0, couple)
    young, poisson = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), lam / (2.0 * (lam + mu))
    bending = young * thickness**3 / (12.0 * (1.0 - poisson**2))
    ring = 0.0
    for n in range(2, 50, 2):
        b = 4.0 * couple * thickness / math.pi * (-1.0) ** (n // 2 + 1) * n / (n**2 - 1.0)
        ring -= n * radius / (n**2 - 1.0) * b * radius**2 / (bending * n**2)
    found = tube.side()
    assert found == pytest.approx(ring, rel=1e-3), f"tube {found}, ring {ring}"
