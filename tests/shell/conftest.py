"""Laws of tests."""

from __future__ import annotations

import pytest
from magnetics import reference as coupling_reference

from magshell.magnetics import law as coupling_laws
from magshell.materials import law as material_laws
from shell import nonlinear_coupling


@pytest.fixture
def registry():
    """Laws that a test registers are forgotten after it."""
    kept = [(callbacks, dict(callbacks)) for callbacks in (material_laws.callbacks, coupling_laws.callbacks)]
    conservative = set(coupling_laws._conservative)
    yield
    for callbacks, before in kept:
        callbacks.clear()
        callbacks.update(before)
    coupling_laws._conservative.clear()
    coupling_laws._conservative.update(conservative)


@pytest.fixture
def nonlinear(registry, monkeypatch):
    """A coupling law that is not linear in m and n."""
    law = nonlinear_coupling.Nonlinear
    coupling_laws.coupling_law(nonlinear_coupling.law, has_energy=True)(law)
    monkeypatch.setitem(coupling_reference.ENERGIES, law, nonlinear_coupling.energy)
    return law()
