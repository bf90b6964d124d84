"""What a model must offer to be checked for likely slips."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from magshell.arrays import FloatArray
from magshell.model.constraints import Constraints
from magshell.model.course import Course
from magshell.model.elastic import ElasticSupport
from magshell.model.rigid import FreeTurn
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
    def springs(self) -> Sequence[ElasticSupport]: ...
    @property
    def turns(self) -> tuple[FreeTurn, ...]: ...
    def course(self, stage: int) -> Course: ...
    @property
    def probe_nodes(self) -> Mapping[str, int]: ...
