"""Reactions: the derivative of the energy under a motion of the support; hand statics where there is no energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from solver.models import LENGTH, THICKNESS, WIDTH, arm, rubber, strip

import magshell as ms
from magshell import DeformationGradientEnergy, MicroRotationEnergy, Model, Settings, solve
from magshell.equations.instant import Instant
from magshell.errors import InputError
from magshell.evaluation.converged import Converged, converged
from magshell.linalg import make_solver
from magshell.model.named_supports import split
from magshell.shell.unknowns import COLUMNS, COMPONENTS

SHARP = Settings(tolerance=1e-11)
ENERGIES = [DeformationGradientEnergy(), MicroRotationEnergy()]
MU0 = 4e-7 * np.pi


def resolved(d, state, loading):
    """Equilibrium near a state, what is held staying as it is."""
    for _ in range(12):
        assembly = d.assemble(Instant(state, loading))
        if assembly.worst[1] < 1e-13:
            break
        state = d.moved(
            state, d.correction(make_solver("superlu").factorise(assembly.matrix).solve(assembly.right_side))
        )
    return state


def potential(d, state, loading):
    """Elastic and magnetic energy less the work of dead forces on u, J."""
    return Converged(d, state, loading).energies.sum() - np.vdot(d.loads.forces(state, loading.loads)[:, :3], state.u)


def rigid(d, state, support, motion):
    """What a rigid motion (translation, rotation about the support's point) does to what it holds, to first order."""
    nodes = len(d.mesh.points)
    x, normal = d.mesh.points + state.u[:nodes], d.normals + state.w[:nodes]
    centre = support.weights @ x if support.point is None else support.point
    increment = np.zeros((len(state.u), COMPONENTS))
    increment[:nodes, :3] = motion[:3] + np.cross(motion[3:], x - centre)
    increment[:nodes, 3:6] = np.cross(motion[3:], normal)
    increment[:nodes, COLUMNS["omega"]] = motion[3:]
    own = np.zeros(len(state.u), dtype=bool)
    own[support.nodes] = True
    held = d.model.constraints.fixed & own[:, None]
    return d.rows.shared(d.to_global(np.where(held, d.to_frames(increment), 0.0)))


def derivative(d, state, loading, increment, size):
    """Of the potential at equilibrium along an increment, by a difference of the fourth order."""

    def at(step):
        there = state.moved(step * increment, np.zeros_like(state.alpha))
        return potential(d, resolved(d, there, loading), loading)

    def central(step):
        return (at(step) - at(-step)) / (2.0 * step)

    return (4.0 * central(size) - central(2.0 * size)) / 3.0


def check_reaction(path, name, motions=range(6)):
    """Each component of a support's reaction is the derivative of the potential under its motion."""
    d, step = path.discretisation, path.steps[-1]
    reached = converged(d, step)
    (reaction,) = (one for one in reached.reactions if one.name == name)
    (support,) = (one for one in path.model.named_supports if one.name == name)
    for motion in motions:
        increment = rigid(d, step.state, support, np.eye(6)[motion])
        size = 1e-4 * (d.mesh.size if motion < 3 else 1.0)
        found = derivative(d, step.state, reached.loading, increment, size)
        expected = np.concatenate([reaction.force, reaction.moment])[motion]
        arm = 1.0 if motion < 3 else d.mesh.size
        scale = max(np.abs(reaction.force).max() * arm, np.abs(reaction.moment).max() * arm / d.mesh.size)
        assert abs(found - expected) < 1e-6 * scale, f"motion {motion}: {found:.9e} for {expected:.9e} ({scale:.1e})"


@pytest.mark.parametrize("coupling", ENERGIES, ids=lambda one: type(one).__name__)
def test_reaction_is_the_derivative_of_the_energy(coupling):
    """A curved arm held at both ends, pulled by a force, the far end moved and turned with it."""
    one = arm((4, 2), field=4e-3, coupling=coupling)
    mesh = one.shell.mesh.select_nodes("equator", x1=22.918e-3, x2=0.0, x3=0.0)
    supports = [
        ms.Clamp("top"),
        ms.Prescribe("bottom", "u", value=(1e-3, 0.5e-3, -1e-3)),
        ms.Prescribe("bottom", "omega", value=0.0),
        ms.Prescribe("bottom", "w", value=0.0),
    ]
    load = ms.Force("equator", (2e-3, -1e-3, 3e-3))
    model = replace(one, shell=replace(one.shell, mesh=mesh), supports=supports, loads=[load])
    path = solve(model, SHARP)
    assert [support.name for support in model.named_supports] == ["top", "bottom"]
    check_reaction(path, "bottom")
    check_reaction(path, "top", [1, 3])


def test_reaction_about_a_point_and_in_a_slanted_plane():
    """A plane that holds u, w and ω in oblique directions takes a force along its normal."""
    point = (3e-3, -1e-3, 2e-3)
    normal = np.array([1.0, 2.0, 2.0]) / 3.0
    supports = [ms.Clamp("left"), ms.SymmetryPlane("right", normal, name="wall", point=point)]
    model = strip(supports=supports, field=(5e-3, 0.0, 20e-3), coupling=DeformationGradientEnergy())
    path = solve(model, SHARP)
    check_reaction(path, "wall")
    (wall,) = (one for one in converged(path.discretisation, path.steps[-1]).reactions if one.name == "wall")
    assert np.array_equal(wall.point, point)
    assert np.linalg.norm(np.cross(wall.force, normal)) < 1e-12 * np.linalg.norm(wall.force)


def test_reaction_of_clamps_across_a_step_of_the_thickness():
    """Thick and thin meet at nodes of both clamps; the thin part is flush with the top of the thick one."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2))
    rows = [np.flatnonzero((mesh.points[mesh.elements].mean(axis=1)[:, 1] > WIDTH / 2) == side) for side in (0, 1)]
    mesh = replace(mesh, element_groups={"thick": rows[0], "thin": rows[1]})
    thin = ms.Region("thin", thickness=0.5 * THICKNESS, material=rubber(0.5 * THICKNESS), offset=-0.25 * THICKNESS)
    shell = ms.Shell(mesh, THICKNESS, rubber(), ms.remanence.constant((143e-3, 0.0, 0.0)), regions=[thin])
    supports = [ms.Clamp("left"), ms.Prescribe("right", "u", value=(0, 0, 1e-3)), ms.Prescribe("right", "w")]
    field, stops = ms.UniformField((0.0, 3e-3, 10e-3)), [ms.Stage(stops=[0.25, 0.5])]
    path = solve(Model(shell, supports, field, DeformationGradientEnergy(), stages=stops), SHARP)
    assert len(path.steps[-1].state.u) > len(mesh.points), "rows of their own at the step"
    check_reaction(path, "left")
    check_reaction(path, "right")


def test_supports_that_share_nodes_count_nothing_twice():
    """A corner is held by two of them: all reactions sum to the loads, and each is its energy's derivative."""
    supports = [ms.Clamp("left"), ms.SimpleSupport("bottom", name="rail"), ms.Prescribe("top", "u", 2, name="rail")]
    model = strip(supports=supports, field=(0, 0, 20e-3), coupling=MicroRotationEnergy())
    mesh = model.shell.mesh.select_nodes("corner", x1=LENGTH, x2=WIDTH)
    model = replace(model, shell=replace(model.shell, mesh=mesh), loads=[ms.Force("corner", (0.05, 0.02, -0.1))])
    path = solve(model, SHARP)
    found = converged(path.discretisation, path.steps[-1]).reactions
    assert [one.name for one in found] == ["left", "rail"]
    assert np.abs(sum(one.force for one in found) - [-0.05, -0.02, 0.1]).max() < 1e-9
    arms = [np.cross(one.point, one.force) + one.moment for one in found]
    assert np.abs(sum(arms) - path.steps[-1].balance.reaction_moment).max() < 1e-15
    check_reaction(path, "left", [0, 2, 4])


@pytest.mark.parametrize("seed", range(20))
def test_split_of_a_nodes_force_among_supports(seed):
    """Shares add up, lie in what each support holds, and are the derivatives for independent directions."""
    random = np.random.default_rng(seed)
    counts = random.permutation([1, 1, 1, 2, 3])[: 2 + seed % 3]
    held = [random.normal(size=(count, 3)) for count in counts]
    if seed % 4 == 0:
        held[1] = np.concatenate([held[0][:1], held[1]])
    shares = split(held)
    _, _, base = np.linalg.svd(np.concatenate(held))
    force = random.normal(size=3)
    rank = np.linalg.matrix_rank(np.concatenate(held))
    force = base[:rank].T @ base[:rank] @ force
    parts = [share @ force for share in shares]
    assert np.abs(sum(parts) - force).max() < 1e-10
    for part, directions in zip(parts, held, strict=True):
        coefficients = np.linalg.lstsq(directions.T, part, rcond=None)[0]
        assert np.abs(directions.T @ coefficients - part).max() < 1e-10
    if sum(map(len, held)) == rank:
        motion = random.normal(size=3)
        values = [directions @ (motion if number == 0 else np.zeros(3)) for number, directions in enumerate(held)]
        moved_by = np.linalg.lstsq(np.concatenate(held), np.concatenate(values), rcond=None)[0]
        assert force @ moved_by == pytest.approx(parts[0] @ motion, abs=1e-10)


def test_the_first_support_takes_what_two_hold():
    plane, clamp = split([np.array([[1.0, 1.0, 0.0]]) / np.sqrt(2.0), np.eye(3)])
    assert np.abs(plane @ [0.0, 1.0, 0.0] - [0.5, 0.5, 0.0]).max() < 1e-15
    assert np.abs(clamp @ [0.0, 1.0, 0.0] - [-0.5, 0.5, 0.0]).max() < 1e-15


def cantilever(field, loads, elements=(10, 1)):
    """A strip with weight, of elements whose loads have no bubble, held on the left."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    remanence = ms.remanence.constant((143e-3, 0.0, 0.0))
    shell = ms.Shell(mesh, THICKNESS, rubber(), remanence, element="paper", density=2000.0)
    return Model(shell, [ms.Clamp("left", name="foot")], ms.UniformField(field), probes={}, loads=loads)


def tip_of(model, state):
    """Mean deformed position along the right edge, of one element: Simpson's rule is exact."""
    mesh = model.shell.mesh
    start, end, middle = ((LENGTH, 0, 0), (LENGTH, WIDTH, 0), (LENGTH, WIDTH / 2, 0))
    x = mesh.points + state.u
    return (x[mesh.node_at(start)] + x[mesh.node_at(end)] + 4.0 * x[mesh.node_at(middle)]) / 6.0


def over_the_surface(mesh, values):
    """Integrals (3,) of nodal values (nodes, 3) over the undeformed strip, m²: rectangles of equal size."""
    weights = np.array([-1.0, -1.0, -1.0, -1.0, 4.0, 4.0, 4.0, 4.0]) / 12.0
    area = LENGTH * WIDTH / len(mesh.elements)
    return area * np.einsum("n,enx->x", weights, values[mesh.elements])


def test_clamp_under_a_tip_force_and_weight_by_hand():
    """Force and moment follow from where the loads are, however far the strip has bent."""
    force, acceleration = np.array([-2e-3, 1e-3, -9e-3]), np.array([0.0, 5.0, -40.0])
    model = cantilever((0, 0, 0), [ms.Force("right", force), ms.Gravity(acceleration)])
    path = solve(model, SHARP)
    state, mesh = path.steps[-1].state, model.shell.mesh
    assert np.degrees(np.arcsin(-(state.u[mesh.nodes_of("right"), 2] / LENGTH).min())) > 25.0
    (foot,) = converged(path.discretisation, path.steps[-1]).reactions
    mass = 2000.0 * THICKNESS * LENGTH * WIDTH
    root = np.array([0.0, WIDTH / 2, 0.0])
    assert np.abs(foot.point - root).max() < 1e-15
    assert np.abs(foot.force + force + mass * acceleration).max() < 1e-9 * np.linalg.norm(force)
    x, tip = mesh.points + state.u - root, tip_of(model, state) - root
    weight = 2000.0 * THICKNESS * np.cross(over_the_surface(mesh, x), acceleration)
    expected = -np.cross(tip, force) - weight
    assert np.abs(foot.moment - expected).max() < 1e-9 * np.linalg.norm(expected), (foot.moment, expected)


def test_clamp_against_the_magnetic_couple_by_hand():
    """Magnetised along X1, the couple ∫ (F B̃) × B / mu0 dV is b h B̃ / mu0 (x_tip - x_root) × B: F E1 is ∂x/∂X1."""
    model = cantilever((0, 0, 30e-3), [])
    path = solve(model, SHARP)
    tip = tip_of(model, path.steps[-1].state)
    assert tip[2] / LENGTH > 0.6
    (foot,) = converged(path.discretisation, path.steps[-1]).reactions
    couple = WIDTH * THICKNESS * 143e-3 / MU0 * np.cross(tip - [0, WIDTH / 2, 0], [0, 0, 30e-3])
    assert np.abs(foot.moment + couple).max() < 1e-9 * np.linalg.norm(couple), (foot.moment, couple)
    assert np.abs(foot.force).max() * LENGTH < 1e-9 * np.linalg.norm(couple)


def test_work_of_the_field_is_stored():
    """By the trapezoidal rule, so its error falls with the square of the steps."""
    errors = []
    for count in (8, 16):
        stops = [20e-3 * (i + 1) / count for i in range(count)]
        path = solve(strip(stops=stops), Settings(tolerance=1e-11, first_step=1.0 / count))
        table = dict(zip(path.history.columns, path.history.rows(path.steps)[-1], strict=True))
        assert len(path.steps) == count + 1
        assert table["magnetic"] is None
        assert table["work"] == 0.0
        errors.append(table["work_field"] / table["elastic"] - 1.0)
    assert 3.0 < errors[0] / errors[1] < 5.0, errors
    assert abs(errors[1]) < 2e-3


def test_work_of_loads_and_moving_supports_is_stored():
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 1))
    shell, supports = ms.Shell(mesh, THICKNESS, rubber()), [ms.Clamp("left"), ms.Prescribe("right", "u", 3, 3e-3)]
    errors = []
    for count in (8, 16):
        stage = ms.Stage(stops=[(i + 1) / count for i in range(count)])
        model = Model(shell, supports, loads=[ms.Force("right", (0.1, 0, 0))], stages=[stage])
        path = solve(model, Settings(tolerance=1e-11, first_step=1.0 / count))
        table = dict(zip(path.history.columns, path.history.rows(path.steps)[-1], strict=True))
        assert len(path.steps) == count + 1
        assert table["work_field"] == 0.0
        errors.append(table["work"] / table["elastic"] - 1.0)
    assert 3.0 < errors[0] / errors[1] < 5.0, errors
    assert abs(errors[1]) < 5e-3


