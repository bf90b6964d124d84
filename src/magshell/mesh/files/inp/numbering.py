"""Nodes and elements of a scope by their numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NoReturn

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.files.cells import Kind
from magshell.mesh.files.contents import in_order, places
from magshell.mesh.files.inp.frames import Move
from magshell.mesh.files.inp.scope import Numbers, Scope
from magshell.mesh.files.lines import Lines
from magshell.units import shortened


@dataclass(frozen=True)
class Placed:
    """A scope where it is: an instance, moved, or the assembly."""

    scope: Scope
    move: Move | None = None


@dataclass(frozen=True)
class Rows:
    """All elements of one type in a scope."""

    type_name: str
    kind: Kind
    numbers: IntArray
    nodes: IntArray
    """Rows of all nodes of the mesh."""
    groups: dict[str, IntArray] = field(default_factory=dict)


class Numbered:
    """A scope with its nodes and elements by number."""

    def __init__(self, lines: Lines, placed: Placed, start: int) -> None:
        self.lines, self.scope, self.start = lines, placed.scope, start
        blocks = self.scope.nodes
        where = np.concatenate([np.zeros(0, dtype=np.int64), *(block.lines for block in blocks)])
        numbers = np.concatenate([np.zeros(0, dtype=np.int64), *(block.numbers for block in blocks)])

        def twice(row: int) -> NoReturn:
            lines.fail(int(where[row]), f"node {numbers[row]} is given a second time")

        points = np.concatenate([np.zeros((0, 3)), *(block.points for block in blocks)])
        self.node_numbers, points = in_order(numbers, points, twice)
        self.points: FloatArray = points if placed.move is None else placed.move(points)
        self._refuse_repeated()
        self.rows = [self._rows(name) for name in dict.fromkeys(block.type_name for block in self.scope.elements)]

    def _refuse_repeated(self) -> None:
        blocks = self.scope.every
        if not blocks:
            return
        numbers = np.concatenate([block.numbers for block in blocks])
        where = np.concatenate([block.lines for block in blocks])
        order = np.lexsort((where, numbers))
        same = np.flatnonzero(numbers[order][1:] == numbers[order][:-1])
        if same.size:
            first, second = order[same[0]], order[same[0] + 1]
            self.lines.fail(
                int(where[second]), f"element {numbers[second]} is given a second time; line {where[first] + 1} has it"
            )

    def _rows(self, type_name: str) -> Rows:
        """The elements of a type by number."""
        blocks = [block for block in self.scope.elements if block.type_name == type_name]
        numbers = np.concatenate([block.numbers for block in blocks])
        nodes = np.concatenate([block.nodes for block in blocks])

        def missing(row: int, number: int) -> NoReturn:
            where = np.concatenate([block.lines for block in blocks])
            of = f" of '{shortened(self.scope.name)}'" if self.scope.name else ""
            self.lines.fail(int(where[row]), f"element {numbers[row]} has node {number}, which no *NODE block{of} has")

        found = places(self.node_numbers, nodes, missing)
        order = np.argsort(numbers, kind="stable")
        return Rows(type_name, blocks[0].kind, numbers[order], self.start + found[order])

    @cached_property
    def skipped(self) -> IntArray:
        """Numbers of the elements that are left out, rising."""
        return np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *(each.numbers for each in self.scope.skipped)]))


def distinct(numbers: Numbers) -> Numbers:
    """Each number once, rising. (`numpy.unique` hashes whole numbers, which takes ten times as long.)"""
    if isinstance(numbers, range):
        return numbers
    ordered = np.sort(numbers)
    return ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])] if len(ordered) else ordered


def among(known: IntArray, numbers: Numbers) -> IntArray:
    """Where the numbers that are known stand in `known`; both rise."""
    if isinstance(numbers, range):
        first, last = np.searchsorted(known, [numbers.start, numbers.stop])
        inside = np.arange(first, last)
        return inside[(known[inside] - numbers.start) % numbers.step == 0]
    if not len(known):
        return np.zeros(0, dtype=np.int64)
    found = np.searchsorted(known, numbers).clip(max=len(known) - 1)
    return found[known[found] == numbers]
