"""Pictures of few pixels: what is on them is tested elsewhere."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="module", autouse=True)
def pictures_are_small(small_pictures: None) -> None:
    pass