def test_work_on_a_branch_is_stored():
    """A stage that starts at a critical point takes the work up to there, not that of the steps beyond it."""
    shell = ms.Shell(ms.mesh.rectangle(LENGTH, WIDTH, (4, 1)), THICKNESS, rubber())
    load = ms.Force("right", (-0.03, 0, 0), history=(1, 1.2))
    stages = [ms.Stage(), ms.Stage(control="arc-length", branch=1)]
    path = solve(Model(shell, [ms.Clamp("left")], loads=[load], stages=stages), Settings(tolerance=1e-10))
    rows = [dict(zip(path.history.columns, row, strict=True)) for row in path.history.rows(path.steps)]
    ends = [max(number for number, row in enumerate(rows) if row["stage"] == stage) for stage in (1, 2)]
    assert rows[ends[1]]["elastic"] > 1.5 * rows[ends[0]]["elastic"]
    for end in ends:
        assert rows[end]["work"] == pytest.approx(rows[end]["elastic"], rel=2e-2)


def test_a_law_with_energy_has_no_work_of_the_field():
    path = solve(strip(coupling=DeformationGradientEnergy()), SHARP)
    table = dict(zip(path.history.columns, path.history.rows(path.steps)[-1], strict=True))
    assert table["work_field"] is None
    assert table["magnetic"] < 0.0


@pytest.mark.parametrize(
    ("supports", "message"),
    [
        ([ms.Clamp("left", point=(0, 0))], r"support on 'left': point is \(0, 0\)"),
        ([ms.Clamp("left", point=(0, 0, np.nan))], "needs 3 finite coordinates"),
        ([ms.Clamp("left", name="")], "name is ''"),
        (
            [ms.Clamp("left", point=(0, 0, 0)), ms.SimpleSupport("right", name="left", point=(0, 0, 1))],
            "different points",
        ),
    ],
)
def test_bad_names_and_points(supports, message):
    with pytest.raises(InputError, match=message):
        strip(supports=supports)
