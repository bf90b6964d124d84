"""Paths of bodies of several parts are in balance."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.magnetics import laws
from solver.models import arm, in_parts


@pytest.mark.parametrize("coupling", laws(), ids=lambda law: law.__name__)
@pytest.mark.parametrize("element", ["quadratic", "paper"])
def test_balance(coupling: type, element: str) -> None:
    """The torque is integrated of the point values, with the stretches of directors and of levels."""
    path = ms.solve(in_parts(arm(coupling=coupling(), element=element)))
    copies = np.arange(path.discretisation.rows.places, len(path.discretisation.rows.of))
    assert np.abs(path.steps[-1].state.s[copies]).min() > 1e-6
    for step in path.steps[1:]:
        assert max(step.balance.force_imbalance, step.balance.moment_imbalance) < 1e-8, step.balance
