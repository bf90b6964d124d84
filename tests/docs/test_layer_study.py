"""The study of layers: laminates against their closed forms, also where Poisson's ratios differ."""

from __future__ import annotations

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from make_layer_study import STACKS, bent


@pytest.mark.parametrize("stack", STACKS, ids=[stack.name for stack in STACKS])
def test_laminates_bend_as_theory_says(stack):
    found = bent(stack, 0.1)
    assert found.ratio == pytest.approx(1.0, abs=2e-4)
    if "sandwich" in stack.name:
        assert bent(stack).shear > 0.4, "the core's shear does not count"
        assert bent(stack).ratio == pytest.approx(1.0, abs=2e-4)
