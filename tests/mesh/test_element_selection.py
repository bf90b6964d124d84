"""Element groups by coordinates, and of other groups."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms

STRIP = ms.mesh.rectangle(4.0, 2.0, (4, 2))


def test_elements_between_coordinates():
    mesh = STRIP.select_elements("outer", x1=(2.0, 4.0))
    assert mesh.element_groups["outer"].tolist() == [2, 3, 6, 7]
    assert STRIP.element_groups == {}
    corner = mesh.select_elements("corner", x1=(3.0, 9.0), x2=(-1.0, 1.0), x3=(-1.0, 1.0))
    assert corner.element_groups["corner"].tolist() == [3]


def test_elements_of_groups():
    mesh = STRIP.select_elements("outer", x1=(2.0, 4.0)).select_elements("low", x2=(0.0, 1.0))
    both = mesh.select_elements("both", groups=["outer", "low"])
    assert both.element_groups["both"].tolist() == [0, 1, 2, 3, 6, 7]
    assert mesh.select_elements("end", x1=(3.0, 4.0), groups=["outer"]).element_groups["end"].tolist() == [3, 7]


def test_elements_of_a_curved_mesh():
    tube = ms.mesh.cylinder(1.0, 2.0, (8, 4)).select_elements("near", x3=(0.0, 1.0))
    centres = tube.points[tube.elements].mean(axis=1)
    assert tube.element_groups["near"].tolist() == np.flatnonzero(centres[:, 2] < 1.0).tolist()


@pytest.mark.parametrize(
    ("ranges", "words"),
    [
        ({}, "give at least one of the ranges x1, x2, x3, shapes or groups"),
        ({"x1": (1.5, 4.0)}, r"an element, from \(1, .*\) m? ?to .*lies across a bound of the range"),
        ({"x1": (5.0, 6.0)}, "no element lies there; the mesh spans"),
        ({"x1": (1.0, 1.0)}, r"x1 is \[1.0, 1.0\]; it must be a least and a greatest coordinate"),
        ({"x2": (1.0, np.inf)}, r"x2 is \[1.0, inf\]"),
        ({"x3": (1.0,)}, r"x3 is \[1.0\]"),
        ({"groups": ["outr"]}, "There is no element group 'outr'"),
    ],
)
def test_bad_selections(ranges, words):
    with pytest.raises(ms.InputError, match=words):
        STRIP.select_elements("one", **ranges)


def test_a_name_belongs_to_one_group():
    with pytest.raises(ms.InputError, match="left"):
        STRIP.select_elements("left", x1=(0.0, 1.0))
