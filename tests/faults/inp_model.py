"""What an input file holds, in a form in which two readings can be compared."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from magshell.mesh.files.assembling import _stacked
from magshell.mesh.files.contents import Contents

T = TypeVar("T")
Member = tuple[str, int]
"""Instance (empty: the assembly) and number."""
CORNERS = {"S3": 3, "S4": 4, "S6": 3, "STRI65": 3, "S8R": 4, "CPS4": 4, "CPS6": 3, "CPS8": 4}
"""Types of surface elements: how many corners they have."""
NODES = {
    "S3": 3,
    "S4": 4,
    "S6": 6,
    "STRI65": 6,
    "S8R": 8,
    "CPS4": 4,
    "CPS6": 6,
    "CPS8": 8,
    "T3D2": 2,
    "T3D3": 3,
    "MASS": 1,
}


@dataclass
class Named:
    """A set or a surface of a scope."""

    scope: str
    shown: str
    members: set[Member] = field(default_factory=set)


@dataclass
class Model:
    """Nodes and elements by instance and number; sets by scope and label, in the order of the file."""

    scopes: list[str] = field(default_factory=list)
    """Names of the instances in order; the assembly comes last."""
    nodes: dict[Member, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[Member, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    node_sets: dict[tuple[str, str], Named] = field(default_factory=dict)
    element_sets: dict[tuple[str, str], Named] = field(default_factory=dict)
    edges: dict[tuple[str, str], tuple[str, set[tuple[str, int, int]]]] = field(default_factory=dict)
    """Surfaces: as shown, and instance, element and side (from 0) of each edge."""

    def order(self, of: Iterable[Member]) -> dict[Member, int]:
        """Place of each in the mesh."""
        rank = {name: place for place, name in enumerate([*self.scopes, ""])}
        return {member: place for place, member in enumerate(sorted(of, key=lambda each: (rank[each[0]], each[1])))}

    def described(self) -> Description:
        """The same as the mesh must be."""
        place = self.order(self.nodes)
        surface = {member: each for member, each in self.elements.items() if each[0] in CORNERS}
        lines = {member: each for member, each in self.elements.items() if each[0] in ("T3D2", "T3D3")}
        number = self.order(surface)

        def at(member: Member, local: int) -> int:
            return place[member[0], self.elements[member][1][local]]

        def ends(member: Member, side: int) -> frozenset[int]:
            corners = CORNERS[self.elements[member][0]]
            return frozenset((at(member, side), at(member, (side + 1) % corners)))

        edges = {
            name: {ends((owner, element), side) for owner, element, side in chosen}
            for name, chosen in _shown({key: (key[0], shown, each) for key, (shown, each) in self.edges.items()})
        }
        sets = [
            (name, chosen)
            for name, chosen in _shown({k: (k[0], each.shown, each.members) for k, each in self.element_sets.items()})
        ]
        for name, chosen in sets:
            found = {frozenset((at(each, 0), at(each, len(lines[each][1]) - 1))) for each in chosen if each in lines}
            if found:
                edges[name] = found
        return Description(
            np.array([self.nodes[member] for member in place]).reshape(-1, 3),
            [tuple(place[member[0], node] for node in surface[member][1]) for member in number],
            {
                name: {place[each] for each in chosen if each in place}
                for name, chosen in _shown({k: (k[0], each.shown, each.members) for k, each in self.node_sets.items()})
            },
            {name: found for name, chosen in sets if (found := {number[each] for each in chosen if each in number})},
            edges,
        )


def _shown(named: Mapping[tuple[str, str], tuple[str, str, T]]) -> list[tuple[str, T]]:
    """Names of the groups: plain in the assembly and where no other scope has it."""
    count = Counter(_plain(shown) for _, shown, _ in named.values())
    return [
        (shown if not scope or count[_plain(shown)] == 1 else f"{scope}.{shown}", members)
        for scope, shown, members in named.values()
    ]


def _plain(shown: str) -> str:
    return shown.replace(" ", "").upper()


@dataclass
class Description:
    """A mesh by places: points, rows of elements, groups."""

    points: np.ndarray
    elements: list[tuple[int, ...]]
    node_groups: dict[str, set[int]]
    element_groups: dict[str, set[int]]
    edge_groups: dict[str, set[frozenset[int]]]


def of_contents(contents: Contents) -> Description:
    """What magshell has read."""
    rows, element_groups = _stacked(contents, 2, 8)
    lines, edge_groups = _stacked(contents, 1, 3)
    return Description(
        contents.points,
        [_as_in_the_file(row.tolist()) for row in rows],
        {name: set(members.tolist()) for name, members in contents.node_groups.items()},
        {name: set(members.tolist()) for name, members in element_groups.items()},
        {name: {frozenset(lines[line, :2].tolist()) for line in members} for name, members in edge_groups.items()},
    )


def _as_in_the_file(row: list[int]) -> tuple[int, ...]:
    """Corners, then the middles there are."""
    corners, middles = row[:4], row[4:]
    if row[2] == row[3]:
        corners, middles = row[:3], [row[4], row[5], row[7]]
    return (*corners, *(node for node in middles if node >= 0))


def assert_same(found: Description, true: Description) -> None:
    """Fail where two readings differ; positions to round-off."""
    assert found.points.shape == true.points.shape
    assert np.allclose(found.points, true.points, rtol=1e-9, atol=1e-9 * max(1.0, np.abs(true.points).max(initial=0.0)))
    assert found.elements == true.elements
    assert found.node_groups == true.node_groups
    assert found.element_groups == true.element_groups
    assert found.edge_groups == true.edge_groups
