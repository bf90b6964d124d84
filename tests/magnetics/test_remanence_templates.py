"""What a part keeps that was magnetised while it was rolled, folded or bent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import magshell as ms
from magnetics.test_remanence_fields import integration_points
from magshell.equations.discretisation import Discretisation
from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.magnetics import remanence
from magshell.magnetics.remanence import Fold
from magshell.magnetics.remanence.folds import Folded
from magshell.shell import rotation

LENGTH, WIDTH = 12e-3, 4e-3
HEIGHT, MU = 0.2e-3, 1e5
STRIP = ms.mesh.rectangle(LENGTH, WIDTH, (8, 2))
POINTS = integration_points(STRIP)
X1, X2, X3 = np.eye(3)


def roll(radius):
    return remanence.rolled(radius, through=(0, 0, 0), along=X1, towards=X3)


def test_a_rolled_strip_remembers_a_turning_direction():
    """Rolled towards X3, a point at X1 = s has turned by s/r; in a field along X3 it keeps (sin, 0, cos) of that."""
    radius = LENGTH / (2 * np.pi)
    values = remanence.template(roll(radius), 62e-3, (0, 0, 2.0))(STRIP, POINTS)
    θ = POINTS[..., 0] / radius
    expected = 62e-3 * np.stack([np.sin(θ), 0 * θ, np.cos(θ)], axis=-1)
    assert np.abs(values - expected).max() < 1e-15, np.abs(values - expected).max()


def test_it_is_a_harmonic_profile():
    """The two ways to say it agree: rolled once round in a field along X3, and one wave that begins at 90°."""
    rolled = remanence.template(roll(LENGTH / (2 * np.pi)), 62e-3, X3)
    wave = remanence.profile(62e-3, (0, LENGTH), X1, X1, np.radians((90, -270)), X3)
    assert np.abs(rolled(STRIP, POINTS) - wave(STRIP, POINTS)).max() < 1e-15


def test_rolled_points_lie_on_the_cylinder():
    radius = 3e-3
    placed = roll(radius).place(STRIP, POINTS).positions
    assert np.abs(np.hypot(placed[..., 0], placed[..., 2] - radius) - radius).max() < 1e-17
    assert np.array_equal(placed[..., 1], POINTS[..., 1])


def test_what_lies_before_the_line_stays_flat():
    values = remanence.template(
        remanence.rolled(2e-3, through=(LENGTH / 2, 0, 0), along=X1, towards=X3), 1.0, X3
    )(STRIP, POINTS)  # fmt: skip
    flat = POINTS[..., 0] < LENGTH / 2
    assert np.array_equal(values[flat], np.broadcast_to(X3, values[flat].shape))
    assert (np.abs(values[~flat] - X3).max(axis=-1) > 1e-3).all()


def test_a_zigzag_of_sharp_folds():
    """Three panels at 0°, 60° up and back to 0°: the second remembers the field turned back by 60°."""
    angle = np.radians(60)
    up = Fold((LENGTH / 4, 0, 0), X1, X3, angle)
    down = Fold((LENGTH / 2, 0, 0), X1, -X3, angle)
    values = remanence.template(remanence.folded(up, down), 1.0, X3)(STRIP, POINTS)
    panel = np.digitize(POINTS[..., 0], (LENGTH / 4, LENGTH / 2))
    expected = np.array([X3, [np.sin(angle), 0, np.cos(angle)], X3])[panel]
    assert np.abs(values - expected).max() < 1e-15
    x = Folded((up, down)).place(STRIP, POINTS).positions
    rise = (LENGTH / 4) * np.sin(angle)
    assert np.abs(x[panel == 2][:, 2] - rise).max() < 1e-17
    assert np.abs(x[panel == 2][:, 0] - (POINTS[panel == 2][:, 0] - LENGTH / 4 * (1 - np.cos(angle)))).max() < 1e-17


def test_a_round_fold_becomes_sharp():
    sharp = remanence.template(remanence.folded(Fold((LENGTH / 2, 0, 0), X1, X3, 1.0)), 1.0, X1)
    round_ = remanence.template(remanence.folded(Fold((LENGTH / 2, 0, 0), X1, X3, 1.0, radius=1e-9)), 1.0, X1)
    assert np.abs(sharp(STRIP, POINTS) - round_(STRIP, POINTS)).max() < 1e-15


def folds():
    """A fold of the strip somewhere, along any direction."""
    angle = st.floats(0.1, 3.1)
    place = st.tuples(st.floats(0.2, 0.8), st.floats(0.2, 0.8))
    return st.builds(
        lambda at, turn, side, angle, radius: Fold(
            (at[0] * LENGTH, at[1] * WIDTH, 0), (np.cos(turn), np.sin(turn), 0), side * X3, angle, radius
        ),
        place, st.floats(0, 2 * np.pi), st.sampled_from((-1, 1)), angle, st.sampled_from((0.0, 0.4e-3, 2e-3)),
    )  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(fold=folds())
def test_rotation_is_the_gradient_of_the_position(fold):
    """In the surface: x(X + δ) - x(X) = R δ, away from the ends of the arc."""
    shape, step = Folded((fold,)), 1e-6
    here = shape.place(STRIP, POINTS)
    s = fold.reach(POINTS)
    smooth = (np.abs(s) > 10 * step) & (np.abs(s - fold.arc) > 10 * step)
    curvature = 0.0 if fold.radius == 0.0 else 1.0 / fold.radius
    for axis in (X1, X2):
        moved = shape.place(STRIP, POINTS + step * axis).positions - here.positions
        error = np.abs(moved / step - here.rotations @ axis).max(axis=-1)[smooth]
        assert error.max() < step * curvature + 1e-9, error.max()
    R = here.rotations
    assert np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3)).max() < 1e-14
    assert np.abs(np.linalg.det(R) - 1.0).max() < 1e-14


@settings(max_examples=30, deadline=None)
@given(
    fold=folds(),
    q=st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_objectivity(fold, q):
    """Part, template and field turned together: the remanence turns with them."""
    Q = rotation.matrix(np.array(q) / np.linalg.norm(q))
    b, shift = np.array([0.3, -0.5, 0.8]), np.array([5e-3, -2e-3, 1e-3])
    turned = ms.mesh.Mesh(STRIP.points @ Q.T + shift, STRIP.elements)
    same = Fold(Q @ fold.through + shift, Q @ fold.along, Q @ fold.towards, fold.angle, fold.radius)
    values = remanence.template(remanence.folded(fold), 0.1, b)(STRIP, POINTS)
    away = np.abs(fold.reach(POINTS)) > 1e-9
    found = remanence.template(remanence.folded(same), 0.1, Q @ b)(turned, POINTS @ Q.T + shift)
    assert np.abs(found - values @ Q.T)[away].max() < 1e-9


def test_displacements_of_a_roll_say_the_same_to_the_order_of_the_elements():
    radius, b = 4e-3, np.array([0.2, 0.5, 1.0])
    worst = []
    for number in (8, 16):
        mesh = ms.mesh.rectangle(LENGTH, WIDTH, (number, 2))
        points = integration_points(mesh)
        u = roll(radius).place(mesh, mesh.points[None]).positions[0] - mesh.points
        exact = remanence.template(roll(radius), 0.1, b)(mesh, points)
        found = remanence.template(remanence.deformed(u), 0.1, b)(mesh, points)
        assert np.abs(np.linalg.norm(found, axis=-1) - 0.1).max() < 1e-15
        worst.append(np.abs(found - exact).max() / 0.1)
    assert worst[1] < 0.3 * worst[0], worst
    assert worst[1] < (LENGTH / 16 / radius) ** 2 / 12, worst


def test_a_stretched_template_gives_the_polar_rotation():
    """F = R U with a uniform stretch in the plane: R alone turns the remanence."""
    c, s = np.cos(0.7), np.sin(0.7)
    R = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])
    U = np.array([[1.3, 0.1, 0], [0.1, 0.8, 0], [0, 0, 1]])
    b = np.array([0.1, 0.7, -0.4])
    b /= np.linalg.norm(b)
    shift = np.array([1e-3, 2e-3, 3e-3])
    remembered = remanence.template(remanence.deformed(lambda x: x @ (R @ U).T + shift), 0.2, b)
    values, there = remembered(STRIP, POINTS), remanence.placed(remembered, STRIP, POINTS)
    assert np.abs(values - 0.2 * R.T @ b).max() < 1e-14
    assert np.abs(there - POINTS @ (R @ U).T - shift).max() < 1e-17


@pytest.fixture(scope="module")
def bent():
    """The strip bent by a moment at its end, and its path."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (8, 1))
    moment = 2 * MU * WIDTH * HEIGHT**3 / 12 * np.pi / LENGTH
    shell = ms.Shell(mesh, HEIGHT, ms.MicropolarNeoHookean(MU, 0.0, 0.0, 0.0), micro_rotation=False)
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], loads=[ms.Moment("right", (0, -moment, 0))]))


