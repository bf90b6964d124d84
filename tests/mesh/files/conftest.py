"""What gmsh changes in a process that uses it directly, as some tests here do, is changed back."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from magshell.processes import let_broken_pipes_raise


@pytest.fixture(autouse=True)
def broken_pipes_raise() -> Iterator[None]:
    """`gmsh.initialize` lets a broken pipe end the process."""
    yield
    let_broken_pipes_raise()
