r"""Supports by name, and what each of them takes of the forces on what is held.

Supports of one name are one: what holds a gripper's foot may be written as several supports. At a node, a support
can exert forces in the directions that it holds, V. Where two supports hold the same direction of a node, their
shares cannot be told apart; the first takes it, so that nothing counts twice. With W_1 = V_1 and W_k the
part of V_k normal to what V_k has in common with W_1 + … + W_{k-1}, a force in the sum of all V is the sum of one
force in each W_k, uniquely:

    r = Σ r_k,      r_k = S_k r ∈ W_k.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray, three_finite
from magshell.errors import InputError
from magshell.model.loads.distribution import centroid_weights
from magshell.model.places import Places
from magshell.model.shell import Shell
from magshell.model.support import Support

FIELDS = ("u", "w", "omega")
# Sine of the angle between directions that are one.
SAME = 1e-9


class NamedSupport(NamedTuple):
    """The supports of one name.

    Attributes
    ----------
    name : str
    nodes : ndarray, shape (n,)
        Nodes, or places of rigid bodies, that are held.
    weights : ndarray, shape (places,)
        The mean of the places' positions with these is the centroid.
    point : ndarray, shape (3,), or None
        About which the moment of the reaction is given, m; None: the centroid.
    shares : mapping of str to (n, 3, 3) ndarray
        For u, w and omega, the matrices S that take from the forces on what is held at its nodes what it exerts.
    """

    name: str
    nodes: IntArray
    weights: FloatArray
    point: FloatArray | None
    shares: Mapping[str, FloatArray]


def name_of(support: Support) -> str:
    """The name of a support's reaction."""
    return support.group if support.name is None else support.name


def named_supports(shell: Shell, places: Places, supports: Sequence[Support]) -> tuple[NamedSupport, ...]:
    """Supports by name, in the order in which the names first appear.

    Raises
    ------
    InputError
        A name is no text, a point is no point, or the supports of one name have different points.
    """
    by_name: dict[str, list[Support]] = {}
    for support in supports:
        name = name_of(support)
        if not isinstance(name, str) or not name.strip():
            raise InputError(f"support on '{support.group}': name is {name!r}; it must be a text")
        by_name.setdefault(name, []).append(support)
    held = {name: _directions(places, own) for name, own in by_name.items()}
    shares = _shares(list(held.values()))
    found = []
    for name, own, share in zip(by_name, by_name.values(), shares, strict=True):
        nodes = np.unique(np.concatenate([_roots(places, support.group) for support in own]))
        matrices = {field: np.zeros((len(nodes), 3, 3)) for field in FIELDS}
        for (node, field), matrix in share.items():
            matrices[field][np.searchsorted(nodes, node)] = matrix
        groups = list(dict.fromkeys(support.group for support in own))
        found.append(NamedSupport(name, nodes, _centroid(shell, places, groups), _point(name, own), matrices))
    return tuple(found)


def _roots(places: Places, group: str) -> IntArray:
    """Places of a group; of nodes that are images of others, these."""
    members = places.named(group)
    if places.images is None or members[0] >= len(places.images.root):
        return members
    return np.asarray(places.images.root[members])


def _centroid(shell: Shell, places: Places, groups: Sequence[str]) -> FloatArray:
    """Weights (places,) whose mean of positions is the centroid: of rigid bodies that of their reference points."""
    weights = np.zeros(places.number)
    bodies = [places.named(group)[0] for group in groups if places.is_body(group)]
    if bodies:
        weights[bodies] = 1.0 / len(bodies)
    else:
        weights[: len(shell.mesh.points)] = centroid_weights(shell, groups)
    return weights


def _point(name: str, supports: Sequence[Support]) -> FloatArray | None:
    """The point that supports of one name give."""
    points = []
    for support in supports:
        if support.point is None:
            continue
        point = three_finite(support.point)
        if point is None:
            raise InputError(f"support on '{support.group}': point is {support.point!r}; it needs 3 finite coordinates")
        points.append(point)
    if any(np.any(point != points[0]) for point in points):
        raise InputError(f"supports: those named '{name}' have different points, but one reaction; give one point")
    return points[0] if points else None


def _directions(places: Places, supports: Sequence[Support]) -> dict[tuple[int, str], FloatArray]:
    """By node and field, the directions (m, 3) that supports hold."""
    found: dict[tuple[int, str], list[FloatArray]] = {}
    for support in supports:
        for condition in support.conditions():
            if condition.field not in FIELDS:
                continue
            members = places.named(condition.group)
            for place, direction in places.rooted(condition, members[places.carriers[condition.field][members]]):
                found.setdefault((place, condition.field), []).append(direction)
    return {place: np.array(directions) for place, directions in found.items()}


def _shares(held: Sequence[Mapping[tuple[int, str], FloatArray]]) -> list[dict[tuple[int, str], FloatArray]]:
    """By node and field, the matrix S of each support."""
    shares: list[dict[tuple[int, str], FloatArray]] = [{} for _ in held]
    alone = np.eye(3)
    for place in {place: None for one in held for place in one}:
        holders = [number for number, one in enumerate(held) if place in one]
        parts = [alone] if len(holders) == 1 else split([held[number][place] for number in holders])
        for number, part in zip(holders, parts, strict=True):
            shares[number][place] = part
    return shares


def split(directions: Sequence[FloatArray]) -> list[FloatArray]:
    """The matrices S (3, 3) of supports that hold these directions (m, 3) of one node."""
    taken, own = np.zeros((0, 3)), []
    for one in directions:
        base = _base(one)
        left, sines, _ = np.linalg.svd(base - base @ taken.T @ taken)
        own.append(left[:, : len(sines)][:, sines > SAME].T @ base)
        taken = _base(np.concatenate([taken, own[-1]]))
    dual = np.linalg.pinv(np.concatenate(own).T)
    first = np.cumsum([0, *map(len, own)])
    return [part.T @ dual[start : start + len(part)] for part, start in zip(own, first[:-1], strict=True)]


def _base(directions: FloatArray) -> FloatArray:
    """Orthonormal base (k, 3) of the space of some directions."""
    _, singular, base = np.linalg.svd(directions, full_matrices=False)
    return np.asarray(base[singular > SAME * singular.max(initial=1.0)])
