"""Laws of tests."""

from __future__ import annotations

import pytest

from magshell.magnetics import law as coupling_laws
from magshell.materials import law as material_laws


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
