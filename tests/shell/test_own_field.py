"""The field of the body itself: two plates, action and reaction, energy, derivative, magnets of rigid bodies."""

from __future__ import annotations

from dataclasses import replace

import magpylib
import numpy as np
import pytest
from battery import COUPLINGS, dense, free_body, name_of, random_increment
from scipy.spatial.transform import Rotation

from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import STATIC, Increment, Instant
from magshell.errors import InputError
from magshell.evaluation.balance import magnetic, on_levels
from magshell.magnetics.fields import SelfField, UniformField
from magshell.mesh import Mesh, rectangle, split
from magshell.model.course import Loading
from magshell.model.own_strength import own_strength
from magshell.model.rigid_body import RigidBody
from magshell.shell.point import MAGNETIC
from shell.test_parts import slope

LENGTH, THICKNESS, J = 10e-3, 1e-3, 0.1
LAWS = [type(law)() for law in COUPLINGS]
MULTIPLIER = 0.7
each_law = pytest.mark.parametrize("coupling", LAWS, ids=name_of)
CONSERVATIVE = [law for law in LAWS if name_of(law) != "MicropolarCouple"]


def two_plates(counts, place, turn=(0.0, 0.0, 0.0), cut=False):
    """Two square plates, the second turned about its middle, which is at a place."""
    low, high = (rectangle(LENGTH, LENGTH, (count, count)) for count in counts)
    if cut:
        high = split(high, "crossed")
    middle = [LENGTH / 2, LENGTH / 2, 0.0]
    upper = (high.points - middle) @ Rotation.from_rotvec(turn).as_matrix().T + place
    points = np.concatenate([low.points - middle, upper])
    elements = np.concatenate([low.elements, high.elements + len(low.points)])
    return Mesh(points, elements), np.arange(len(elements)) < len(low.elements)


def magnetised(counts, place, remanence=((0, 0, J), (0, 0, J)), turn=(0.0, 0.0, 0.0), cut=False, **options):
    """Discretisation of two plates with the remanences in their own frames; which elements are the first's; loading."""
    mesh, first = two_plates(counts, place, turn, cut)
    upper = Rotation.from_rotvec(turn).apply(remanence[1])
    vectors = np.where(first[:, None], remanence[0], upper)
    body = free_body(mesh, thickness=THICKNESS, remanent=vectors, **{"coupling": LAWS[0], **options})
    field = UniformField((0.0, 0.0, 0.0)) + SelfField()
    d = Discretisation(replace(body.model, field=field), lambda graph: np.arange(graph.shape[0]))
    drives = np.array((0.0, 0.0, MULTIPLIER))
    loading = Loading(np.zeros(3), np.zeros(0), np.zeros((len(d.rows.of), 11)), drives)
    return d, first, loading


def exerted(d, first, loading, state=None):
    """Force and torque about the origin on both plates, at multiplier 1."""
    state = d.undeformed() if state is None else state
    found = on_levels(d, state, d.shell.field.at(state, loading, second=False))
    return [
        (found.force[some].sum(axis=(0, 1, 2)) / MULTIPLIER, found.torque[some].sum(axis=(0, 1, 2)) / MULTIPLIER)
        for some in (first, ~first)
    ]


PLACES = {
    "above": ((0, 0, 6e-3), (0, 0, 0), (0, 0, J), 5e-4),
    "beside": ((12e-3, 3e-3, 4e-3), (0, 0, 0), (J, 0, 0), 5e-4),
    "oblique": ((3e-3, -2e-3, 9e-3), (0.3, 0.5, -0.2), (0.06, 0, 0.08), 5e-4),
    "near": ((1e-3, 0, 2.5e-3), (0, 0, 0), (0, 0, J), 1.5e-2),
}


