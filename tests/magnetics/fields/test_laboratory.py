"""Constant gradients and coils by calibration: what is refused, and currents for a wanted field."""

from __future__ import annotations

import numpy as np
import pytest

from magnetics.fields.cases import near
from magshell.errors import InputError
from magshell.magnetics.fields import CoilSystem, GradientField, MagnetField, Source, helmholtz

TENSOR = np.array([(0.1, 0.2, 0.0), (0.2, -0.3, 0.1), (0.0, 0.1, 0.2)])


def test_linear_about_its_centre():
    field = GradientField(TENSOR, (1e-3, 0, 2e-3), (0.1, 0.0, -0.2))
    values = field.at(field.ends(1)[1], near())
    assert np.allclose(values.flux_density, [1e-3, 0, 2e-3] + (near() - [0.1, 0.0, -0.2]) @ TENSOR.T, atol=1e-16)
    assert np.allclose(values.gradient, TENSOR, atol=1e-16)
    assert not values.second.any()


@pytest.mark.parametrize(
    ("tensor", "message"),
    [
        (np.diag([0.1, 0.1, 0.1]), r"adds up to 0.3 T/m; it must be 0.* ∂B3/∂x3 is -0.2 T/m"),
        ([(0, 0.1, 0), (0, 0, 0), (0, 0, 0)], r"∂B1/∂x2 is 0.1 and ∂B2/∂x1 is 0 T/m; they must be equal"),
        ([(0, 0, 0), (0, 0, 0.2), (0, 0.1, 0)], r"∂B2/∂x3 is 0.2 and ∂B3/∂x2 is 0.1"),
        (np.zeros((2, 3)), r"shape \(2, 3\); it needs three rows"),
        ([(0, 0, np.nan), (0, 0, 0), (0, 0, 0)], "rows of finite numbers"),
        ("tensor", "rows of finite numbers"),
    ],
)
def test_refused_gradients(tensor, message):
    with pytest.raises(InputError, match=message):
        GradientField(tensor)


def test_round_off_of_a_typed_tensor_is_taken_away():
    field = GradientField(TENSOR + 1e-8 * np.arange(9).reshape(3, 3))
    assert np.array_equal(field.gradient, field.gradient.T)
    assert abs(np.trace(field.gradient)) < 1e-16


def eight_coils():
    """Calibration of eight loops on a sphere about the origin, for 1 A each."""
    corners = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T + 0.3 * np.random.default_rng(4).normal(
        size=(8, 3)
    )
    columns = []
    for corner in corners:
        pair = helmholtz(0.05, 1.0, 100)[:1]
        axis = np.cross([0, 0, 1], corner)
        angle = np.arccos(corner[2] / np.linalg.norm(corner))
        turn = angle * axis / np.linalg.norm(axis)
        source = Source(pair[0].shape, 0.15 * corner / np.linalg.norm(corner), turn)
        values = MagnetField([source]).direct(np.zeros((1, 3)), False)
        gradient = values.gradient[0]
        columns.append([*values.flux_density[0], *gradient[0], *gradient[1, 1:]])
    return np.array(columns).T


def test_currents_for_a_wanted_field_and_gradient():
    coils = CoilSystem(eight_coils(), [np.zeros(8)])
    currents = coils.currents_for((1e-3, 2e-3, -1e-3), 0.1 * TENSOR)
    values = coils.at(currents, np.zeros((1, 3)))
    assert values.flux_density[0] == pytest.approx([1e-3, 2e-3, -1e-3], rel=1e-9)
    assert values.gradient[0] == pytest.approx(0.1 * TENSOR, abs=1e-12)
    least = coils.currents_for((1e-3, 2e-3, -1e-3))
    assert np.linalg.norm(least) < np.linalg.norm(currents)
    assert coils.at(least, np.zeros((1, 3))).flux_density[0] == pytest.approx([1e-3, 2e-3, -1e-3], rel=1e-9)
    with pytest.raises(InputError, match="these 3 coils cannot make this field and gradient together"):
        CoilSystem(eight_coils()[:, :3], [np.zeros(3)]).currents_for((1e-3, 0, 0), TENSOR)


def test_currents_vary_straight_along_the_path():
    coils = CoilSystem(np.eye(8)[:, :4], [(1, 2, 3, 4), (0, 0, 0, 1)])
    assert np.array_equal(coils.ends(2), [(0, 0, 0, 0), (1, 2, 3, 4), (0, 0, 0, 1)])
    assert coils.drives == tuple(f"coils.current{k}" for k in (1, 2, 3, 4))
    assert CoilSystem(np.eye(3), [(1, 2, 3)]).at(np.ones(3), near()).gradient.any() == np.False_


@pytest.mark.parametrize(
    ("calibration", "currents", "message"),
    [
        (np.zeros((5, 2)), [(1, 1)], "calibration has 5 rows; it needs 8"),
        (np.zeros((8, 2)), [(1, 1, 1)], "currents are for 3 coils, the calibration for 2"),
        (np.zeros((8, 2)), [(1,), (1, 1)], "currents must be rows of finite numbers"),
        (np.full((8, 2), np.nan), [(1, 1)], "calibration must be rows of finite numbers"),
    ],
)
def test_refused_coils(calibration, currents, message):
    with pytest.raises(InputError, match=message):
        CoilSystem(calibration, currents)


def test_currents_for_another_number_of_stages():
    with pytest.raises(InputError, match="currents has 1 entries; it needs one for each of the 2 stages"):
        CoilSystem(np.eye(3), [(1, 2, 3)]).ends(2)
