"""Reactions, work and hand statics of bodies with joints, hinges, rigid bodies and magnets; special nodes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mesh.bands import moebius
from scipy.spatial.transform import Rotation

import magshell as ms
from joints.bodies import FLAT, FOLD, TEE, UPSIDE_DOWN, extruded
from magshell.equations.instant import Increment, Instant
from magshell.evaluation.converged import Converged, converged
from magshell.linalg import make_solver
from magshell.mesh import Mesh
from magshell.model.rows import OMEGA, U
from magshell.shell import rotation

SHARP = ms.Settings(tolerance=1e-12)
H = 0.05
RUBBER = ms.MicropolarNeoHookean(1.0, 1.7, length_scale=0.1 * H)
MOMENT = (4e-5, -2e-5, 3e-5)
FIELD = ms.UniformField((2e-2, 3e-2, -5e-2))
FORCE, COUPLE = (2e-6, -1e-6, 3e-6), (1e-6, 2e-6, -1e-6)


def shell(mesh, magnet=0.0, **made):
    """Of this rubber, magnetised with a remanence along X1 (T)."""
    return ms.Shell(mesh, H, RUBBER, ms.remanence.constant((magnet, 0.0, 0.0)), density=1e-6, **made)


def row_of(path):
    """The row of the first rigid body, and its state's displacement and quaternion."""
    row, state = path.discretisation.rows.nodes, path.steps[-1].state
    return row, state.u[row], state.q[row]


def table(path):
    """The last row of the history."""
    return dict(zip(path.history.columns, path.history.rows(path.steps)[-1], strict=True))


# -- hand statics and energies ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("lines", [FLAT, TEE], ids=["flat", "tee"])
def test_force_and_torque_of_a_body_by_hand(lines):
    """It passes on what acts on it: force, couple, weight and the couple of the field, and the clamp bears them."""
    point = np.array((1.7, 0.2, 0.4))
    body = ms.RigidBody("far", name="handle", point=point, moment=MOMENT, mass=3e-7)
    weight = np.array((0.0, 1.0, -2.0))
    loads = [ms.Force("handle", FORCE), ms.Moment("handle", COUPLE), ms.Gravity(weight)]
    model = ms.Model(shell(extruded(lines), rigid=[body]), [ms.Clamp("near", point=(0, 0, 0))], FIELD, loads=loads)
    path = ms.solve(model, SHARP)
    _, u, q = row_of(path)
    found = table(path)
    turned = Rotation.from_quat(q, scalar_first=True).apply(MOMENT)
    x = path.discretisation.rows.points + path.steps[-1].state.u
    weights = model.forces_at_rest[2][: len(model.shell.mesh.points), :3]
    ends = model.shell.mesh.nodes_of("far")
    force = np.array(FORCE) + 3e-7 * weight + weights[ends].sum(axis=0)
    own = np.cross(x[ends] - point - u, weights[ends]).sum(axis=0)
    torque = np.array(COUPLE) + np.cross(turned, FIELD.vector) + own
    assert np.linalg.norm(rotation.logarithm(q[None])) > 0.02
    scale = 1e-9 * np.abs(torque).max()
    assert [found[f"handle.F{i}"] for i in (1, 2, 3)] == pytest.approx(force.tolist(), rel=1e-8)
    assert [found[f"handle.T{i}"] for i in (1, 2, 3)] == pytest.approx(torque.tolist(), abs=scale)
    assert [found[f"handle.u{i}"] for i in (1, 2, 3)] == pytest.approx(u.tolist(), rel=1e-12)
    free = np.setdiff1d(np.arange(len(weights)), ends)
    total = force + weights[free].sum(axis=0)
    assert [found[f"near.R{i}"] for i in (1, 2, 3)] == pytest.approx((-total).tolist(), rel=1e-8)
    moment = np.cross(point + u, force) + torque + np.cross(x[free], weights[free]).sum(axis=0)
    assert [found[f"near.M{i}"] for i in (1, 2, 3)] == pytest.approx((-moment).tolist(), abs=3.0 * scale)


ASSEMBLED = {
    "joint": {"rigid": [ms.RigidBody("far", name="end", moment=MOMENT)]},
    "sprung hinge": {
        "rigid": [ms.RigidBody("far", name="end", moment=MOMENT)],
        "hinges": [ms.Hinge("joint", 2e-5)],
    },
}
LIFT = (ms.Prescribe("end", "u", value=(0.02, -0.03, 0.1)), ms.Prescribe("end", "omega", value=(0.1, 0.3, -0.1)))


