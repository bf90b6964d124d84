"""What a model must offer to be checked for likely slips."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from magshell.arrays import FloatArray
from magshell.model.constraints import Constraints
from magshell.model.symmetry import Mirrored


class Asked(Mirrored, Protocol):
    """A model."""

    @property
    def coupling(self) -> Any: ...
    @property
    def constraints(self) -> Constraints: ...
    @property
    def field_magnitude(self) -> float: ...
    @property
    def largest_field(self) -> float: ...
    @property
    def forces_at_rest(self) -> tuple[FloatArray, ...]: ...
    @property
    def probe_nodes(self) -> Mapping[str, int]: ...
