"""What a load is: as a user writes it, and resolved on the mesh.

A load is a frozen dataclass that inherits from `Load`. Its file has everything about it: the keys of its table
in problem files, what `magshell check` prints, how it is drawn. Defaults follow from its forces.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.mesh.geometry import centres, unit
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.multipliers import numbers
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS
from magshell.units import FORCE, MOMENT, Dimension, show
from magshell.wording import counted, quantity


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
        """True if the load has a potential under any supports."""

    @property
    def pairs(self) -> Sequence[Pairs]:
        """Where its tangent is; a dead load has none."""

    def forces(self, state: State) -> FloatArray:
        """Its forces (nodes, 11) in global axes: N on u, N m on w (which is a number), N m on the spin."""

    def stiffness(self, state: State) -> Sequence[FloatArray]:
        """Minus the derivative of the forces over the increments, for each of `pairs` (n, 3, 3), global axes.

        Rotations move by spins ϑ, R̃ -> exp(ϑ) R̃, and couples are those on the spins of the new state: a constant
        couple has no derivative. Elements differentiate otherwise, which `magshell.equations` takes into account.
        """


class Size(NamedTuple):
    """How large a load is at multiplier 1, for the dimensionless numbers of `magshell check`.

    Attributes
    ----------
    force : float
        Of forces and tractions, N.
    moment : float
        N m.
    weight : float
        N.
    pressure : float
        Pa.
    """

    force: float = 0.0
    moment: float = 0.0
    weight: float = 0.0
    pressure: float = 0.0


class Arrows(NamedTuple):
    """A load in pictures.

    Attributes
    ----------
    places, vectors : ndarray, shape (n, 3)
        Positions, m, and arrows of any length; of many, some are drawn.
    name : str
        In the legend.
    """

    places: FloatArray
    vectors: FloatArray
    name: str


class Load(ABC):
    """A load as a user writes it.

    Attributes
    ----------
    kind : str
        Its name in problem files and messages.
    keys : mapping of str to Key
        Its parameters.
    amount : (str, Dimension)
        The parameter, a number or a vector, that says how large it is.
    letter : str
        At its arrow in pictures.
    on : {"nodes", "elements"}
        What its group is made of: nodes (those of a group of any kind) or elements.
    axial : bool
        Whether `amount` is a moment, whose mirror image is reversed.
    group : str or None
        Group of nodes, edges or elements; None, where a load allows it: the whole shell.
    history : sequence of float or None
        Multiplier at the end of each stage; None: 1 at the end of the first and from then on.
    """

    kind: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]
    amount: ClassVar[tuple[str, Dimension]]
    letter: ClassVar[str] = ""
    on: ClassVar[Literal["nodes", "elements"]] = "nodes"
    axial: ClassVar[bool] = False

    group: str | None
    history: Sequence[float] | None

    def __post_init__(self) -> None:
        if self.history is not None:
            object.__setattr__(self, "history", tuple(numbers(self.history, self.label).tolist()))

    @abstractmethod
    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on the nodal arrays of a shell.

        Raises
        ------
        InputError
            Unknown group, values that are no finite numbers or zero, something that the shell lacks.
        """

    def words(self, shell: Shell, forces: FloatArray) -> str:
        """The load in `magshell check`, given its forces (nodes, 11) on the undeformed shell."""
        text = f"{self.given}, {self.extent(shell)}"
        for field, dimension in (("u", FORCE), ("omega", MOMENT)):
            if np.any(forces[:, COLUMNS[field]]):
                text += f", in all {quantity(resultant(forces, field), dimension)}"
        return text

    def size(self, forces: FloatArray) -> Size:
        """How large it is, given its forces on the undeformed shell."""
        moments = forces[:, COLUMNS["w"]] + forces[:, COLUMNS["omega"]]
        on_u, turning = (float(np.linalg.norm(part, axis=1).sum()) for part in (forces[:, COLUMNS["u"]], moments))
        return Size(force=on_u, moment=turning)

    def arrows(self, shell: Shell, forces: FloatArray) -> Arrows:
        """Its arrows, given its forces on the undeformed shell."""
        name = f"{self.group or 'whole shell'}: {self.kind}, {self.magnitude}"
        points, members = shell.mesh.points, self.members(shell)
        if self.vector is None:
            fields = (forces[:, COLUMNS[field]] for field in ("u", "omega", "w"))
            drawn = next((part for part in fields if np.any(part)), np.zeros_like(points))
            nodes = np.flatnonzero(np.any(drawn, axis=1))
            return Arrows(points[nodes], unit(drawn[nodes]), name)
        if self.on == "nodes":
            return Arrows(amid(points[members]), self.vector[None], name)
        middles = centres(points, shell.mesh.elements[members])
        return Arrows(middles, np.tile(self.vector, (len(middles), 1)), name)

    def beyond(self, at_nodes: bool, at_elements: bool) -> str:
        """What a vector that is not its own image does at a mirror plane; empty: nothing.

        Parameters
        ----------
        at_nodes, at_elements : bool
            Whether its group, of nodes or edges or else of elements, touches the plane.
        """
        if at_nodes:
            return "its support takes what is normal to it"
        return "beyond it acts the image, with the component along the normal reversed" if at_elements else ""

    @property
    def label(self) -> str:
        """Its name in messages."""
        return f"loads: {self.kind}" + ("" if self.group is None else f" on '{self.group}'")

    @contextmanager
    def located(self) -> Iterator[None]:
        """Prefix every input error of the block with the load."""
        try:
            yield
        except InputError as error:
            raise InputError(f"{self.label}: {error}") from None

    @property
    def value(self) -> tuple[float, ...]:
        """The components of its amount, SI."""
        return tuple(np.atleast_1d(np.asarray(getattr(self, self.amount[0]), dtype=float)).tolist())

    @property
    def vector(self) -> FloatArray | None:
        """Its amount where that is a vector (3,)."""
        return np.array(self.value) if len(self.value) == 3 else None

    @property
    def magnitude(self) -> str:
        """The size of its amount, in words."""
        return show(float(np.linalg.norm(self.value)), self.amount[1])

    @property
    def given(self) -> str:
        """Kind and amount, in words."""
        return f"{self.kind} {quantity(self.value if len(self.value) > 1 else self.value[0], self.amount[1])}"

    def members(self, shell: Shell) -> IntArray:
        """The nodes or elements that it acts on.

        Raises
        ------
        InputError
            Unknown group, or one without elements where they are needed.
        """
        mesh = shell.mesh
        if self.group is None:
            return np.arange(len(mesh.points if self.on == "nodes" else mesh.elements))
        return shell.nodes_of(self.group) if self.on == "nodes" else mesh.elements_of(self.group)

    def extent(self, shell: Shell) -> str:
        """How many nodes or elements it acts on, in words."""
        return counted(len(self.members(shell)), "node" if self.on == "nodes" else "element")


def resultant(forces: FloatArray, field: str = "u") -> tuple[float, ...]:
    """Sum (3,) of nodal forces (nodes, 11) on a field, without the round-off of components that are meant to be 0."""
    total = forces[:, COLUMNS[field]].sum(axis=0)
    return tuple(np.where(np.abs(total) > 1e-9 * np.abs(total).max(), total, 0.0).tolist())


def amid(points: FloatArray) -> FloatArray:
    """The one (1, 3) of some points (n, 3) that is nearest to their middle."""
    return points[np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1))][None]