def potential(d, state, loading):
    """Of everything, J: elastic, magnetic, springs, hinges, magnets."""
    elastic = Converged(d, state, loading).energies.sum()
    return elastic + d.springs.energy(state) + d.hinges.energy(state) + d.dipoles.energy(state, loading)


def relaxed(d, state, loading):
    """Equilibrium near a state, what is held staying as it is."""
    for _ in range(12):
        assembly = d.assemble(Instant(state, loading))
        if assembly.worst[1] < 1e-13:
            break
        solution = make_solver("superlu").factorise(assembly.matrix).solve(assembly.right_side)
        state = d.moved(state, d.correction(solution))
    return state


@pytest.mark.parametrize("made", ASSEMBLED.values(), ids=ASSEMBLED)
def test_reaction_on_a_rigid_body_is_the_derivative_of_the_energy(made):
    """A tee whose rigid end is moved and turned in a field, through a joint or hinges; a spring holds its other end."""
    model = ms.Model(
        shell(extruded(TEE, 1, 1), 1e-8, **made),
        [ms.Clamp("near"), *LIFT],
        FIELD,
        ms.DeformationGradientEnergy(),
        springs=[ms.Spring("sheet1", 1e-5)],
    )
    path = ms.solve(model, SHARP)
    d, step = path.discretisation, path.steps[-1]
    reached = converged(d, step)
    (reaction,) = (one for one in reached.reactions if one.name == "end")
    row = row_of(path)[0]
    scale = np.array([np.abs(reaction.force).max(), np.abs(reaction.moment).max()])
    for columns, expected, size in ((U, reaction.force, scale[0]), (OMEGA, reaction.moment, scale[1])):
        for axis in range(3):
            motion = np.zeros_like(reached.assembly.residual)
            motion[row, columns.start + axis] = 1.0
            motion = d.rows.shared(motion)

            def at(s, motion=motion):
                there = d.moved(step.state, s * Increment(motion, np.zeros_like(step.state.alpha)))
                return potential(d, relaxed(d, there, reached.loading), reached.loading)

            slopes = [(at(s) - at(-s)) / (2.0 * s) for s in (1e-3, 2e-3)]
            assert abs((4.0 * slopes[0] - slopes[1]) / 3.0 - expected[axis]) < 1e-6 * size


@pytest.mark.parametrize("coupling", [ms.MicropolarCouple(), ms.DeformationGradientEnergy()], ids=["couple", "energy"])
def test_work_is_stored(coupling):
    """Of loads, moving bodies and the field: in shell, hinges and springs, with an error that falls by the square."""
    errors = []
    for count in (6, 12):
        model = ms.Model(
            shell(extruded(TEE, 1, 1), 1e-8, **ASSEMBLED["sprung hinge"]),
            [ms.Clamp("near"), ms.Prescribe("end", "omega", 2, 0.3, history=(0, 1))],
            replace(FIELD, history=(1, 1)),
            coupling,
            loads=[ms.Force("end", FORCE, history=(0, 1)), ms.Moment("joint", COUPLE, history=(0, 1))],
            springs=[ms.Spring("sheet1", 1e-5)],
            stages=[ms.Stage(), ms.Stage(stops=[(i + 1) / count for i in range(count)])],
        )
        path = ms.solve(model, ms.Settings(tolerance=1e-11, first_step=1.0 / count))
        rows = [dict(zip(path.history.columns, row, strict=True)) for row in path.history.rows(path.steps)]
        own = [row for row in rows if row["stage"] == 2]
        assert len(own) == count
        before, after = rows[-count - 1], rows[-1]
        stored, done = (
            sum(after[name] - before[name] for name in names if after[name] is not None)
            for names in (("elastic", "springs", "magnetic"), ("work", "work_field"))
        )
        errors.append(done / stored - 1.0)
    assert 3.0 < errors[0] / errors[1] < 5.0, errors
    assert abs(errors[1]) < 1e-2


# -- what may meet at a node -----------------------------------------------------------------------------------------


