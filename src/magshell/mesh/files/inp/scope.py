"""What a part, an instance of one or the assembly holds; its names and numbers are its own."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.mesh.files.cells import Kind
from magshell.mesh.files.inp.frames import Frame

Numbers = IntArray | range


@dataclass(frozen=True)
class Nodes:
    """Nodes of a block."""

    numbers: IntArray
    points: FloatArray
    """(n, 3), in the frame of the scope."""
    lines: IntArray


@dataclass(frozen=True)
class Elements:
    """Elements of a block, all of one kind."""

    type_name: str
    kind: Kind
    numbers: IntArray
    nodes: IntArray
    """(n, nodes of the kind): their numbers."""
    lines: IntArray

    def nodes_of(self, rows: IntArray) -> IntArray:
        """Numbers of all nodes of some of the elements."""
        return np.unique(self.nodes[rows])


@dataclass(frozen=True)
class Skipped:
    """Elements that are no surface and no line: springs, masses, connectors."""

    type_name: str
    numbers: IntArray
    nodes: list[list[int]]
    """Of each."""
    lines: IntArray

    def nodes_of(self, rows: IntArray) -> IntArray:
        """Numbers of all nodes of some of the elements."""
        return np.unique([node for row in rows for node in self.nodes[row]]).astype(np.int64)


@dataclass
class NamedSet:
    """A set of nodes or of elements."""

    name: str
    """As the file writes it first."""
    pieces: dict[tuple[str, int], Numbers] = field(default_factory=dict)
    """What it is made of; the key begins with the instance whose numbers these are ("": the set's own scope)."""
    unsorted: bool = False

    def add(self, numbers: Numbers, instance: str = "") -> None:
        """Add numbers of an instance."""
        self.pieces[instance, id(numbers)] = numbers

    def members(self) -> list[tuple[str, Numbers]]:
        """Pairs of an instance and numbers in it; few, so that sets of sets of sets stay small."""
        if len(self.pieces) > 1 and not self.unsorted:
            joined: dict[str, list[IntArray]] = {}
            ranges = {}
            for (instance, identity), numbers in self.pieces.items():
                if isinstance(numbers, range):
                    ranges[instance, identity] = numbers
                else:
                    joined.setdefault(instance, []).append(numbers)
            self.pieces = dict(ranges)
            for instance, each in joined.items():
                self.add(np.unique(np.concatenate(each)) if len(each) > 1 else each[0], instance)
        return [(instance, numbers) for (instance, _), numbers in self.pieces.items()]


@dataclass
class Surface:
    """A named surface: sets or single members of the scope, each with a face or an edge of its elements."""

    name: str
    of_nodes: bool
    members: list[tuple[str, str, int]] = field(default_factory=list)
    """Label or number, face, line."""


@dataclass
class Scope:
    """A part, an instance or the assembly."""

    name: str
    nodes: list[Nodes] = field(default_factory=list)
    elements: list[Elements] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    node_sets: dict[str, NamedSet] = field(default_factory=dict)
    element_sets: dict[str, NamedSet] = field(default_factory=dict)
    surfaces: dict[str, Surface] = field(default_factory=dict)
    solids: int = 0
    """How many elements have a volume."""
    unknown: dict[str, int] = field(default_factory=dict)
    """Types that may be surfaces and are not read, and how many elements they have."""
    generated: int = 0
    """How many nodes and elements were made of others."""
    frame: Frame | None = None
    """Of the coordinates that are read next."""
    _positions: dict[int, FloatArray] = field(default_factory=dict)
    _indexed: int = 0
    """How many blocks of nodes are in `_positions`."""
    _rows: dict[int, tuple[Elements, int]] = field(default_factory=dict)
    _blocks: int = 0
    """How many blocks of elements are in `_rows`."""

    def instance(self, name: str) -> Scope:
        """An instance of this part: what is added to it does not change the part."""

        def copied(sets: dict[str, NamedSet]) -> dict[str, NamedSet]:
            return {key: NamedSet(each.name, dict(each.pieces), each.unsorted) for key, each in sets.items()}

        return Scope(
            name,
            list(self.nodes),
            list(self.elements),
            list(self.skipped),
            copied(self.node_sets),
            copied(self.element_sets),
            {key: Surface(each.name, each.of_nodes, list(each.members)) for key, each in self.surfaces.items()},
            self.solids,
            dict(self.unknown),
        )

    @property
    def every(self) -> list[Elements | Skipped]:
        """All blocks of elements with their numbers."""
        return [*self.elements, *self.skipped]

    def position(self, node: int) -> FloatArray | None:
        """Where a node is, if it is there."""
        for block in self.nodes[self._indexed :]:
            self._positions.update(zip(block.numbers.tolist(), block.points, strict=True))
        self._indexed = len(self.nodes)
        return self._positions.get(node)

    def row_of(self, element: int) -> tuple[Elements, int] | None:
        """The block and the row of an element, if it is there and a surface or a line."""
        for block in self.elements[self._blocks :]:
            self._rows.update((number, (block, row)) for row, number in enumerate(block.numbers.tolist()))
        self._blocks = len(self.elements)
        return self._rows.get(element)

    def nodes_of(self, elements: Numbers) -> IntArray:
        """Numbers of all nodes of some elements."""
        found = [np.zeros(0, dtype=np.int64)]
        for block in self.every:
            rows = np.flatnonzero(contains(elements, block.numbers))
            found.append(block.nodes_of(rows))
        return np.unique(np.concatenate(found))


def contains(numbers: Numbers, wanted: IntArray) -> AnyArray:
    """Which of `wanted` are among the numbers."""
    if isinstance(numbers, range):
        inside = (wanted >= numbers.start) & (wanted < numbers.stop)
        return np.asarray(inside & ((wanted - numbers.start) % numbers.step == 0))
    return np.isin(wanted, numbers)


def flat(sets: NamedSet) -> IntArray:
    """Numbers of a set of its own scope: in rising order, each once, unless the file asks for its own order."""
    parts = [np.asarray(numbers, dtype=np.int64) for numbers in sets.pieces.values()]
    joined = np.concatenate([np.zeros(0, dtype=np.int64), *parts])
    if not sets.unsorted:
        return np.unique(joined)
    first = np.unique(joined, return_index=True)[1]
    return joined[np.sort(first)]
