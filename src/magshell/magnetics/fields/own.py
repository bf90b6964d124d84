"""The field of the body itself: a wish for it, and how it is switched on along the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields.field import Field, Values
from magshell.multipliers import amplitudes, numbers


@dataclass(frozen=True, eq=False)
class SelfField(Field):
    """The field of the body's own remanence, as a part of the field that acts on it.

    It depends on the state, so the equations add it at the shell (`magshell.equations.own_field`). As a field of
    space, for pictures and for B at the centre, it counts as zero.

    Parameters
    ----------
    history : sequence of float, optional
        Multiplier at the end of each stage; by default it grows to 1 in the first and stays. Before the first stage
        it is 0, so that the undeformed shell is in equilibrium.

    Raises
    ------
    InputError
        A history that is no list of finite numbers.
    """

    history: Sequence[float] | None = None
    name = "self_field"
    drives = ("self_field.multiplier",)

    def __post_init__(self) -> None:
        if self.history is not None:
            numbers(self.history, self.name)

    @property
    def stages(self) -> int:
        return 1 if self.history is None else len(self.history)

    def ends(self, stages: int) -> FloatArray:
        amounts = np.zeros((stages + 1, 1))
        amounts[1:, 0] = amplitudes(self.history, stages, self.name)
        return amounts

    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        return _nothing(len(points), second)

    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        return _nothing(len(points), False)


def _nothing(count: int, second: bool) -> Values:
    derivatives = np.zeros((count, 3, 3, 3)) if second else None
    return Values(np.zeros((count, 3)), np.zeros((count, 3, 3)), derivatives)


def own_multiplier(field: Field, amounts: FloatArray) -> float:
    """Multiplier of the body's own field for amounts of a field, or their rate; 0 where it is no part of it."""
    return sum(float(own[0]) for part, own in field.parts(amounts) if isinstance(part, SelfField))


def has_own(field: Field) -> bool:
    """Whether the body's own field is a part of a field.

    Raises
    ------
    InputError
        It is more than once.
    """
    parts = field.parts(np.zeros(len(field.drives)))
    count = sum(isinstance(part, SelfField) for part, _ in parts)
    if count > 1:
        raise InputError(f"{SelfField.name}: the body's own field is {count} times part of the field; once is enough")
    return count == 1
