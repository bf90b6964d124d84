"""What an elastic support is: as a user writes it, and resolved on the mesh."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import ClassVar, Protocol

from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.model.loads.load import Applied
from magshell.model.places import Places
from magshell.model.shell import Shell
from magshell.shell.state import State


class Elastic(Applied, Protocol):
    """Forces on a mesh that are minus the derivative of an energy."""

    def energy(self, state: State) -> float:
        """J."""


class Anchored(Elastic, Protocol):
    """Springs whose other end is fixed in space."""

    @property
    def weights(self) -> FloatArray:
        """The mean of the places' positions with these (places,) is the centroid."""

    @property
    def about(self) -> FloatArray | None:
        """What the moment of its reaction is about (3,), m; None: the centroid."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ElasticSupport(ABC):
    """Springs as a user writes them: a frozen dataclass that inherits from this class.

    Attributes
    ----------
    kind : str
        Its name in problem files.
    keys : mapping of str to Key
        Its parameters.
    group : str
        What it holds.
    name : str or None
        Of the reaction.
    point : (3,) array_like or None
        Point, fixed in space, that the reaction's moment is about, m.
    """

    kind: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]

    group: str
    name: str | None = None
    point: ArrayLike | None = None

    @abstractmethod
    def applied(self, shell: Shell, places: Places) -> Anchored:
        """The springs on the nodal arrays of a shell.

        Raises
        ------
        InputError
            Unknown group, values that make no sense.
        """

    @abstractmethod
    def words(self, shell: Shell) -> str:
        """The springs in `magshell check`."""

    @property
    @abstractmethod
    def legend(self) -> str:
        """The springs in pictures."""

    @property
    @abstractmethod
    def along(self) -> FloatArray | None:
        """Direction (3,) in which they are drawn; None: none in particular."""

    @property
    def label(self) -> str:
        """Its name in messages."""
        return f"springs on '{self.group}'"

    @contextmanager
    def located(self) -> Iterator[None]:
        """Prefix every input error of the block with the springs."""
        try:
            yield
        except InputError as error:
            raise InputError(f"{self.label}: {error}") from None


def reaction_name(spring: ElasticSupport) -> str:
    """The name of its reaction."""
    return spring.group if spring.name is None else spring.name


def check_names(springs: Sequence[ElasticSupport], taken: Sequence[str]) -> None:
    """Refuse springs whose reactions have no name of their own.

    Raises
    ------
    InputError
        A name is no text, or another support or spring has it.
    """
    known = list(taken)
    for spring in springs:
        name = reaction_name(spring)
        if not isinstance(name, str) or not name.strip():
            raise InputError(f"{spring.label}: name is {name!r}; it must be a text")
        if name in known:
            raise InputError(
                f"{spring.label}: the reaction '{name}' is that of another support; give these springs a name"
            )
        known.append(name)
