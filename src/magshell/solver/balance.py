"""Global equilibrium of a converged state: reactions of the supports against the field's total torque.

The forces and couples that the supports exert, taken at the deformed nodes, must balance: forces sum to zero (a
uniform field exerts none), moments to minus the magnetic torque, which is integrated here independently of the
element kernels, from the point values of F and R̃.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.assembly import Discretisation
from magshell.magnetics import law
from magshell.shell.evaluation import evaluate
from magshell.shell.state import State


class Balance(NamedTuple):
    """Sums over the body.

    Attributes
    ----------
    reaction_force : ndarray, shape (3,)
        N.
    reaction_moment : ndarray, shape (3,)
        About the origin, N m.
    magnetic_torque : ndarray, shape (3,)
        N m.
    force_imbalance, moment_imbalance : float
        |sum| over the sum of magnitudes of the nodal reactions (and of the torque's density).
    """

    reaction_force: FloatArray
    reaction_moment: FloatArray
    magnetic_torque: FloatArray
    force_imbalance: float
    moment_imbalance: float


def magnetic_torque(discretisation: Discretisation, state: State, load_factor: float) -> tuple[FloatArray, float]:
    """Total torque of the field (3,), N m, and the integral of its magnitude.

    Per unit volume the law's forces f on m = F B̃ and c on the spin do the work -(f · δm + c · δω) in a rigid rotation:
    a torque -(m × f + c), which is (1/mu0) m × B for the couple.
    """
    model, body = discretisation.model, discretisation.body
    fields = evaluate(body, state)
    volume = body.geometry.volume
    m = np.einsum("epkxy,epy->xepk", fields.F, body.remanence)
    n = np.broadcast_to(np.einsum("epxy,epy->xep", fields.R, body.remanence)[..., None], m.shape)
    f, c = np.zeros(m.shape), np.zeros(m.shape)
    unused = np.zeros((3, *m.shape)), np.zeros((3, *m.shape))
    law.forces_and_tangent(model.coupling, m, n, load_factor * model.field.vector, f, c, *unused)
    torque = -(np.cross(m, f, axis=0) + c) * volume
    return torque.sum(axis=(1, 2, 3)), float(np.linalg.norm(torque, axis=0).sum())


def balance(discretisation: Discretisation, state: State, load_factor: float, residual: FloatArray) -> Balance:
    """Reactions and torque of a converged state.

    Parameters
    ----------
    discretisation : Discretisation
    state : State
    load_factor : float
    residual : ndarray, shape (nodes, 10)
        Of that state, in the nodes' frames: at held components what the supports exert.
    """
    constraints = discretisation.model.constraints
    held = np.where(constraints.fixed & discretisation.carried, residual, 0.0)
    reaction = discretisation.to_global(held)
    force, couple = reaction[:, :3], reaction[:, 7:]
    position = discretisation.mesh.points + state.u
    director = discretisation.normals + state.w
    moments = np.cross(position, force) + np.cross(director, reaction[:, 3:6]) + couple
    torque, torque_scale = magnetic_torque(discretisation, state, load_factor)
    force_scale = float(np.linalg.norm(force, axis=1).sum())
    moment_scale = float(np.linalg.norm(moments, axis=1).sum()) + torque_scale
    total = moments.sum(axis=0)
    return Balance(
        force.sum(axis=0),
        total,
        torque,
        float(np.linalg.norm(force.sum(axis=0))) / force_scale if force_scale > 0.0 else 0.0,
        float(np.linalg.norm(total + torque)) / moment_scale if moment_scale > 0.0 else 0.0,
    )