@pytest.mark.parametrize("cut", [False, True], ids=["quadrilaterals", "triangles"])
@pytest.mark.parametrize(("place", "turn", "remanence", "error"), PLACES.values(), ids=PLACES)
def test_two_plates_against_magpylib(place, turn, remanence, error, cut):
    """Elements of a quarter of the plate; near: the gap is half of an element, and the error falls with it."""
    d, first, loading = magnetised((4, 4), place, ((0, 0, J), remanence), turn, cut)
    plate = {"dimension": (LENGTH, LENGTH, THICKNESS)}
    source = magpylib.magnet.Cuboid(**plate, polarization=(0, 0, J))
    target = magpylib.magnet.Cuboid(
        **plate, polarization=remanence, position=place, orientation=Rotation.from_rotvec(turn)
    )
    force, torque = magpylib.getFT(source, target, meshing=20000, pivot=(0, 0, 0))
    (one, its_torque), (other, other_torque) = exerted(d, first, loading)
    assert np.abs(other - force).max() < error * np.linalg.norm(force)
    assert np.abs(other_torque - torque).max() < error * LENGTH * np.linalg.norm(force)
    assert np.abs(one + other).max() < 1e-12 * np.linalg.norm(force)
    assert np.abs(its_torque + other_torque).max() < 1e-12 * LENGTH * np.linalg.norm(force)


def test_error_falls_with_the_mesh():
    """At a gap of 1.5 mm and three levels: elements of 5 mm are too large, those of 2.5 and 1.25 mm are not."""
    plate = {"dimension": (LENGTH, LENGTH, THICKNESS), "polarization": (0, 0, J)}
    target = magpylib.magnet.Cuboid(**plate, position=(0, 0, 2.5e-3))
    force = magpylib.getFT(magpylib.magnet.Cuboid(**plate), target, meshing=20000)[0][2]
    found = [exerted(*magnetised((n, n), (0, 0, 2.5e-3), levels=3))[1][0][2] for n in (2, 4, 8)]
    errors = np.abs(np.array(found) / force - 1.0)
    assert errors[0] > 0.1
    assert errors[1:].max() < 1e-3


@each_law
def test_action_is_reaction_in_a_deformed_body(coupling):
    """Force and moment of the body on itself vanish to round-off."""
    d, _, loading = magnetised((3, 2), (1e-3, 0, 4e-3), turn=(0.1, 0.3, 0.0), coupling=coupling)
    state = bent(d, 20.0)
    total = magnetic(d, state, loading)
    assert np.abs(total.force).max() < 1e-12 * total.force_scale
    assert np.abs(total.torque).max() < 1e-12 * total.torque_scale


@each_law
def test_a_rigid_motion_turns_what_is_exerted(coupling):
    d, first, loading = magnetised((2, 3), (1e-3, 0, 4e-3), turn=(0.1, 0.3, 0.0), coupling=coupling)
    before = exerted(d, first, loading)
    turn, shift = Rotation.from_rotvec([0.4, -1.1, 2.0]), np.array((3e-3, -1e-3, 2e-3))
    state = moved_rigidly(d, np.ones(len(d.rows.of), dtype=bool), turn, shift)
    after = exerted(d, first, loading, state)
    for (force, torque), (turned, moment) in zip(before, after, strict=True):
        assert np.abs(turn.apply(force) - turned).max() < 1e-12 * np.linalg.norm(force)
        wanted = turn.apply(torque) + np.cross(shift, turned)
        assert np.abs(wanted - moment).max() < 1e-12 * LENGTH * np.linalg.norm(force)


def bent(d, curvature):
    """A state of sections that turn about X2 in proportion to X1 (1/m)."""
    state, angles = d.undeformed(), curvature * d.rows.points[:, 0]
    turns = Rotation.from_rotvec(np.outer(angles, (0.0, -1.0, 0.0)))
    rest = d.carried[:, 3]
    state.u[:, 2] = 0.5 * curvature * d.rows.points[:, 0] ** 2
    state.w[rest] = (turns.apply(d.rows.normals) - d.rows.normals)[rest]
    state.q[:] = turns.as_quat(scalar_first=True)
    return state


def moved_rigidly(d, rows, turn, shift):
    """A state in which some rows are turned about the origin and shifted."""
    state = d.undeformed()
    rest = rows & d.carried[:, 3]
    state.u[rows] = turn.apply(d.rows.points[rows]) + shift - d.rows.points[rows]
    state.w[rest] = turn.apply(d.rows.normals[rest]) - d.rows.normals[rest]
    state.q[rows] = turn.as_quat(scalar_first=True)
    return state