def test_sections_of_different_thickness_meet_at_a_kink():
    """A fold of two thicknesses, one of layers: the rigid frame of two beams, with the stiffness of each."""
    thin, small = 0.02, 1e-3
    material = ms.MicropolarNeoHookean(1.0, 0.0, length_scale=1e-4 * thin)
    layers = [ms.Layer(0.5 * thin, material), ms.Layer(0.5 * thin, material)]
    regions = [ms.Region("sheet1", layers=layers)]
    body = ms.Shell(extruded(FOLD, 6, 1), 2.0 * thin, material, regions=regions)
    path = ms.solve(ms.Model(body, [ms.Clamp("near")], loads=[ms.Force("far", (small * thin**3 / 6.0, 0, 0))]), SHARP)
    mesh, state = body.mesh, path.steps[-1].state
    found = state.u[mesh.nodes_of("far"), 0].mean()
    # ∫ M²/D: the thin post of length 1 bends by M = F s, the arm, 8 times as stiff, by F.
    assert found == pytest.approx(small * (1.0 / 3.0 + 1.0 / 8.0), rel=2e-3)
    joint = mesh.nodes_of("joint")
    assert np.isin(joint, path.discretisation.rows.joined).all()
    assert path.steps[-1].balance.moment_imbalance < 1e-8


def test_triangles_at_joints():
    """As many quadrilaterals give the same deflection."""
    found = []
    for cut in (False, True):
        mesh = extruded(TEE, 4, 2)
        mesh = ms.mesh.split(mesh, "crossed") if cut else mesh
        path = ms.solve(ms.Model(shell(mesh), [ms.Clamp("near")], loads=[ms.Force("far", FORCE)]))
        found.append(path.steps[-1].state.u[mesh.nodes_of("far")].mean(axis=0))
        assert path.steps[-1].balance.moment_imbalance < 1e-8
    assert np.linalg.norm(found[1] - found[0]) < 1e-2 * np.linalg.norm(found[0])


def test_a_moebius_band_solves():
    """Clamped at one edge across it and pulled opposite: where the normals flip, nothing changes."""
    band = moebius(24, 2)
    found = []
    for start in (0, 5):
        elements = np.roll(band.elements, start, axis=0)
        turned = elements.copy()
        turned[:start] = elements[:start][:, [0, 3, 2, 1, 7, 6, 5, 4]]
        nodes = {"held": np.unique(band.elements[:2]), "pulled": np.unique(band.elements[24:26])}
        mesh = Mesh(band.points, turned, node_groups=nodes)
        made = ms.Shell(mesh, 0.02 * mesh.size, RUBBER)
        path = ms.solve(ms.Model(made, [ms.Clamp("held")], loads=[ms.Force("pulled", (1e-7, 2e-7, -3e-7))]))
        found.append(path.steps[-1].state.displacement(len(mesh.points)))
        assert path.discretisation.rows.joined.size
        assert path.steps[-1].balance.moment_imbalance < 1e-8
    assert np.abs(found[1] - found[0]).max() < 1e-2 * np.abs(found[0]).max()


def test_a_cut_beside_a_hinge():
    """Half of the line across a strip is cut, half a sprung hinge: the angle is M over k and half the width."""
    mesh = extruded(FLAT, 3, 2)
    joint = mesh.edge_groups["joint"]
    left = mesh.points[joint[:, :2], 1].max(axis=1) <= 0.5 + 1e-9
    groups = {**mesh.edge_groups, "slit": joint[left], "hinge": joint[~left]}
    del groups["joint"]
    mesh = ms.mesh.cut(Mesh(mesh.points, mesh.elements, mesh.element_groups, groups), ["slit"])
    k, angle = 1e-7, 0.2
    made = shell(mesh, rigid=[ms.RigidBody("far")], hinges=[ms.Hinge("hinge", k)])
    supports = [ms.Clamp("near"), ms.Prescribe("far", "omega", 1), ms.Prescribe("far", "omega", 3)]
    path = ms.solve(ms.Model(made, supports, loads=[ms.Moment("far", (0, 0.5 * k * angle, 0))]))
    assert rotation.logarithm(row_of(path)[2][None])[0, 1] == pytest.approx(angle, rel=1e-2)


def test_a_mirror_plane_through_a_rigid_body():
    """Half of a strip with half of its rigid end, both held by the plane, is the whole one."""
    found = []
    for half in (False, True):
        mesh = ms.mesh.rectangle(1.0, 0.2 if half else 0.4, (4, 1 if half else 2))
        body = ms.RigidBody("right", name="end", point=(1.1, 0.0, 0.1) if half else (1.1, 0.2, 0.1))
        supports = [ms.Clamp("left")]
        if half:
            supports += [ms.SymmetryPlane("bottom", (0, 1, 0)), ms.SymmetryPlane("end", (0, 1, 0))]
        share = 0.5 if half else 1.0
        load = ms.Force("end", (share * 1e-6, 0, share * 4e-6))
        path = ms.solve(ms.Model(shell(mesh, rigid=[body]), supports, loads=[load]), SHARP)
        found.append(np.concatenate(row_of(path)[1:]))
        assert path.steps[-1].balance.moment_imbalance < 1e-8
    assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-12)