def test_remanence_of_a_bent_strip_is_uniform_when_it_is_bent_again(bent):
    """Magnetised in the state of a solve, released, and brought back: uniform along b.

    What the shell itself carries there, F Brem / J, differs by its strains, of which the largest is hκ/2.
    """
    b, mesh, strain = np.array([0.6, 0.0, 0.8]), bent.model.shell.mesh, 0.5 * HEIGHT * np.pi / LENGTH
    remembered = remanence.template(remanence.deformed(bent), 0.1, b)
    points = integration_points(mesh)
    released = remembered(mesh, points)
    spread = np.ptp(np.unwrap(np.arctan2(released[:, :, 2], released[:, :, 0]).mean(axis=1)))
    assert spread == pytest.approx(np.pi * 7 / 8, rel=strain), "the middles of the outer elements, π 7/8 apart"
    R = remanence.deformed(bent.steps[-1].state).place(mesh, points).rotations
    assert np.abs(np.einsum("epij,epj->epi", R, released) - 0.1 * b).max() < 1e-15
    magnetic = replace(bent.model, shell=replace(bent.model.shell, remanence=remembered))
    carried = converged(Discretisation(magnetic, natural_order), bent.steps[-1]).remanence()
    off = np.abs(carried - 0.1 * b).max() / 0.1
    assert off < strain, (off, strain)


