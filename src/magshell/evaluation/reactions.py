r"""Reactions: force and moment that each named support, and each spring, exerts on the shell.

A rigid rotation δθ of the support about a point c moves what it holds by

    δu = δθ × (x - c),      δw = δθ × d,      δω = δθ,

with the deformed positions x and directors d. So forces f on u, w and ω do the work F · δv in a translation δv and
M · δθ in a rotation, with

    F = Σ f_u,      M = Σ (x - c) × f_u + d × f_w + f_ω.

Forces on the thickness stretch φ do none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.model.elastic import reaction_name
from magshell.shell.rotation import cross
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS


class Reaction(NamedTuple):
    """What a support exerts on the shell.

    Attributes
    ----------
    name : str
        Of the support.
    point : ndarray, shape (3,)
        About which the moment is, m.
    force, moment : ndarray, shape (3,)
        N, N m.
    """

    name: str
    point: FloatArray
    force: FloatArray
    moment: FloatArray


def held_forces(discretisation: Discretisation, residual: FloatArray) -> FloatArray:
    """Forces (rows, 11) of all supports, global axes, from the residual in the nodes' frames."""
    held = discretisation.model.constraints.fixed & discretisation.carried
    return discretisation.to_global(np.where(held, residual, 0.0))


def moments_of(forces: FloatArray, arms: FloatArray, directors: FloatArray) -> FloatArray:
    """Moments (n, 3) of forces (n, 11) on the unknowns of rows, with the arms and directors (n, 3) of these."""
    turning = forces[:, COLUMNS["omega"]]
    return cross(arms, forces[:, COLUMNS["u"]]) + cross(directors, forces[:, COLUMNS["w"]]) + turning


def reactions(discretisation: Discretisation, state: State, forces: FloatArray) -> list[Reaction]:
    """The reaction of each named support, from the forces of all supports (rows, 11), global axes; and of springs."""
    x, d = discretisation.rows.points + state.u, discretisation.rows.normals + state.w
    found = []
    for support in discretisation.model.named_supports:
        at = support.nodes
        f_u, f_w, f_ω = (
            np.einsum("nij,nj->ni", support.shares[field], forces[at, COLUMNS[field]]) for field in ("u", "w", "omega")
        )
        point = support.weights @ x[: len(support.weights)] if support.point is None else support.point
        moment = (cross(x[at] - point, f_u) + cross(d[at], f_w) + f_ω).sum(axis=0)
        found.append(Reaction(support.name, point, f_u.sum(axis=0), moment))
    model = discretisation.model
    for spring, elastic, one in zip(model.springs, model.elastic, discretisation.springs.each(state), strict=True):
        point = elastic.weights @ x[: len(elastic.weights)] if elastic.about is None else elastic.about
        moments = moments_of(one, x - point, d)
        found.append(Reaction(reaction_name(spring), point, one[:, COLUMNS["u"]].sum(axis=0), moments.sum(axis=0)))
    return found
