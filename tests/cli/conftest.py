"""Pictures of few pixels: what is on them is tested elsewhere."""

from __future__ import annotations

from collections.abc import Iterator

import pytest


@pytest.fixture(scope="module", autouse=True)
def small_pictures() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        for module in ("curve", "setup", "shape"):
            patch.setattr(f"magshell.output.{module}.DPI", 40)
        yield
