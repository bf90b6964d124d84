"""Pieces of a shell that can turn about free hinges although the supports hold the shell, found before any solve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.constraints import FRAME_OF_FIELD, Constraints
from magshell.model.elastic import Elastic
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA, Rows, U
from magshell.model.shell import Shell
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS

STILL = 1e-9
"""Singular values of a motion that nothing resists, over the largest."""


def check_linkage(
    shell: Shell, rows: Rows, constraints: Constraints, springs: Sequence[Elastic], ties: Sequence[Elastic]
) -> None:
    """Raise an InputError that names a hinge about which pieces turn as rigid bodies, and nothing resists it.

    Parameters
    ----------
    shell : Shell
    rows : Rows
    constraints : Constraints
        Of the rows.
    springs, ties : sequence of Elastic
        Elastic supports, and the springs of hinges.
    """
    free = [hinge for hinge in shell.hinges if not hinge.stiffness]
    if not free:
        return
    piece = _pieces(rows, ties)
    u, θ = _motions(rows, piece)
    fields = {"u": u, "w": -cross_matrix(rows.normals) @ θ, "omega": θ}
    shared = np.flatnonzero(piece != piece[rows.source[:, U.start]])
    conditions = [(u[shared] - u[rows.source[shared, U.start]]).reshape(-1, u.shape[2])]
    conditions += [rows.images.differences(motion).reshape(-1, u.shape[2]) for motion in (u, θ)]
    for field, number in FRAME_OF_FIELD.items():
        motion, frame = fields[field].copy(), constraints.frame_of[:, number]
        oblique = frame >= 0
        motion[oblique] = constraints.frames[frame[oblique]] @ motion[oblique]
        conditions.append(motion[constraints.fixed[:, COLUMNS[field]]])
    matrix = np.concatenate(conditions)
    resisted = matrix.T @ matrix
    at_rest = State.undeformed(len(rows.of), len(shell.mesh.elements), shell.element.vectors)
    for spring in springs:
        own = np.zeros_like(resisted)
        for pairs, blocks in zip(spring.pairs, spring.stiffness(at_rest), strict=True):
            left, right = fields[pairs.row_field][pairs.rows], fields[pairs.column_field][pairs.columns]
            own += np.einsum("nia,nij,njb->ab", left, blocks, right)
        resisted += own / max(np.abs(own).max(), 1e-300)
    values, basis = np.linalg.eigh(resisted)
    moving = basis[:, values < STILL * values[-1]]
    turns = {hinge.group: _turn(shell, rows, hinge.edges(shell.mesh), θ @ moving) for hinge in free}
    group = max(turns, key=turns.__getitem__)
    if turns[group] > 1e-3:
        raise InputError(
            f"hinge on '{group}': what it joins turns about it, and nothing resists that: there is a motion without "
            "force. Give the hinge a stiffness, or hold what turns"
        )


def _pieces(rows: Rows, ties: Sequence[Elastic]) -> IntArray:
    """Number (rows,) of what moves as one: elements that share rotations, or whose rotations springs tie."""
    count, (elements, nodes) = len(rows.of), rows.elements.shape
    turning = rows.source[:, OMEGA.start]
    links = [(np.repeat(np.arange(elements), nodes) + count, turning[rows.elements].ravel())]
    links += [(pairs.rows, pairs.columns) for tie in ties for pairs in tie.pairs]
    one, other = (np.concatenate([link[k] for link in links]) for k in range(2))
    graph = coo_array((np.ones(len(one)), (one, other)), shape=(count + elements,) * 2)
    return np.asarray(connected_components(graph, directed=False)[1][turning])


def _motions(rows: Rows, piece: IntArray) -> tuple[FloatArray, FloatArray]:
    """u and the rotation of each row, (rows, 3, 6 pieces), as rigid motions of the pieces: sizes of one unit."""
    known, number = np.unique(piece, return_inverse=True)
    size = float(np.ptp(rows.points, axis=0).max())
    arm = (rows.points - rows.points.mean(axis=0)) / size
    u, θ = np.zeros((2, len(rows.of), 3, len(known), 6))
    at = np.arange(len(rows.of))
    u[at, :, number, :3] = np.eye(3)
    u[at, :, number, 3:] = -cross_matrix(arm)
    θ[at, :, number, 3:] = np.eye(3)
    return u.reshape(len(at), 3, -1), θ.reshape(len(at), 3, -1)


def _turn(shell: Shell, rows: Rows, edges: IntArray, θ: FloatArray) -> float:
    """Largest rotation of one side of a hinge against another in the motions θ (rows, 3, motions)."""
    corners = np.isin(shell.mesh.elements, edges[:, :2])
    of, sides = shell.mesh.elements[corners], rows.elements[corners]
    first = np.zeros(rows.nodes, dtype=np.int64)
    first[of] = sides
    return float(np.abs(θ[sides] - θ[first[of]]).max(initial=0.0))