@pytest.mark.parametrize("coupling", CONSERVATIVE, ids=name_of)
def test_force_and_torque_are_derivatives_of_the_energy(coupling):
    """Of one plate that moves rigidly. Each pair counts once: the factor ½."""
    d, first, loading = magnetised((2, 2), (1e-3, 0, 5e-3), ((0, 0, J), (0.06, 0, 0.08)), coupling=coupling)
    upper = np.zeros(len(d.rows.of), dtype=bool)
    upper[d.mesh.elements[~first]] = True
    axis, along = np.array((0.3, -0.8, 0.5)), np.array((1.0, 0.5, -2.0))

    def energy(s):
        state = moved_rigidly(d, upper, Rotation.from_rotvec(s * axis), 1e-3 * s * along)
        return float(d.shell.energy(Instant(state, loading))[:, MAGNETIC].sum()) / MULTIPLIER

    force, torque = exerted(d, first, loading)[1]
    work = 1e-3 * force @ along + torque @ axis
    assert slope(energy) == pytest.approx(-work, rel=1e-7)


@pytest.mark.parametrize("coupling", CONSERVATIVE, ids=name_of)
@pytest.mark.parametrize("gap", [2e-3, 40e-3])
def test_residual_is_the_derivative_of_the_energy(coupling, gap):
    """In a bent body, where moments vary in an element, and elements are near to or far from those of other pieces."""
    d, _, loading = magnetised((1, 1), (1e-3, 0, gap), ((0.02, 0, J), (0.06, 0, 0.08)), coupling=coupling)
    state, increment = bent(d, 20.0), random_increment(d, 3, size=1e-2).nodal
    increment[:, :3] *= LENGTH
    along = np.zeros_like(state.alpha)

    def energy(s):
        moved = d.moved(state, s * Increment(increment, along))
        return float(d.shell.energy(Instant(moved, loading))[:, MAGNETIC].sum())

    residuals = (
        d.shell.evaluate(Instant(state, one), STATIC, None, None).residual
        for one in (loading, loading._replace(drives=np.zeros(3)))
    )
    share = np.subtract(*residuals)
    assert slope(energy) == pytest.approx(float(np.sum(share * increment)), rel=1e-7)


@each_law
def test_tangent_and_what_it_leaves_out_are_the_derivative(coupling):
    """Of the residual's part by the own field, without rotations, whose chart has more."""
    d, _, loading = magnetised((2, 1), (1e-3, 0, 4e-3), coupling=coupling)
    without = loading._replace(drives=np.zeros(3))
    state, increment = bent(d, 20.0), random_increment(d, 3).nodal
    increment[:, 7:10] = 0.0
    increment[:, :3] *= LENGTH
    instant = Instant(state, loading)

    def own(size):
        moved = state.moved(size * increment, np.zeros_like(state.alpha))
        whole, rest = (d.assemble(Instant(moved, one), tangent=False).residual for one in (loading, without))
        return (whole - rest)[d.free]

    wanted = (own(1e-5) - own(-1e-5)) / 2e-5
    found = d.left_out(instant, Increment(increment, np.zeros_like(state.alpha)))[d.numbering.equations]
    whole, rest = (dense(d, d.assemble(Instant(state, one)).matrix) for one in (loading, without))
    found = found + ((whole - rest) @ increment.ravel())[d.free.ravel()]
    rows = ~np.isin(np.nonzero(d.free)[1], (7, 8, 9))
    assert np.abs(found - wanted)[rows].max() < 1e-2 * np.abs(wanted[rows]).max()


