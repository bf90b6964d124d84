"""Rigid motions that the supports leave free, found and named before any solve."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.places import Places
from magshell.model.supports import Constraints


def free_motions(points: FloatArray, normals: FloatArray, nodes: IntArray, constraints: Constraints) -> FloatArray:
    """Basis (motions, 6) of the rigid motions of some nodes that no support resists.

    Columns: translation, then rotation about the nodes' centre (times their size, so that all have one unit).
    """
    centre = points[nodes].mean(axis=0)
    size = float(np.ptp(points[nodes], axis=0).max())
    arm = (points[nodes] - centre) / size
    rotation = np.eye(3)
    # motion of u, w and ω under three translations and three rotations: (nodes, 3, 6)
    u = np.concatenate([np.broadcast_to(rotation, (len(nodes), 3, 3)), -_cross(arm)], axis=2)
    w = np.concatenate([np.zeros((len(nodes), 3, 3)), -_cross(normals[nodes])], axis=2)
    ω = np.concatenate([np.zeros((len(nodes), 3, 3)), np.broadcast_to(rotation, (len(nodes), 3, 3))], axis=2)
    rows = []
    for field, (motion, column) in enumerate(((u, 0), (w, 3), (ω, 7))):
        frame = constraints.frame_of[nodes, field]
        turned = motion.copy()
        oblique = frame >= 0
        turned[oblique] = constraints.frames[frame[oblique]] @ motion[oblique]
        rows.append(turned[constraints.fixed[nodes, column : column + 3]])
    matrix = np.concatenate([*rows, np.zeros((6, 6))])
    _, singular, basis = np.linalg.svd(matrix.T @ matrix)
    return np.asarray(basis[singular < 1e-12 * max(float(singular[0]), 1.0)])


def _cross(vectors: FloatArray) -> FloatArray:
    """Matrices [v]× (n, 3, 3)."""
    zero = np.zeros(len(vectors))
    x, y, z = vectors.T
    return np.stack([np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], axis=-2)


def check_supported(places: Places, normals: FloatArray, constraints: Constraints) -> None:
    """Raise an InputError that names the free rigid motion of a part that can still move.

    `normals` are those of the places (places, 3), zero for rigid bodies.
    """
    mesh, parts = places.mesh, _parts(places)
    for number, elements in enumerate(parts):
        nodes = np.unique(mesh.elements[elements])
        bodies = places.owner[nodes]
        nodes = np.append(nodes, np.unique(bodies[bodies >= 0]))
        motions = free_motions(places.points, normals, nodes, constraints)
        if len(motions) == 0:
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


def _parts(places: Places) -> list[IntArray]:
    """Elements of each part of the mesh; parts that a rigid body joins are one."""
    parts, owner = places.mesh.parts, places.owner
    if not places.bodies:
        return parts
    bodies = [np.unique(owner[np.unique(places.mesh.elements[elements])]) for elements in parts]
    joined: list[tuple[set[int], list[IntArray]]] = []
    for elements, own in zip(parts, bodies, strict=True):
        of, members = set(own[own >= 0].tolist()), [elements]
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
            named.append("translation along " + _direction(motion[:3]))
        else:
            named.append("rotation about " + _direction(motion[3:]))
    return " and ".join(sorted(named, reverse=True))


def _direction(vector: FloatArray) -> str:
    unit = vector / np.linalg.norm(vector)
    axis = int(np.argmax(np.round(np.abs(unit), 9)))
    if abs(unit[axis]) > 1.0 - 1e-9:
        return f"X{axis + 1}"
    unit = np.round(unit * np.sign(unit[axis]), 12) + 0.0
    return "({:.3g}, {:.3g}, {:.3g})".format(*unit)