def natural_order(graph):
    """Elimination of the nodes as they are numbered."""
    return np.arange(graph.shape[0])


@pytest.mark.parametrize("k", [1.0, 4.0])
def test_a_strip_returns_to_its_template_as_an_elastic_line_does(k):
    """Magnetised on an arc of radius r, flat when released, in a field along b again.

    The couple b × R Brem turns a section by θ(s) towards s/r: E I θ'' = (B M A / μ0) sin(θ - s/r), and for small angles
    θ = s/r - sinh(κs) / (κ r cosh(κL)) with κ² = B M A / (μ0 E I) = (k/L)².
    """
    arc, magnitude, young, b = 0.1, 0.1, 2.0 * MU, np.array([0.6, 0.0, 0.8])
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (12, 1))
    remembered = remanence.template(roll(LENGTH / arc), magnitude, b)
    material = ms.MicropolarNeoHookean(MU, 0.0, 0.0, 0.0)
    flux = (k / LENGTH) ** 2 * 4e-7 * np.pi * young * HEIGHT**2 / 12 / magnitude
    shell = ms.Shell(mesh, HEIGHT, material, remembered, micro_rotation=False)
    clamped, field = [ms.Clamp("left")], ms.UniformField(flux * b)
    path = ms.solve(ms.Model(shell, clamped, field, ms.DeformationGradientEnergy()), ms.Settings(first_step=0.5))
    tip = mesh.node_at((LENGTH, 0, 0))
    director = converged(path.discretisation, path.steps[-1]).director()[tip]
    found = np.arctan2(-director[0], director[2])
    expected = arc * (1.0 - np.tanh(k) / k)
    small_angles, shear = arc**2 / 6, (HEIGHT / LENGTH * k) ** 2
    assert found == pytest.approx(expected, rel=small_angles + shear), (found / expected - 1, small_angles, shear)


def test_groups_of_templates_are_placed_and_the_rest_stays():
    corners = {"still": [(0, 0), (1, 0), (1, 1), (0, 1)], "flap": [(1, 0), (2, 0), (2, 1), (1, 1)]}
    mesh = ms.mesh.blocks(corners, elements=(2, 2))
    points = integration_points(mesh)
    flap = remanence.template(remanence.folded(Fold((1, 0, 0), X1, X3, np.pi / 2)), 0.1, X1)
    values = remanence.by_group({"flap": flap, "still": remanence.constant(X2)})
    there = remanence.placed(values, mesh, points)
    still, moved = mesh.elements_of("still"), mesh.elements_of("flap")
    assert np.array_equal(there[still], points[still])
    assert np.abs(there[moved][..., 0] - 1).max() < 1e-15
    assert np.abs(there[moved][..., 2] - (points[moved][..., 0] - 1)).max() < 1e-15
    assert np.abs(values(mesh, points)[moved] - 0.1 * -X3).max() < 1e-16
    assert remanence.placed(remanence.by_group({"still": remanence.constant(X2)}), mesh, points) is None
    assert remanence.placed(remanence.constant(X2), mesh, points) is None


TUBE = ms.mesh.cylinder(5e-3, 5e-3, elements=(4, 1), angle=(0, 90))


@pytest.mark.parametrize(
    ("shape", "mesh", "words"),
    [
        (lambda: roll(1e-3), TUBE, r"element \d+ lies .* off the plane .* or rolled$"),
        (lambda: remanence.folded(), STRIP, "there are no folds"),
        (lambda: remanence.rolled(0.0, (0, 0, 0), X1, X3), STRIP, "needs an angle, or a radius"),
        (lambda: remanence.rolled(-1.0, (0, 0, 0), X1, X3), STRIP, "radius is -1.0 m"),
        (lambda: remanence.rolled(1.0, (0, 0, 0), X1, (1, 0, 1)), STRIP, "towards must be normal to along"),
        (lambda: Fold((0, 0, 0), X1, X3, 4.0), STRIP, "a sharp fold turns by 180 at most"),
        (lambda: Fold((0, 0, 0), X1, X3, -1.0), STRIP, "must be positive"),
        (
            lambda: remanence.folded(Fold((0, 0, 0), X1, X3, radius=1.0), Fold((5e-3, 0, 0), X1, X3, 1.0)),
            STRIP,
            r"folds\[1\] begins before folds\[0\] has ended, in element",
        ),
        (lambda: remanence.deformed(np.zeros((3, 3))), STRIP, r"displacements have shape \(3, 3\); the mesh needs"),
        (lambda: remanence.deformed(lambda x: x[:, :2]), STRIP, "function returned positions of shape"),
        (lambda: remanence.deformed(lambda x: 0 * x), STRIP, "crushes element 0"),
        (lambda: remanence.deformed(np.full(STRIP.points.shape, np.nan)), STRIP, "node 0 is not finite"),
    ],
)
def test_templates_that_make_no_sense(shape, mesh, words):
    with pytest.raises(InputError, match=words):
        remanence.template(shape(), 0.1, X3)(mesh, integration_points(mesh))