def test_a_magnet_on_a_rigid_body_takes_part():
    """Force and torque of two plates' worth of dipoles, and the energy."""
    mesh, first = two_plates((2, 1), (0, 0, 12e-3))
    moment = J / (4e-7 * np.pi) * LENGTH**2 * THICKNESS
    groups = {"up": np.unique(mesh.elements[~first])}
    mesh = Mesh(mesh.points, mesh.elements, node_groups=groups)
    remanence = np.where(first[:, None], (0, 0, J), 0.0)
    rigid = [RigidBody("up", moment=(0.0, 0.0, moment))]
    body = free_body(mesh, thickness=THICKNESS, remanent=remanence, coupling=CONSERVATIVE[0], rigid=rigid)
    d = Discretisation(replace(body.model, field=SelfField()), lambda graph: np.arange(graph.shape[0]))
    loading = Loading(np.zeros(3), np.zeros(0), np.zeros((len(d.rows.of), 11)), np.array((MULTIPLIER,)))
    state = d.undeformed()
    total = magnetic(d, state, loading)
    assert total.force_scale > 1e-4
    assert np.abs(total.force).max() < 1e-13 * total.force_scale
    assert np.abs(total.torque).max() < 1e-13 * total.torque_scale
    source = magpylib.magnet.Cuboid(dimension=(LENGTH, LENGTH, THICKNESS), polarization=(0, 0, J))
    target = magpylib.misc.Dipole(moment=(0, 0, moment), position=(0, 0, 12e-3))
    force = magpylib.getFT(source, target)[0]
    row = d.rows.nodes
    assert np.abs(d.dipoles.acting(state, loading)[row, :3] / MULTIPLIER - force).max() < 1e-3 * np.abs(force).max()

    def energy(s):
        moved = d.undeformed()
        rows = d.rows.points[:, 2] > 6e-3
        moved.u[rows, 2] = 1e-3 * s
        magnets = d.dipoles.energy(moved, loading)
        return (float(d.shell.energy(Instant(moved, loading))[:, MAGNETIC].sum()) + magnets) / MULTIPLIER

    assert slope(energy) == pytest.approx(-1e-3 * force[2], rel=1e-3)


def test_nothing_without_it_and_zero_multiplier():
    d, _, loading = magnetised((2, 2), (0, 0, 5e-3))
    state = d.undeformed()
    off = d.shell.field.at(state, loading._replace(drives=np.zeros(3)))
    assert not off.flux_density.any()
    assert not off.slopes.any()
    assert not d.exact_tangent
    plain = Discretisation(replace(d.model, field=UniformField((0, 0, 1e-3))), lambda graph: np.arange(graph.shape[0]))
    assert plain.shell.field.own is None
    assert plain.exact_tangent


def test_threads_that_ask_for_different_states():
    """Another thread asks for its state just after this one has kept its own."""
    d, _, _ = magnetised((1, 1), (0.0, 0.0, 6e-3))
    own, here, there = d.shell.field.own, d.undeformed(), bent(d, 40.0)
    alone = own.at(here).flux_density
    own.at(there)
    kept = own._last
    assert np.abs(kept[1].flux_density - alone).max() > 1e-3 * np.abs(alone).max()

    class Interrupted(type(own)):
        _last = property(lambda self: kept, lambda self, mine: None)

    own.__class__ = Interrupted
    np.testing.assert_array_equal(own.at(here).flux_density, alone)


def test_too_near_is_refused():
    from magshell.equations.term import FieldLost

    d, _, loading = magnetised((2, 2), (0, 0, 1.1e-3))
    with pytest.raises(FieldLost, match="so near to element 0 that"):
        d.assemble(Instant(d.undeformed(), loading), tangent=False)


def test_twice_is_refused():
    d, _, _ = magnetised((1, 1), (0, 0, 5e-3))
    with pytest.raises(InputError, match="2 times part of the field"):
        Discretisation(replace(d.model, field=SelfField() + SelfField()), lambda graph: np.arange(graph.shape[0]))


def test_estimate_of_its_strength():
    """What one plate makes at the other, of elements that are dipoles, and what distant parts of it add."""
    d, _, _ = magnetised((4, 4), (0, 0, 12e-3))
    source = magpylib.magnet.Cuboid(dimension=(LENGTH, LENGTH, THICKNESS), polarization=(0, 0, J))
    found = own_strength(d.model.shell)
    largest = np.linalg.norm(source.getB(d.mesh.points + np.array((0, 0, 12e-3))), axis=1).max()
    assert 0.5 * largest < found.flux_density < 1.2 * largest
    assert LENGTH / 2 < found.beyond < LENGTH
