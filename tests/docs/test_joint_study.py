"""The study of rigid bodies, joints and hinges: every case within what the issue of folded shells asks for."""

from __future__ import annotations

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from joint_study.frames import cantilever, hinge, joint_row, large_rotation, stiff_hinge, tee
from joint_study.sections import box, folded_plate, z_section
from joint_study.strips import SCALES, rolled, tip_magnet

CASES = (cantilever, tee, large_rotation, tip_magnet, hinge, stiff_hinge, joint_row, box, folded_plate)


@pytest.mark.parametrize("name", SCALES)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_closed_forms(case, name):
    rows = list(case(name))
    assert rows
    for row in rows:
        assert abs(row.difference) < 1e-3, row


@pytest.mark.parametrize("name", SCALES)
@pytest.mark.parametrize("by_moment", [pytest.param(False, marks=pytest.mark.verify), True])
def test_strip_rolled_twice(name, by_moment):
    for row in rolled(name, by_moment):
        assert abs(row.difference) < 2e-3, row


def test_z_section():
    nafems, vlasov, slender = z_section(3)
    assert abs(nafems.difference) < 0.025
    assert abs(vlasov.difference) < 0.026
    assert abs(slender.difference) < 0.006
    assert abs(vlasov.reference - nafems.reference) < 0.5
