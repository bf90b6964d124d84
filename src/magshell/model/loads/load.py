"""What a load is: as a user writes it, and resolved on the mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Protocol

from magshell.arrays import FloatArray, IntArray
from magshell.model.shell import Shell
from magshell.shell.state import State


class Pairs(NamedTuple):
    """Places of 3 × 3 blocks of the tangent.

    Attributes
    ----------
    row_field, column_field : {"u", "w", "omega"}
        Fields of the forces and of the increments.
    rows, columns : ndarray, shape (n,)
        Their nodes.
    """

    row_field: str
    column_field: str
    rows: IntArray
    columns: IntArray


class Applied(Protocol):
    """A load on a mesh, at amplitude 1."""

    @property
    def conservative(self) -> bool:
        """Whether its work depends on the states at both ends only, whatever holds the shell."""

    @property
    def pairs(self) -> Pairs | None:
        """Where its tangent is; None: it has none."""

    def forces(self, state: State) -> FloatArray:
        """Its forces (nodes, 10) in global axes: N on u, N m on w (which is a number), N m on the spin."""

    def stiffness(self, state: State) -> FloatArray:
        """Minus the derivative of the forces with respect to the increments at the pairs: (n, 3, 3), global axes.

        Rotations move by spins ϑ, R̃ -> exp(ϑ) R̃, and couples are those on the spins of the new state: a dead couple
        has no derivative. That elements differentiate otherwise is the equations' affair (`magshell.equations`).
        """


class Load(Protocol):
    """A load as a user writes it."""

    kind: ClassVar[str]

    @property
    def group(self) -> str | None:
        """Group of nodes, edges or elements; None, where a load allows it: the whole shell."""

    @property
    def history(self) -> Sequence[float] | None:
        """Multiplier at the end of each stage; None: 1 at the end of the first and from then on."""

    def applied(self, shell: Shell, normals: FloatArray) -> Applied:
        """The load on the mesh of a shell, with its unit normals (nodes, 3) at the nodes.

        Raises
        ------
        InputError
            Unknown group, values that are no finite numbers or zero, something that the shell lacks.
        """
