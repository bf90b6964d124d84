"""Contents of a file: points, elements of all kinds and groups, before they become a mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.files.cells import Kind

GROUPED = ("point", "curve", "surface")
"""What the elements of dimension 0, 1 and 2 of a group without a name are called."""


@dataclass(frozen=True)
class Block:
    """Elements of one kind."""

    kind: Kind
    numbers: IntArray
    """(k,) their numbers in the file."""
    nodes: IntArray
    """(k, nodes of the kind): rows of `Contents.points`."""
    groups: Mapping[str, IntArray] = field(default_factory=dict)
    """Rows of the block, by group."""


@dataclass(frozen=True)
class Contents:
    """A file's nodes, elements and groups, in the file's own unit of length."""

    points: FloatArray
    """(nodes, 3), in the order of the nodes' numbers."""
    blocks: list[Block]
    node_groups: Mapping[str, IntArray] = field(default_factory=dict)
    """Rows of `points`; groups of points that are elements stand in the blocks instead."""
    solids: int = 0
    """How many elements have a volume."""
    unread: Mapping[str, int] = field(default_factory=dict)
    """Elements that are or may be pieces of the surface but cannot be used: how many, by the file's name of their type.
    A mesh without them would have holes, so that one with any is refused."""
    unit: str | None = None
    """Unit of length, where the file says it."""
    notes: tuple[str, ...] = ()
    """What the reader left out."""
    order: tuple[str, ...] = ()
    """Names of groups in the order in which they are to stand; others come behind."""


def in_order(numbers: IntArray, points: FloatArray, twice: Callable[[int], NoReturn]) -> tuple[IntArray, FloatArray]:
    """Nodes by rising number; `twice` is told the place (in `numbers`) of one that is given a second time."""
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    same = np.flatnonzero(ordered[1:] == ordered[:-1])
    if same.size:
        twice(int(order[same[0] + 1]))
    return ordered, points[order]


def places(known: IntArray, wanted: IntArray, missing: Callable[[int, int], NoReturn]) -> IntArray:
    """Where the numbers `wanted`, of any shape, stand in `known`, which rises.

    `missing` is told the row of one that does not, and the number.
    """
    found = np.searchsorted(known, wanted).clip(max=max(len(known) - 1, 0))
    absent = known[found] != wanted if len(known) else np.ones(wanted.shape, dtype=bool)
    if absent.any():
        first = np.argwhere(absent)[0]
        missing(int(first[0]), int(wanted[tuple(first)]))
    return found
