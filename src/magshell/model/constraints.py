"""Supports resolved: fixed components of nodes and rigid bodies, in frames where directions are oblique."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.places import Places
from magshell.model.support import Condition, Support, frame_about
from magshell.model.supports import SymmetryPlane
from magshell.multipliers import amplitudes
from magshell.shell.unknowns import COLUMNS, COMPONENTS

Supports: TypeAlias = Sequence[Support]


class Constraints(NamedTuple):
    """The resolved supports, by node and by column of the nodal arrays (see `magshell.shell.unknowns`).

    Attributes
    ----------
    fixed : ndarray of bool, shape (nodes, 11)
        In the node's frame.
    values : ndarray, shape (stages, nodes, 11)
        At the end of each stage, in the node's frame.
    frame_of : ndarray, shape (nodes, 3)
        Frame of u, w and ω, -1 for the global axes.
    frames : ndarray, shape (frames, 3, 3)
        Rows are base vectors.
    """

    fixed: AnyBool
    values: FloatArray
    frame_of: IntArray
    frames: FloatArray


AnyBool: TypeAlias = np.typing.NDArray[np.bool_]
FRAME_OF_FIELD = {"u": 0, "w": 1, "omega": 2}


def resolve(places: Places, supports: Supports, stages: int = 1) -> Constraints:
    """Conditions of all supports as fixed components, with frames of their own where directions are oblique.

    Parameters
    ----------
    places : Places
    supports : sequence of Support
    stages : int
        Of the path.

    Raises
    ------
    InputError
        Unknown group, a field that a node does not carry, supports that contradict each other, a support on a node of a
        rigid body, a history of a wrong length.
    """
    nodes, carriers, owner = places.number, places.carriers, places.owner
    fixed, values = np.zeros((nodes, COMPONENTS), dtype=bool), np.zeros((stages, nodes, COMPONENTS))
    frame_of = np.full((nodes, 3), -1)
    frames: list[FloatArray] = []
    directions: dict[tuple[int, str], list[tuple[FloatArray, FloatArray, str]]] = {}
    for support in supports:
        for condition in support.conditions():
            members = places.named(condition.group)
            if condition.field != "phi" and not places.is_body(condition.group):
                members = _off_bodies(places, owner, members, support, supports)
            if condition.field != "u":
                carries = carriers[condition.field][members]
                if not condition.optional:
                    _check_carried(places, members, condition)
                members = members[carries]
            value = condition.value * amplitudes(condition.history, stages, f"support on '{condition.group}'")
            for place, direction in places.rooted(condition, members):
                directions.setdefault((place, condition.field), []).append((direction, value, condition.group))
            for jump in places.level_jumps(condition, members).tolist():
                directions.setdefault((jump, "u"), []).append((condition.direction, 0.0 * value, condition.group))
    for place, field, direction in _on_axes(places):
        directions.setdefault((place, field), []).append((direction, np.zeros(stages), "the axis of repetition"))
    for (node, field), wanted in directions.items():
        column = COLUMNS[field].start
        base, held = _orthonormal(places.words(node), field, wanted)
        if field == "phi":
            fixed[node, column], values[:, node, column] = True, held[0]
        elif np.all(np.max(np.abs(base), axis=1) > 1.0 - 1e-12):
            for vector, one in zip(base, held, strict=True):
                axis = int(np.argmax(np.abs(vector)))
                fixed[node, column + axis], values[:, node, column + axis] = True, one * np.sign(vector[axis])
        else:
            frame_of[node, FRAME_OF_FIELD[field]] = len(frames)
            complement = np.linalg.svd(base)[2][len(base) :]
            frames.append(np.vstack([base, complement]))
            fixed[node, column : column + len(base)] = True
            values[:, node, column : column + len(base)] = held.T
    return Constraints(fixed, values, frame_of, np.array(frames).reshape(-1, 3, 3))


def _on_axes(places: Places) -> Iterator[tuple[int, str, FloatArray]]:
    """Place, field and direction of what vanishes at nodes on an axis of rotation that repeats the shell."""
    if places.images is None:
        return
    for node, axis in zip(places.images.on_axis.tolist(), places.images.axes, strict=True):
        for field in FRAME_OF_FIELD:
            if places.carriers[field][node]:
                yield from ((node, field, direction) for direction in frame_about(axis)[1:])


def _off_bodies(places: Places, owner: IntArray, members: IntArray, support: Support, supports: Supports) -> IntArray:
    """Nodes of a support, but for those on mirror planes of rigid bodies that a like support holds."""
    inside = owner[members[members < len(owner)]]
    if not np.any(inside >= 0):
        return members
    for place in np.unique(inside[inside >= 0]):
        body = places.bodies[place - len(owner)]
        if not any(
            isinstance(one, SymmetryPlane) and one.is_like(support) for one in supports if one.group == body.name
        ):
            node = members[np.argmax(inside == place)]
            raise InputError(
                f"support on '{support.group}': node {node} belongs to {body.label}, whose nodes move as one; hold "
                f'the body, by its name: group = "{body.name}"'
            )
    return members[inside < 0]


def _check_carried(places: Places, members: IntArray, condition: Condition) -> None:
    """Refuse a field that no node of a support carries, or the director where a rotation carries it."""
    field, where = condition.field, f"support on '{condition.group}'"
    carries = places.carriers[field][members]
    at_joints = members[~carries & places.carriers["omega"][members]] if field == "w" else members[:0]
    if carries.any() and not at_joints.size:
        return
    if members[0] >= len(places.mesh.points):
        body = places.carriers["omega"][members[0]]
        carried = "a rigid body has no '{}', only u and omega" if body else "a jump has no '{}', only u"
        raise InputError(f"{where}: {carried.format(field)}")
    if not places.carriers[field].any():
        raise InputError(f"{where}: no node of this shell carries '{field}'")
    if at_joints.size:
        raise InputError(
            f"{where}: node {at_joints[0]} is at a joint, whose directors turn with omega, and does not carry "
            f"'{field}'; hold omega"
        )
    raise InputError(f"{where}: node {members[0]} is a mid-side node and does not carry '{field}'")


def _orthonormal(
    where: str, field: str, wanted: list[tuple[FloatArray, FloatArray, str]]
) -> tuple[FloatArray, FloatArray]:
    """Orthonormal directions and their values, by stage, equivalent to all conditions of one node's field."""
    base: list[FloatArray] = []
    values: list[FloatArray] = []
    for direction, wanted_value, group in wanted:
        rest: FloatArray = direction.copy()
        left = wanted_value
        for known, held in zip(base, values, strict=True):
            rest = rest - (direction @ known) * known
            left = left - float(direction @ known) * held
        length = float(np.linalg.norm(rest))
        if length > 1e-9:
            base.append(rest / length)
            values.append(left / length)
        elif np.abs(left).max() > 1e-9 * max(np.abs(one).max() for one in (wanted_value, *values)):
            others = sorted({other for _, _, other in wanted} - {group})
            raise InputError(
                f"supports: they contradict each other at {where}: '{group}' wants another {field} than "
                + (f"'{others[0]}'" if others else "an earlier support on the same group")
            )
    return np.array(base), np.array(values)
