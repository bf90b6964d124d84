"""Global equilibrium of a converged state: reactions of the supports against the loads and the field's total torque.

The forces and couples that supports and loads exert, taken at the deformed nodes, must balance: forces sum to zero (a
uniform field exerts none), moments to minus the magnetic torque, which is integrated here independently of the
element kernels, from the point values of F and R̃.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation import points
from magshell.evaluation.points import evaluate, level_stretch, of_couplings
from magshell.evaluation.reactions import held_forces
from magshell.model.course import Loading
from magshell.shell.rotation import cross
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS


class Balance(NamedTuple):
    """Sums over the body.

    Attributes
    ----------
    reaction_force : ndarray, shape (3,)
        Of supports and springs, N.
    reaction_moment : ndarray, shape (3,)
        About the origin, N m.
    magnetic_torque : ndarray, shape (3,)
        N m.
    load_force : ndarray, shape (3,)
        N.
    load_moment : ndarray, shape (3,)
        About the origin, N m.
    force_imbalance, moment_imbalance : float
        |sum| over the scale.
    force_scale, moment_scale : float
        Sum of magnitudes of the nodal reactions and loads, N and N m (here with the torque's density). Couples of the
        loads count among the forces with the body's size as their arm: pure bending exerts no other.
    """

    reaction_force: FloatArray
    reaction_moment: FloatArray
    magnetic_torque: FloatArray
    load_force: FloatArray
    load_moment: FloatArray
    force_imbalance: float
    moment_imbalance: float
    force_scale: float
    moment_scale: float


def largest_imbalances(balances: Sequence[Balance]) -> tuple[float, float]:
    """Largest imbalance of forces and of moments on a path, over the largest scales of that path.

    A state without load has forces of round-off only, which do not balance each other.
    """
    if not balances:
        return 0.0, 0.0
    ratios = np.array([(one.force_imbalance, one.moment_imbalance) for one in balances])
    scales = np.array([(one.force_scale, one.moment_scale) for one in balances])
    sums, largest = (ratios * scales).max(axis=0), scales.max(axis=0)
    force, moment = np.divide(sums, largest, out=np.zeros(2), where=largest > 0.0).tolist()
    return force, moment


def magnetic_torque(discretisation: Discretisation, state: State, loading: Loading) -> tuple[FloatArray, float]:
    """Total torque of the field (3,), N m, on shell and magnets, and the integral of its magnitude."""
    flux_density = loading.flux_density
    reference = discretisation.reference
    fields = evaluate(reference, state, level_stretch(reference, state, flux_density))
    forces = of_couplings(reference, discretisation.couplings, fields, flux_density)
    torque = points.magnetic_torque(reference, fields, forces) * reference.geometry.volume[..., None]
    magnets = discretisation.dipoles.torques(state, loading)
    magnitude = float(np.linalg.norm(torque, axis=-1).sum() + np.linalg.norm(magnets, axis=-1).sum())
    return torque.sum(axis=(0, 1, 2)) + magnets.sum(axis=0), magnitude


def balance(discretisation: Discretisation, state: State, loading: Loading, residual: FloatArray) -> Balance:
    """Reactions, loads and torque of a converged state.

    Parameters
    ----------
    discretisation : Discretisation
    state : State
    loading : Loading
    residual : ndarray, shape (rows, 11)
        Of that state, in the nodes' frames: at held components what the supports exert.
    """
    reaction = held_forces(discretisation, residual) + sum(discretisation.springs.each(state))
    load = discretisation.loads.forces(state, loading.loads)
    position = discretisation.rows.points + state.u
    director = discretisation.rows.normals + state.w
    moments = cross(position, reaction[:, :3]) + cross(director, reaction[:, 3:6]) + reaction[:, COLUMNS["omega"]]
    load_moments = cross(position, load[:, :3]) + cross(director, load[:, 3:6]) + load[:, COLUMNS["omega"]]
    torque, torque_scale = magnetic_torque(discretisation, state, loading)
    force_sum, load_sum = reaction[:, :3].sum(axis=0), load[:, :3].sum(axis=0)
    moment_sum, load_moment_sum = moments.sum(axis=0), load_moments.sum(axis=0)
    force_scale = _sum_of_magnitudes(reaction[:, :3]) + _sum_of_magnitudes(load[:, :3])
    force_scale += _sum_of_magnitudes(load[:, 3:6] + load[:, COLUMNS["omega"]]) / discretisation.mesh.size
    moment_scale = _sum_of_magnitudes(moments) + _sum_of_magnitudes(load_moments) + torque_scale
    return Balance(
        force_sum,
        moment_sum,
        torque,
        load_sum,
        load_moment_sum,
        _over(force_sum + load_sum, force_scale),
        _over(moment_sum + load_moment_sum + torque, moment_scale),
        force_scale,
        moment_scale,
    )


def _sum_of_magnitudes(vectors: FloatArray) -> float:
    return float(np.linalg.norm(vectors, axis=1).sum())


def _over(vector: FloatArray, scale: float) -> float:
    return float(np.linalg.norm(vector)) / scale if scale > 0.0 else 0.0
