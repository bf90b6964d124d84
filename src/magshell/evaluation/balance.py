"""Global equilibrium of a converged state: reactions of the supports against the loads and the field's total torque.

The forces and couples that supports and loads exert, taken at the deformed nodes, must balance those of the field,
which are integrated here independently of the element kernels, from the point values of F and R̃. (A uniform field
exerts no force.)

Of a part that is repeated about an axis the sums over all copies balance: what its own sums have along the axis. From
cell to cell forces cancel, and those on the jumps have the periods as arms.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.equations.local_field import shaped
from magshell.evaluation import points
from magshell.evaluation.reactions import held_forces, moments_of
from magshell.magnetics.fields import Field
from magshell.magnetics.law import X
from magshell.model.course import Loading
from magshell.shell.deformed import evaluate, level_stretch, of_couplings
from magshell.shell.positions import level_positions
from magshell.shell.rotation import cross
from magshell.shell.section import LocalField
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
        Of the field; of one that varies, about the origin, N m.
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


class Magnetic(NamedTuple):
    """What the field exerts on shell and magnets: force and torque about the origin (3,), and their magnitudes."""

    force: FloatArray
    torque: FloatArray
    force_scale: float
    torque_scale: float


def magnetic(discretisation: Discretisation, state: State, loading: Loading) -> Magnetic:
    """Force and torque of the field, N and N m, and the integrals of their magnitudes."""
    field = discretisation.shell.field.at(state, loading, second=False)
    return _exerted(discretisation, state, field, discretisation.dipoles.acting(state, loading))


def magnetic_of(discretisation: Discretisation, state: State, part: Field, amounts: FloatArray) -> Magnetic:
    """The same of a part of the field, for its amounts."""
    points = level_positions(discretisation.reference, state)
    field = shaped(part.at(amounts, points.reshape(-1, 3), second=False), points.shape[:3])
    return _exerted(discretisation, state, field, discretisation.dipoles.acting_in(state, part, amounts))


def _exerted(discretisation: Discretisation, state: State, field: LocalField, magnets: FloatArray) -> Magnetic:
    """Of a field on the shell, with its forces on magnets (rows, 11)."""
    on_shell = on_levels(discretisation, state, field)
    places = discretisation.rows.points + state.u
    moments = magnets[:, COLUMNS["omega"]] + cross(places, magnets[:, :3])
    forces, torques = on_shell.force.reshape(-1, 3), on_shell.torque.reshape(-1, 3)
    return Magnetic(
        forces.sum(axis=0) + magnets[:, :3].sum(axis=0),
        torques.sum(axis=0) + moments.sum(axis=0),
        _sum_of_magnitudes(forces) + _sum_of_magnitudes(magnets[:, :3]),
        _sum_of_magnitudes(torques) + _sum_of_magnitudes(moments),
    )


class OnLevels(NamedTuple):
    """Force and torque about the origin of the field on each level (e, p, k, 3), N and N m."""

    force: FloatArray
    torque: FloatArray


def on_levels(discretisation: Discretisation, state: State, field: LocalField) -> OnLevels:
    """What a field exerts on the levels, integrated here independently of the element kernels."""
    reference = discretisation.reference
    fields = evaluate(reference, state, level_stretch(reference, state, field))
    work = of_couplings(reference, discretisation.couplings, fields, field)
    volume = reference.geometry.volume[..., None]
    torque = points.magnetic_torque(reference, fields, work) * volume
    force = -work[..., X : X + 3] * volume
    if field.slopes is not None:
        torque = torque + cross(level_positions(reference, state), force)
    return OnLevels(force, torque)


def balance(discretisation: Discretisation, state: State, loading: Loading, residual: FloatArray) -> Balance:
    """Reactions, loads and what the field exerts on a converged state.

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
    moments, load_moments = moments_of(reaction, position, director), moments_of(load, position, director)
    field = magnetic(discretisation, state, loading)
    force_scale = _sum_of_magnitudes(reaction[:, :3]) + _sum_of_magnitudes(load[:, :3]) + field.force_scale
    force_scale += _sum_of_magnitudes(load[:, 3:6] + load[:, COLUMNS["omega"]]) / discretisation.mesh.size
    moment_scale = _sum_of_magnitudes(moments) + _sum_of_magnitudes(load_moments) + field.torque_scale
    jumps = discretisation.rows.jumps
    reaction[jumps, :3], load[jumps, :3] = 0.0, 0.0
    force_sum, load_sum = reaction[:, :3].sum(axis=0), load[:, :3].sum(axis=0)
    moment_sum, load_moment_sum = moments.sum(axis=0), load_moments.sum(axis=0)
    forces, torques = force_sum + load_sum + field.force, moment_sum + load_moment_sum + field.torque
    for one in discretisation.model.shell.repeated:
        forces, torques = one.of_the_whole(forces, torques)
    if discretisation.model.turns:  # forces and torques vanish where such a body has turned into the field
        largest = _largest_torque(discretisation, state, loading)
        force_scale, moment_scale = force_scale + largest / discretisation.mesh.size, moment_scale + largest
    return Balance(
        force_sum,
        moment_sum,
        field.torque,
        load_sum,
        load_moment_sum,
        _over(forces, force_scale),
        _over(torques, moment_scale),
        force_scale,
        moment_scale,
    )


def _largest_torque(discretisation: Discretisation, state: State, loading: Loading) -> float:
    """Of the field on the magnets as they are, were they across it, N m."""
    reference, model = discretisation.reference, discretisation.model
    field = discretisation.shell.field.at(state, loading, second=False).flux_density
    moments = np.linalg.norm(reference.remanence, axis=-1) * reference.geometry.volume
    of_shell = (moments * np.linalg.norm(field, axis=-1)).sum() / model.coupling.vacuum_permeability
    of_bodies = sum(float(np.linalg.norm(body.moment)) for body in model.shell.rigid) * model.largest_field
    return float(of_shell) + of_bodies


def _sum_of_magnitudes(vectors: FloatArray) -> float:
    return float(np.linalg.norm(vectors, axis=1).sum())


def _over(vector: FloatArray, scale: float) -> float:
    return float(np.linalg.norm(vector)) / scale if scale > 0.0 else 0.0
