"""What a load is: as a user writes it, and resolved on the mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Protocol

from magshell.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from magshell.model import Shell
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
        """What it adds to the tangent of internal minus external forces at the pairs: (n, 3, 3), global axes.

        Rotations are differentiated in the chart ϑ -> exp(ϑ) R̃ of the elements. There the force of a couple c is
        T(ϑ)ᵀ c with δω = T δϑ, T = I + [ϑ]×/2 + …: the couple takes off its derivative dc/dϑ, and [c]×/2. For a dead
        couple this leaves -[c]×/2, for one that turns with R̃, where dc = ϑ × c, it leaves +[c]×/2.

        The residual T(ϑ)ᵀ r that this belongs to vanishes with r, so it holds where all three rotations of a node are
        free. Where some are held, its rows of free rotations have a part of the reaction in them, [r]×/2 of the
        tangent. It couples two free rotations only where exactly one is held; the loops over elements take it off
        there, for all of their couples, those which balance the load included. So at such a node [c]×/2 must be added
        to the block of a couple c (nothing then is left of a dead one).
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
