"""Random examples are the same in every run and may take as long as they take; no terminal is spoken of."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("magshell", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("magshell")
for name in ("COLUMNS", "FORCE_COLOR"):
    os.environ.pop(name, None)


@pytest.fixture(scope="module")
def small_pictures() -> Iterator[None]:
    """Pictures of few pixels, where what is on them is tested elsewhere."""
    with pytest.MonkeyPatch.context() as patch:
        for module in ("curve", "setup", "shape"):
            patch.setattr(f"magshell.output.{module}.DPI", 40)
        yield
