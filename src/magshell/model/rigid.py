"""Rigid motions that the supports leave free, found and named before any solve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.constraints import Constraints
from magshell.model.elastic import Elastic
from magshell.model.images import Images
from magshell.model.places import Places
from magshell.shell.state import State


class FreeTurn(NamedTuple):
    """A part that can turn about a point.

    Attributes
    ----------
    places : ndarray, shape (n,)
        Its nodes and rigid bodies.
    centre : ndarray, shape (3,)
        A point at rest, m.
    axes : ndarray, shape (1 to 3, 3)
        Orthonormal, those about which it can turn.
    """

    places: IntArray
    centre: FloatArray
    axes: FloatArray


def free_motions(
    points: FloatArray,
    normals: FloatArray,
    nodes: IntArray,
    constraints: Constraints,
    springs: Sequence[Elastic] = (),
    places: Places | None = None,
) -> FloatArray:
    """Basis (motions, 6) of the rigid motions of some nodes that no support or spring resists.

    Columns: translation, then rotation about the nodes' centre (times their size, so that all have one unit). With
    `places`, a motion that is not the same in the neighbours of a repeated part is none, and jumps are among the nodes.
    """
    jumps = np.array([], dtype=bool) if places is None else nodes >= places.number - len(places.jumps)
    of_body = nodes if places is None else nodes[~jumps]
    centre = points[of_body].mean(axis=0)
    size = float(np.ptp(points[of_body], axis=0).max())
    arm = (points[nodes] - centre) / size
    rotation = np.eye(3)
    # motion of u, w and ω under three translations and three rotations: (nodes, 3, 6)
    u = np.concatenate([np.broadcast_to(rotation, (len(nodes), 3, 3)), -_cross(arm)], axis=2)
    w = np.concatenate([np.zeros((len(nodes), 3, 3)), -_cross(normals[nodes])], axis=2)
    ω = np.concatenate([np.zeros((len(nodes), 3, 3)), np.broadcast_to(rotation, (len(nodes), 3, 3))], axis=2)
    if jumps.any():
        u[jumps], ω[jumps] = 0.0, 0.0
        u[jumps, :, 3:] = -_cross(points[nodes[jumps]] / size)
    rows = []
    for field, (motion, column) in enumerate(((u, 0), (w, 3), (ω, 7))):
        frame = constraints.frame_of[nodes, field]
        turned = motion.copy()
        oblique = frame >= 0
        turned[oblique] = constraints.frames[frame[oblique]] @ motion[oblique]
        rows.append(turned[constraints.fixed[nodes, column : column + 3]])
    if places is not None and places.images is not None:
        rows += [_unlike(places.images, nodes, motion) for motion in (w, ω)]
        rows += [_unlike(places.images, nodes, u, u[jumps])]
    matrix = np.concatenate([*rows, np.zeros((6, 6))])
    resisted = matrix.T @ matrix
    for spring in springs:
        resisted = resisted + _resisted(spring, nodes, {"u": u, "w": w, "omega": ω})
    _, singular, basis = np.linalg.svd(resisted)
    return np.asarray(basis[singular < 1e-12 * max(float(singular[0]), 1.0)])


def _unlike(images: Images, nodes: IntArray, motion: FloatArray, jumps: FloatArray | None = None) -> FloatArray:
    """What a motion (nodes, 3, 6) of some nodes, with jumps (k, 3, 6), does not take from roots to images, (n, 6)."""
    found = np.intersect1d(images.found, nodes)
    at, root = np.searchsorted(nodes, found), np.searchsorted(nodes, images.root[found])
    unlike = motion[at] - images.rotation[found] @ motion[root]
    if jumps is not None:
        unlike = unlike - np.einsum("nk,kia->nia", images.steps[found], jumps)
    return np.asarray(unlike.reshape(-1, 6))


def _resisted(spring: Elastic, nodes: IntArray, motions: Mapping[str, FloatArray]) -> FloatArray:
    """Second derivative (6, 6) of a spring's energy by the rigid motions of some nodes, of a norm of the order of one.

    Springs that hold other nodes too count with what they do between these.
    """
    total, size = np.zeros((6, 6)), 0.0
    at_rest = State.undeformed(int(max(one.rows.max(initial=0) for one in spring.pairs)) + 1, 0, 0)
    for pairs, blocks in zip(spring.pairs, spring.stiffness(at_rest), strict=True):
        row, column = np.searchsorted(nodes, pairs.rows), np.searchsorted(nodes, pairs.columns)
        row, column = np.minimum(row, len(nodes) - 1), np.minimum(column, len(nodes) - 1)
        here = (nodes[row] == pairs.rows) & (nodes[column] == pairs.columns)
        left, right = motions[pairs.row_field][row[here]], motions[pairs.column_field][column[here]]
        total += np.einsum("nia,nij,njb->ab", left, blocks[here], right)
        size += float(np.abs(blocks).sum())
    return total / size


def _cross(vectors: FloatArray) -> FloatArray:
    """Matrices [v]× (n, 3, 3)."""
    zero = np.zeros(len(vectors))
    x, y, z = vectors.T
    return np.stack([np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], axis=-2)


def free_turns(
    places: Places, normals: FloatArray, constraints: Constraints, springs: Sequence[Elastic], turned: bool
) -> tuple[FreeTurn, ...]:
    """The parts that can still turn about a point, if something turns them.

    Parameters
    ----------
    places : Places
    normals : ndarray, shape (places, 3)
        Zero for rigid bodies.
    constraints : Constraints
    springs : sequence of Elastic
    turned : bool
        Whether a field turns bodies from the start.

    Raises
    ------
    InputError
        A part can move otherwise, or turn and nothing turns it; the message names the free motion.
    """
    turns = []
    turned = turned and not places.jumps  # which would turn with the cell
    mesh, owner, points = places.mesh, places.owner, places.points
    jumps = np.arange(places.number - len(places.jumps), places.number)
    parts = _parts(places, owner)
    for number, elements in enumerate(parts):
        nodes = np.unique(mesh.elements[elements])
        bodies = owner[nodes]
        nodes = np.concatenate([nodes, np.unique(bodies[bodies >= 0]), jumps])
        motions = free_motions(points, normals, nodes, constraints, springs, places)
        if len(motions) == 0:
            continue
        if turned and (turn := _turn(motions, points, nodes)) is not None:
            turns.append(turn)
            continue
        which = "the body" if len(parts) == 1 else f"part {number + 1} of {len(parts)} (element {elements[0]} …)"
        if len(motions) == 6:
            raise InputError(
                f"supports: {which} floats freely, nothing holds it. Add a clamp, or supports against "
                "three translations and three rotations"
            )
        raise InputError(
            f"supports: {which} can still move as a rigid body: {_describe(motions)}. Add a support against it"
        )
    return tuple(turns)


def _turn(motions: FloatArray, points: FloatArray, nodes: IntArray) -> FreeTurn | None:
    """Free motions (n, 6) as rotations about a point; None: they are not.

    A point c at rest, from the nodes' centre in their sizes, has t + ω × c = 0 in every motion.
    """
    _, sizes, axes = np.linalg.svd(motions[:, 3:], full_matrices=False)
    if len(motions) > len(sizes) or sizes.min() < 1e-6:
        return None  # a translation is among them
    t, ω = motions[:, :3].ravel(), _cross(motions[:, 3:]).reshape(-1, 3)
    c = np.linalg.lstsq(ω, -t, rcond=1e-9)[0]
    if np.abs(ω @ c + t).max() > 1e-9:
        return None
    centre, size = points[nodes].mean(axis=0), float(np.ptp(points[nodes], axis=0).max())
    return FreeTurn(nodes, centre + size * c, axes)


def _parts(places: Places, owner: IntArray) -> list[IntArray]:
    """Elements of each part of the mesh; parts that a rigid body or a repetition joins are one."""
    parts = places.mesh.parts
    images = places.images
    if not places.bodies and (images is None or not images.found.size):
        return parts
    links = [owner] if images is None else [owner, np.where(images.touched, images.root, -1)]
    joined: list[tuple[set[int], list[IntArray]]] = []
    for elements in parts:
        nodes = np.unique(places.mesh.elements[elements])
        of, members = {int(one) for link in links for one in link[nodes] if one >= 0}, [elements]
        for other in [one for one in joined if one[0] & of]:
            joined.remove(other)
            of, members = of | other[0], other[1] + members
        joined.append((of, members))
    return [np.concatenate(members) for _, members in joined]


def _describe(motions: FloatArray) -> str:
    """Name translations first, then what is left as rotations."""
    named = []
    translations = np.linalg.svd(motions[:, 3:].T)[2] @ motions
    for motion in translations:
        if np.linalg.norm(motion[3:]) < 1e-6 * np.linalg.norm(motion):
            named.append("translation along " + direction(motion[:3]))
        else:
            named.append("rotation about " + direction(motion[3:]))
    return " and ".join(sorted(named, reverse=True))


def direction(vector: FloatArray) -> str:
    """A direction in words: along an axis, or three numbers."""
    unit = vector / np.linalg.norm(vector)
    axis = int(np.argmax(np.round(np.abs(unit), 9)))
    if abs(unit[axis]) > 1.0 - 1e-9:
        return f"X{axis + 1}"
    unit = np.round(unit * np.sign(unit[axis]), 12) + 0.0
    return "({:.3g}, {:.3g}, {:.3g})".format(*unit)
