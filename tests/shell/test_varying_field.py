"""A field that varies in space: forces and tangent against the energy, rates, balance, and rigid motions of all."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from battery import (
    COUPLINGS,
    bowl,
    dense,
    each_element,
    example,
    free_body,
    name_of,
    patch,
    random_increment,
    random_state,
    scaled_error,
)
from joints.bodies import FOLD, extruded
from joints.bodies import jointed as joined
from parts import PARTS, jointed
from scipy.spatial.transform import Rotation

from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import STATIC, Increment, Instant
from magshell.evaluation.balance import magnetic
from magshell.magnetics import DeformationGradientEnergy, MicroRotationEnergy
from magshell.magnetics.fields import FunctionField, Motion, UniformField
from magshell.model.course import Loading
from magshell.model.rigid_body import RigidBody
from magshell.shell.elements import QUADRATIC
from shell.test_parts import second_slope, slope

CONSERVATIVE = [example(DeformationGradientEnergy), example(MicroRotationEnergy)]
AXIS = np.array((0.3, -0.5, 0.8)) / np.linalg.norm((0.3, -0.5, 0.8))
DRIVES = np.array((1.3, 0.1, -0.2, 0.05, 0.4))
STEP = 0.05
each_coupling = pytest.mark.parametrize("coupling", COUPLINGS, ids=name_of)


def harmonic(points):
    """Gradient of 0.2 x - 0.3 y + 0.4 z + 0.3 x z - 0.2 y z + 0.1 (x³ - 3 x y²) + 0.05 (3 x² y - y³)."""
    x, y, z = points.T
    B1 = 0.2 + 0.3 * z + 0.3 * (x * x - y * y) + 0.3 * x * y
    B2 = -0.3 - 0.2 * z - 0.6 * x * y + 0.15 * (x * x - y * y)
    return np.stack([B1, B2, 0.4 + 0.3 * x - 0.2 * y], axis=1)


def slopes(points):
    """Its gradient ∂B_i/∂x_j."""
    x, y, _ = points.T
    of_1, of_2 = 0.6 * x + 0.3 * y, -0.6 * y + 0.3 * x
    third = np.full_like(x, 0.3)
    G = np.zeros((len(x), 3, 3))
    G[:, 0, 0], G[:, 1, 1], G[:, 0, 1], G[:, 1, 0] = of_1, -of_1, of_2, of_2
    G[:, 0, 2], G[:, 2, 0], G[:, 1, 2], G[:, 2, 1] = third, third, -0.2, -0.2
    return G


FIELD = FunctionField(harmonic, 1.0, slopes, Motion(rotation_axis=AXIS, rotation=[0.4], centre=(0.1, 0.2, -0.1)))


def in_field(d, field=FIELD):
    """The body in another field, and a loading."""
    there = Discretisation(replace(d.model, field=field), lambda graph: np.arange(graph.shape[0]))
    loading = d.model.loading(1.0)
    return there, loading._replace(drives=DRIVES, flux_density=np.full(3, np.nan))


def curved(element=QUADRATIC, **options):
    return free_body(patch((2, 2), surface=bowl), element=element, **options)


@each_element
@pytest.mark.parametrize("coupling", CONSERVATIVE, ids=name_of)
def test_forces_and_tangent_are_derivatives_of_the_energy(element, coupling):
    d, loading = in_field(curved(element, coupling=coupling))
    state = random_state(d, 3)
    assembly = d.assemble(Instant(state, loading))
    K = dense(d, assembly.matrix)
    assert np.abs(K - K.T).max() < 1e-9 * np.abs(K).max(), "symmetric as far as the second derivatives are"
    increment = random_increment(d, 4, size=0.05)
    along = d.shell.recovered(increment.nodal, whole=False)

    def energy(s, alpha=0.0 * along):
        return float(d.shell.energy(Instant(d.moved(state, s * Increment(increment.nodal, alpha)), loading)).sum())

    independent = (increment.nodal * d.carried).ravel()
    assert slope(energy) == pytest.approx(float(assembly.residual.ravel() @ independent), rel=1e-8)
    second = second_slope(partial(energy, alpha=along), STEP)
    scale = np.abs(independent) @ np.abs(K) @ np.abs(independent)
    assert abs(second - independent @ K @ independent) < 1e-8 * scale


@each_element
@each_coupling
@pytest.mark.parametrize("parts", ["one", "plain"])
def test_tangent_is_the_derivative_of_the_residual(element, coupling, parts):
    """Without rotations, whose chart is tested above; α follows."""
    options = {"element": element, "coupling": coupling}
    body = curved(**options) if parts == "one" else jointed(patch((2, 2), surface=bowl), PARTS[parts], **options)
    d, loading = in_field(body)
    state, increment = random_state(d, 8), random_increment(d, 8).nodal
    increment[:, 7:10] = 0.0
    K = dense(d, d.assemble(Instant(state, loading)).matrix)
    along = d.shell.recovered(increment, whole=False)

    def residual(size):
        moved = state.moved(size * increment, size * along)
        return d.assemble(Instant(moved, loading), tangent=False).residual.ravel()

    rows = np.flatnonzero(~np.tile(np.isin(np.arange(11), (7, 8, 9)), len(d.free)))
    error = scaled_error((K @ increment.ravel())[rows], slope(residual)[rows])
    assert error < 1e-8, f"{error:.1e}"


@each_coupling
def test_rate_along_the_path(coupling):
    """Of multiplier, place and angle of the field."""
    d, loading = in_field(curved(coupling=coupling))
    state, change = random_state(d, 5), np.array((0.3, -0.2, 0.1, 0.4, -0.5))
    rate = Loading(np.zeros(3), 0.0 * loading.loads, 0.0 * loading.held, change)

    def residual(s):
        return d.assemble(Instant(state, loading._replace(drives=DRIVES + s * change)), tangent=False).residual

    found = d.shell.load_rate(Instant(state, loading), rate)
    assert np.abs(found - slope(residual)).max() < 1e-8 * np.abs(found).max()


@each_coupling
def test_a_constant_function_is_a_uniform_field(coupling):
    B = np.array((0.2, -0.3, 0.4))
    body = curved(coupling=coupling)
    constant = FunctionField(lambda x: np.tile(B, (len(x), 1)), 1.0, lambda x: np.zeros((len(x), 3, 3)))
    (varying, loading), (uniform, _) = in_field(body, constant), in_field(body, UniformField(B))
    state = random_state(varying, 6)
    one = varying.assemble(Instant(state, loading._replace(drives=np.array((1.0, 0, 0, 0, 0)))))
    other = uniform.assemble(Instant(state, loading._replace(flux_density=B, drives=np.array((1.0, 0.0)))))
    assert np.abs(one.residual - other.residual).max() < 1e-13 * np.abs(other.residual).max()
    assert abs(one.matrix - other.matrix).max() < 1e-12 * abs(other.matrix).max()


@each_coupling
def test_moving_body_and_field_together_turns_the_forces(coupling):
    """By the motion of the field itself."""
    d, loading = in_field(curved(coupling=coupling))
    state, angle, shift = random_state(d, 7), 0.7, np.array((0.3, -0.4, 0.2))
    turn, centre = Rotation.from_rotvec(angle * AXIS), np.array((0.1, 0.2, -0.1)) + DRIVES[1:4]
    x, D = d.rows.points, d.rows.normals
    carried = np.any(state.w, axis=1, keepdims=True)
    moved = state._replace(
        u=turn.apply(x + state.u - centre) + centre + shift - x,
        w=np.where(carried, turn.apply(D + state.w) - D, 0.0),
        q=(turn * Rotation.from_quat(state.q, scalar_first=True)).as_quat(scalar_first=True),
        alpha=np.einsum("ij,emj->emi", turn.as_matrix(), state.alpha),
    )
    drives = DRIVES + np.array((0.0, *shift, angle))
    before = d.assemble(Instant(state, loading), tangent=False).residual
    after = d.assemble(Instant(moved, loading._replace(drives=drives)), tangent=False).residual
    for columns in (slice(0, 3), slice(3, 6), slice(7, 10)):
        assert np.abs(turn.apply(before[:, columns]) - after[:, columns]).max() < 1e-10 * np.abs(before).max()
    assert np.abs(before[:, 6] - after[:, 6]).max() < 1e-10 * np.abs(before).max()


@each_coupling
@pytest.mark.parametrize("parts", ["plain", "layered"])
def test_nodal_forces_are_in_balance_with_the_field(coupling, parts):
    """Their sum and moment about the origin are minus force and torque of the field, integrated apart."""
    d, loading = in_field(jointed(patch((2, 2), surface=bowl), PARTS[parts], coupling=coupling))
    state = random_state(d, 9, strain=0.02)
    state = state._replace(alpha=0.0 * state.alpha)  # which turn in a rigid rotation as well
    residual = d.assemble(Instant(state, loading), tangent=False).residual
    field = magnetic(d, state, loading)
    x, director = d.rows.points + state.u, d.rows.normals + state.w
    moment = np.cross(x, residual[:, :3]) + np.cross(director, residual[:, 3:6]) + residual[:, 7:10]
    assert np.abs(residual[:, :3].sum(axis=0) + field.force).max() < 1e-12 * np.abs(residual).sum()
    assert np.abs(moment.sum(axis=0) + field.torque).max() < 1e-12 * np.abs(residual).sum()


def test_a_magnet_on_a_rigid_body():
    """Force and couple of a dipole, and their tangent, against its energy."""
    d = joined(
        extruded(FOLD), coupling=example(DeformationGradientEnergy), rigid=[RigidBody("far", moment=(0.2, -0.1, 0.3))]
    )
    d, loading = in_field(d)
    state = d.moved(d.undeformed(), random_increment(d, 1, size=0.02))
    assembly = d.assemble(Instant(state, loading))
    K = dense(d, assembly.matrix)
    increment = random_increment(d, 2, size=0.05)
    along = d.shell.recovered(increment.nodal, whole=False)

    def energy(s, alpha=0.0 * along):
        moved = d.moved(state, s * Increment(increment.nodal, alpha))
        return float(d.shell.energy(Instant(moved, loading)).sum()) + d.dipoles.energy(moved, loading)

    independent = (increment.nodal * d.carried).ravel()
    assert slope(energy) == pytest.approx(float(assembly.residual.ravel() @ independent), rel=1e-8)
    only = d.dipoles.evaluate(Instant(state, loading), STATIC, None, None).residual
    assert np.abs(only[d.rows.nodes]).max() > 1e-2
    second = second_slope(partial(energy, alpha=along), STEP)
    body = slice(11 * d.rows.nodes, 11 * (d.rows.nodes + 1))
    couple = only[d.rows.nodes, 7:10]
    K[body, body][7:10, 7:10] += 0.5 * np.cross(np.eye(3), -couple)
    scale = np.abs(independent) @ np.abs(K) @ np.abs(independent)
    assert abs(second - independent @ K @ independent) < 1e-8 * scale