def test_a_mirror_plane_holds_a_body_by_its_name(caplog):
    """Its nodes need not lie in the plane, and keep their normals."""
    mesh = extruded(TEE, 1, 1)
    supports = [ms.Clamp("near"), ms.SymmetryPlane("end", (1, 2, 3))]
    loads = [ms.Force("joint", FORCE)]
    held = ms.Model(shell(mesh, rigid=[ms.RigidBody("far", name="end")]), supports, loads=loads)
    free = ms.Model(shell(mesh, rigid=[ms.RigidBody("far", name="end")]), supports[:1], loads=loads)
    assert np.array_equal(held.rows.normals, free.rows.normals)
    assert not caplog.records


@pytest.mark.parametrize("stiffness", [0.0, 1e-5])
@pytest.mark.parametrize("group", ["joint", "sheet1"])
def test_a_hinge_that_a_body_keeps_from_turning_is_refused(group, stiffness):
    made = shell(extruded(FLAT), rigid=[ms.RigidBody(group, name="bar")], hinges=[ms.Hinge("joint", stiffness)])
    with pytest.raises(ms.errors.InputError, match=r"hinge on 'joint': .* belongs to rigid body 'bar'"):
        ms.Model(made, [ms.Clamp("near")], loads=[ms.Force("far", FORCE)])


def test_upside_down_sheets_are_one_strip():
    """With a magnet in the strip and loads on the joints."""
    found = []
    for lines in (FLAT, UPSIDE_DOWN):
        mesh = extruded(lines, 6, 1)
        points = mesh.points
        ends = np.array([edge for edge in mesh.boundary_edges if np.allclose(points[edge, 0], 2.0)])
        mesh = Mesh(points, mesh.elements, mesh.element_groups, {**mesh.edge_groups, "tip": ends})
        loads = [ms.Force("tip", (0, 0, 2e-6)), ms.Moment("joint", (0, 1e-6, 0))]
        model = ms.Model(shell(mesh, 1e-8), [ms.Clamp("near")], FIELD, loads=loads)
        path = ms.solve(model)
        found.append(path.steps[-1].state.displacement(len(points))[mesh.nodes_of("tip")].mean(axis=0))
    assert np.linalg.norm(found[1] - found[0]) < 1e-3 * np.linalg.norm(found[0])


def test_a_wholly_rigid_shell_on_springs_turns_like_a_needle():
    """θ with K θ cos θ-like lever: two springs against the couple of the field on it."""
    mesh = ms.mesh.rectangle(1.0, 0.2, (2, 1))
    mesh = Mesh(mesh.points, mesh.elements, {"all": [0, 1]}, mesh.edge_groups)
    body = ms.RigidBody("all", name="plate", moment=(2e-2, 0, 0))
    springs = [ms.Spring("left", 1e-3), ms.Spring("right", 1e-3)]
    model = ms.Model(shell(mesh, rigid=[body]), [], ms.UniformField((0, 0, 1e-2)), springs=springs)
    path = ms.solve(replace(model), SHARP)
    θ = -rotation.logarithm(row_of(path)[2][None])[0, 1]
    # Springs at x = ±1/2 stretch by 1 - cos θ and sin θ over 2: energy k (1 - cos θ)/2, so tan θ = 2 m B / k.
    assert np.tan(θ) == pytest.approx(2.0 * 2e-2 * 1e-2 / 1e-3, rel=1e-8)


def test_the_reason_of_a_failure_names_rigid_bodies():
    """A load a thousand times too large on a body that a support holds by its name."""
    made = shell(extruded(FLAT, 1, 1), rigid=[ms.RigidBody("far", name="end")])
    supports = [ms.Clamp("near"), ms.Prescribe("end", "u", 2)]
    with pytest.raises(ms.SolveError, match="stopped at load factor"):
        ms.solve(ms.Model(made, supports, loads=[ms.Moment("joint", (0, 0, 1.0)), ms.Force("end", (-10.0, 0, 0))]))
