"""The uniform field and the stops of its path."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some
from scipy.spatial.transform import Rotation

from magshell.errors import InputError
from magshell.magnetics import UniformField

VECTORS = some.tuples(*[some.floats(-2.0, 2.0)] * 3)


def test_magnitude():
    assert UniformField((3e-3, 0.0, -4e-3)).magnitude == pytest.approx(5e-3, rel=1e-15)


def test_stops_may_lie_within_the_largest_multiplier():
    assert UniformField((0.0, 0.0, 1.0), (1.9, 2.0), history=(-2.0, 1.0)).stops == (1.9, 2.0)
    with pytest.raises(InputError, match=r"0\.6 T is beyond the field's largest magnitude 0\.5 T"):
        UniformField((0.0, 0.0, 1.0), (0.6,), history=(0.5,))


@settings(deadline=None)
@given(angle=some.floats(-10.0, 10.0), vector=VECTORS, axis=VECTORS.filter(lambda axis: np.linalg.norm(axis) > 1e-3))
def test_turned_about_the_axis(angle, vector, axis):
    field = UniformField(vector, rotation_axis=axis, rotation=(0.0,))
    expected = Rotation.from_rotvec(angle * np.array(axis) / np.linalg.norm(axis)).apply(vector)
    assert np.abs(field.turned(angle) - expected).max() < 1e-14 * max(1.0, np.linalg.norm(vector))
    assert np.linalg.norm(field.axis) == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"history": ()}, "history is .* it takes finite numbers"),
        ({"history": (1.0, float("nan"))}, "history is .* it takes finite numbers"),
        ({"history": "up"}, "history is 'up'; it takes numbers"),
        ({"rotation": (1.0,)}, "rotation_axis and rotation go together"),
        ({"rotation_axis": (0, 1, 0)}, "rotation_axis and rotation go together"),
        ({"rotation": (1.0,), "rotation_axis": (0, 0, 0)}, "rotation_axis is .*not all zero"),
        ({"rotation": (1.0,), "rotation_axis": "x"}, "rotation_axis is 'x'"),
        ({"rotation": ("a",), "rotation_axis": (0, 1, 0)}, "rotation is .* it takes numbers"),
    ],
)
def test_refused_histories_and_rotations(options, message):
    with pytest.raises(InputError, match=message):
        UniformField((0.0, 0.0, 1.0), **options)


def test_the_vector_cannot_be_changed():
    given = np.array([0.0, 0.0, 1.0])
    field = UniformField(given)
    given[0] = 5.0
    assert field.vector[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        field.vector[0] = 1.0


@pytest.mark.parametrize(
    ("flux_density", "stops", "message"),
    [
        ((1.0, 2.0), (), "needs 3 finite components"),
        ((1.0, 2.0, float("inf")), (), "needs 3 finite components"),
        ("up", (), "are numbers"),
        ((0.0, 0.0, 1.0), (0.5, 0.5), "must be positive and increasing"),
        ((0.0, 0.0, 1.0), (0.8, 0.5), "must be positive and increasing"),
        ((0.0, 0.0, 1.0), (0.0, 0.5), "must be positive and increasing"),
        ((0.0, 0.0, 1.0), (float("nan"),), "must be positive and increasing"),
        ((0.0, 0.0, 1.0), (1.1,), "1.1 T is beyond the field's largest magnitude 1 T"),
    ],
)
def test_refused(flux_density, stops, message):
    with pytest.raises(InputError, match=message):
        UniformField(flux_density, stops)
