"""Fields along the path: amounts, motion of the frame, derivatives along the path; the same for every kind of field."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some
from scipy.spatial.transform import Rotation

from magnetics.fields.cases import FIELDS, MOTION, SHAPES, around, magnets, near
from magshell.errors import InputError
from magshell.magnetics.fields import MagnetField, Motion, Source, UniformField

MOVING = [name for name in FIELDS if name not in ("uniform", "coils", "sum")]


def size(array):
    return float(np.linalg.norm(array))


@pytest.mark.parametrize("name", FIELDS)
def test_the_derivatives_are_those_of_the_field(name):
    """Also under motion: against differences of `at`."""
    field, points, step = FIELDS[name], near(), 1e-4
    amounts = field.ends(2)[1:].mean(axis=0)
    values = field.at(amounts, points)
    for j, axis in enumerate(np.eye(3)):
        ahead, behind = (field.at(amounts, points + sign * step * axis) for sign in (1.0, -1.0))
        slope = (ahead.flux_density - behind.flux_density) / (2.0 * step)
        assert size(values.gradient[:, :, j] - slope) <= 1e-4 * size(values.gradient) + 1e-12
        bend = (ahead.gradient - behind.gradient) / (2.0 * step)
        assert (
            size(values.second[:, :, :, j] - bend) <= 1e-4 * size(values.second) + 1e-9 * size(values.gradient) / step
        )
    without = field.at(amounts, points, second=False)
    assert without.second is None
    assert np.allclose(without.gradient, values.gradient, rtol=0.0, atol=1e-12 * size(values.gradient))


@pytest.mark.parametrize("name", FIELDS)
def test_rates_along_the_path(name):
    """Exact, so central differences of two steps approach them with their order."""
    field, points = FIELDS[name], near()
    start, end = field.ends(2)[1:]
    change, amounts = end - start, start + 0.3 * (end - start)
    rate, errors = field.rate(amounts, change, points), []
    for t in (0.02, 0.01):
        ahead, behind = (field.at(amounts + sign * t * change, points) for sign in (1.0, -1.0))
        pairs = [(rate.flux_density, ahead.flux_density - behind.flux_density)]
        pairs.append((rate.gradient, ahead.gradient - behind.gradient))
        errors.append([size(exact - difference / (2.0 * t)) / max(size(exact), 1e-12) for exact, difference in pairs])
    for coarse, fine in zip(*errors, strict=True):
        assert fine < 1e-8 or (fine < 2e-2 and coarse / fine == pytest.approx(4.0, rel=0.15))
    assert not field.rate(amounts, np.zeros_like(change), points).flux_density.any()


@pytest.mark.parametrize("name", MOVING)
def test_moving_field_and_points_together_changes_nothing(name):
    field, points = FIELDS[name], near()
    still, amounts = field.ends(2)[1] * [1, 0, 0, 0, 0], field.ends(2)[2] * [0, 1, 1, 1, 1]
    amounts[0] = still[0]
    turn, shift = field.placement(amounts)
    one, other = field.at(still, points), field.at(amounts, points @ turn.T + shift)
    expected = (
        one.flux_density @ turn.T,
        turn @ one.gradient @ turn.T,
        np.einsum("ia,jb,kc,pabc->pijk", turn, turn, turn, one.second),
    )
    for found, right, allowed in zip(other, expected, (1e-13, 1e-10, 1e-8), strict=True):
        assert size(found - right) < allowed * size(right) + 1e-15


@pytest.mark.parametrize("name", SHAPES)
def test_a_source_placed_elsewhere_is_the_source_seen_from_elsewhere(name):
    """Position and orientation as given, in place of the motion: the field in its own axes, to 1e-10."""
    shape, points = SHAPES[name], around(SHAPES[name], 20)
    turn, shift = Rotation.from_rotvec((1.0, -0.4, 2.0)), np.array([0.3, -0.1, 0.2])
    placed = MagnetField([Source(shape, shift, turn.as_rotvec())]).direct(turn.apply(points) + shift, False)
    expected = turn.apply(shape.values(points, False).flux_density)
    assert size(placed.flux_density - expected) < 1e-10 * size(expected)


def test_sources_now_are_where_their_field_is():
    field = magnets(MOTION)
    amounts = field.ends(2)[2]
    moved = MagnetField(field.now(amounts)).direct(near(), False)
    values = field.at(amounts, near(), False)
    assert size(amounts[0] * moved.flux_density - values.flux_density) < 1e-12 * size(values.flux_density)


@given(angle=some.floats(-7.0, 7.0))
def test_a_magnet_circles_about_a_centre_and_shows_the_same_side(angle):
    """A point that circles with it sees the same field, turned."""
    field = MagnetField(
        [Source(SHAPES["cuboid"], (0.05, 0.0, 0.0))],
        Motion(rotation_axis=(0, 0, 2.0), rotation=(angle,), centre=(0.0, 0.0, 0.0)),
    )
    start, end = field.ends(1)
    start = np.array([1.0, 0, 0, 0, 0])
    turn = Rotation.from_rotvec((0.0, 0.0, angle))
    point = np.array([[0.02, 0.01, 0.01]])
    found = field.at(end, turn.apply(point), False).flux_density
    assert size(found - turn.apply(field.at(start, point, False).flux_density)) < 1e-14
    assert np.allclose(field.now(end)[0].place, turn.apply((0.05, 0.0, 0.0)), atol=1e-15)


def test_by_default_sources_turn_about_their_middle():
    field = MagnetField([Source(SHAPES["sphere"], (0.1, 0, 0))], Motion(rotation_axis=(0, 1, 0), rotation=(np.pi,)))
    assert np.allclose(field.now(field.ends(1)[1])[0].place, (0.1, 0, 0), atol=1e-15)


def test_amounts_at_the_ends_of_stages():
    field = magnets(MOTION)
    assert np.array_equal(field.ends(2), [[0] * 5, [1, 0.01, 0, -0.004, 0.4], [0.5, 0.002, 0.003, 0, -0.9]])
    assert field.stages == 2
    assert np.array_equal(magnets().ends(3)[:, 0], [0, 1, 1, 1])
    assert magnets().stages == 1
    assert field.drives == ("magnets.multiplier", "magnets.d1", "magnets.d2", "magnets.d3", "magnets.angle")


def test_the_uniform_field_is_what_it_was_to_the_last_bit():
    field = FIELDS["uniform"]
    for amounts in field.ends(2):
        values = field.at(amounts, near())
        assert np.array_equal(values.flux_density, np.tile(amounts[0] * field.turned(amounts[1]), (12, 1)))
        assert values.flux_density.strides[0] == 0, "no memory for each point"
        assert not values.gradient.any()
        assert not values.second.any()
    assert field.is_uniform
    assert not FIELDS["magnets"].is_uniform
    assert not FIELDS["sum"].is_uniform
    assert (field + field).is_uniform


def test_a_sum_adds_up_and_names_what_drives_it():
    total, parts = FIELDS["sum"], [FIELDS[name] for name in ("uniform", "magnets", "gradient")]
    amounts = total.ends(2)[2]
    expected = sum(part.at(part.ends(2)[2], near()).flux_density for part in parts)
    assert size(total.at(amounts, near()).flux_density - expected) < 1e-15
    assert len(total.drives) == len(amounts) == 12
    assert len(total.fields) == 3, "sums of sums are flat"
    twice = magnets() + magnets()
    assert twice.drives[0] == "magnets.multiplier"
    assert twice.drives[5] == "magnets-2.multiplier"
    assert [part for part, _ in total.parts(amounts)] == parts


@pytest.mark.parametrize("name", MOVING)
def test_points_that_are_not_finite_have_no_field_and_hang_nothing(name):
    """Elliptic integrals of magpylib never end for NaN."""
    points = near(4)
    points[1, 2] = np.nan
    points[2, 0] = np.inf
    values = FIELDS[name].at(FIELDS[name].ends(2)[1], points)
    for array in values:
        assert np.isnan(array[1:3]).all()
        assert np.isfinite(array[[0, 3]]).all()
    alone = FIELDS[name].at(FIELDS[name].ends(2)[1], points[1:3])
    assert np.isnan(alone.flux_density).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rotation": (1.0,)}, "rotation_axis and rotation go together"),
        ({"rotation_axis": (1, 0, 0)}, "rotation_axis and rotation go together"),
        ({"rotation_axis": (0, 0, 0), "rotation": (1.0,)}, "zero vector"),
        ({"rotation_axis": (1, 0), "rotation": (1.0,)}, r"rotation_axis is \(1, 0\); it needs three"),
        ({"rotation_axis": (1, 0, 0), "rotation": ("a",)}, "rotation is .* it takes numbers"),
        ({"centre": (0, np.nan, 0)}, "centre is .*; it needs three finite numbers"),
        ({"history": ()}, "it takes finite numbers, one for each stage"),
        ({"displacement": (1, 2, 3)}, "displacement is .*for each stage"),
        ({"displacement": [(1, 2, np.inf)]}, "displacement is .*for each stage"),
    ],
)
def test_refused_motions(options, message):
    with pytest.raises(InputError, match=message):
        Motion(**options)


@pytest.mark.parametrize("key", ["history", "displacement", "rotation"])
def test_a_history_for_another_number_of_stages(key):
    values = {"history": (1.0, 2.0), "displacement": [(0, 0, 0)] * 2, "rotation": (0.1, 0.2)}
    axis = {"rotation_axis": (0, 0, 1)} if key == "rotation" else {}
    with pytest.raises(InputError, match="2 entries; it needs one for each of the 3 stages"):
        magnets(Motion(**{key: values[key]}, **axis)).ends(3)
    with pytest.raises(InputError, match="2 entries; it needs one for each of the 3 stages"):
        UniformField((0, 0, 1), history=(1, 2)).ends(3)
