"""The uniform field and the stops of its path."""

from __future__ import annotations

import numpy as np
import pytest

from magshell.errors import InputError
from magshell.magnetics import UniformField


def test_magnitude():
    assert UniformField((3e-3, 0.0, -4e-3)).magnitude == pytest.approx(5e-3, rel=1e-15)


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
        ((0.0, 0.0, 1.0), (1.1,), "1.1 T is beyond the field's magnitude 1 T"),
    ],
)
def test_refused(flux_density, stops, message):
    with pytest.raises(InputError, match=message):
        UniformField(flux_density, stops)
