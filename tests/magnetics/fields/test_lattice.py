"""Splines on a lattice: their order, that they do not depend on what was asked before, and where they may be used."""

from __future__ import annotations

import numpy as np
import pytest

from magnetics.fields.cases import SHAPES, magnets, near
from magshell.errors import InputError
from magshell.magnetics.fields import FieldUnknown, MagnetField, Motion, Source, halbach
from magshell.magnetics.fields.lattice import CELLS, Lattice


def test_polynomials_of_fifth_degree_are_exact():
    def function(points):
        x, y, z = points.T
        return np.stack([x**5 - y**2 * z**3, y**5 * x, 1.0 + z**5 + x * y * z], axis=1)

    points = np.random.default_rng(0).uniform(-1.0, 1.0, (30, 3))
    values = Lattice(function, 0.3).values(points, True)
    _, y, z = points.T
    assert np.abs(values.flux_density - function(points)).max() < 1e-12
    assert np.abs(values.gradient[:, 0, 1] + 2 * y * z**3).max() < 1e-12
    assert np.abs(values.gradient[:, 1, 0] - y**5).max() < 1e-12
    assert np.abs(values.second[:, 0, 1, 2] + 6 * y * z**2).max() < 1e-11
    assert np.abs(values.second[:, 2, 2, 2] - 20 * z**3).max() < 1e-11


def test_order_of_the_errors():
    errors = []
    for spacing in (4e-3, 2e-3):
        field = magnets(spacing=spacing, depth=0.08)
        errors.append(field.interpolation_error(field.ends(1)[1], near(40)))
    ratios = np.divide(*errors)
    assert np.all(ratios > (40.0, 20.0, 10.0)), "orders 6, 5, 4"
    B, gradient, second = (float(np.abs(one).max()) for one in field.direct(near(40)))
    assert errors[1][0] < 1e-5 * B
    assert errors[1][1] < 1e-4 * gradient
    assert errors[1][2] < 1e-3 * second
    assert magnets().interpolation_error(field.ends(1)[1], near(40)) == (0.0, 0.0, 0.0)


def test_continuous_with_derivatives_from_block_to_block():
    field, edge = Lattice(SHAPES["loop"].flux_density, 1e-3), CELLS * 1e-3
    before, after = (field.values(np.array([[edge + gap, 0.003, 0.02]]), True) for gap in (-1e-12, 1e-12))
    for one, other in zip(before, after, strict=True):
        assert np.abs(one - other).max() < 1e-8 * np.abs(one).max()


def test_values_do_not_depend_on_what_was_asked_before():
    one, other = magnets(spacing=1e-3, depth=0.06), magnets(spacing=1e-3, depth=0.06)
    amounts = one.ends(1)[1]
    other.at(amounts, near(30, seed=5))
    for first, second in zip(one.at(amounts, near()), other.at(amounts, near()), strict=True):
        assert np.array_equal(first, second)
    alone = one.at(amounts, near()[3:4])
    assert np.array_equal(alone.gradient[0], one.at(amounts, near()).gradient[3])


def test_too_near_for_the_spacing():
    field = MagnetField([Source(SHAPES["sphere"], (0.0, 0.0, -0.012))], Motion(displacement=[(0, 0, 0.001)]), 1e-3)
    with pytest.raises(
        FieldUnknown, match=r"is 0\.001 m from the surface of a sphere; .* for 0\.008 m and more.*0\.00012"
    ):
        field.at(field.ends(1)[1], np.array([[0.0, 0.0, 0.0]]))
    for spacing in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match=r"spacing is .* it must be positive"):
            MagnetField([SHAPES["sphere"]], spacing=spacing)


def test_a_halbach_ring_of_16_costs_what_one_magnet_costs():
    """Counted in calls for values of B, not in seconds: none, once the lattice is there."""
    calls = []
    ring = MagnetField(halbach(0.05, 16, (0.01, 0.01, 0.01), 1.3), spacing=2.5e-3)
    inner = ring._lattice._function
    ring._lattice._function = lambda points: calls.append(len(points)) or inner(points)
    amounts, points = ring.ends(1)[1], 0.5 * near(500)
    ring.at(amounts, points)
    assert calls
    calls.clear()
    ring.at(amounts, points)
    assert not calls
