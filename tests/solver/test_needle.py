"""Compass needles: bodies that supports let turn and the field alone holds."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from scipy.optimize import brentq

import magshell as ms
from magshell.errors import InputError
from magshell.magnetics.fields import Field
from magshell.magnetics.fields.dipoles import Sphere
from magshell.magnetics.fields.sources import Source
from magshell.solver.events import Observer
from magshell.solver.retracing import path_through
from magshell.solver.waypoint import Waypoint

LENGTH, WIDTH, THICKNESS = 20e-3, 4e-3, 1e-3
MIDDLE = np.array([0.5 * LENGTH, 0.5 * WIDTH, 0.0])
REMANENCE, FIELD = 0.1, 20e-3
MOMENT = REMANENCE * LENGTH * WIDTH * THICKNESS / (4e-7 * np.pi)
STIFF = ms.MicropolarNeoHookean(300e6, 7.5e9)
PIN = ms.SimpleSupport("middle")
HELD = {axis: ms.Prescribe("middle", "omega", axis, 0.0) for axis in (1, 2, 3)}
ALONG_1 = (FIELD, 0.0, 0.0)
# Of inner forces, whose modulus is 10^5.3 times the couple B_rem B / mu0: the solver cannot see less.
ROUND_OFF = 1e-7


def needle(direction, supports, field=ALONG_1, material=STIFF, **more):
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2))
    mesh = mesh.select_nodes("middle", within=lambda x: np.linalg.norm(x - MIDDLE, axis=1) < 1e-6)
    shell = ms.Shell(mesh, THICKNESS, material, ms.remanence.constant(REMANENCE * np.asarray(direction)))
    field = field if isinstance(field, Field) else ms.UniformField(field)
    probes = {"right": (LENGTH, MIDDLE[1], 0.0), "left": (0.0, MIDDLE[1], 0.0)}
    return ms.Model(shell, supports, field, probes=probes, **more)


def axis_of(path):
    """From the left to the right end at each step (steps, 3), of length 1."""
    between = path.probe("right").u - path.probe("left").u + np.array([LENGTH, 0.0, 0.0])
    return between / np.linalg.norm(between, axis=1)[:, None]


def at(angle):
    return np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, 150.0, -179.9])
def test_a_needle_turns_into_the_field(angle):
    """Magnetised at an angle to its axis it ends at minus that angle, from the first field on; nothing holds it."""
    path = ms.solve(needle(at(angle), [PIN, HELD[1]]))
    assert path.converged
    np.testing.assert_allclose(axis_of(path)[1:], np.tile(at(-angle), (len(path.steps) - 1, 1)), atol=ROUND_OFF)
    assert {step.negative_pivots for step in path.steps[1:]} == {0}
    reaction = path.summary["reactions"]["middle"]
    assert np.abs(reaction["force"]).max() < ROUND_OFF * MOMENT * FIELD / LENGTH
    assert np.abs(reaction["moment"]).max() < ROUND_OFF * MOMENT * FIELD
    assert path.summary["moment_imbalance"] < ROUND_OFF
    assert path.summary["force_imbalance"] < ROUND_OFF


def test_out_of_the_plane():
    """Magnetised through its thickness, about the axis across."""
    path = ms.solve(needle((0.0, 0.0, 1.0), [PIN, HELD[1], HELD[3]]))
    np.testing.assert_allclose(axis_of(path)[-1], [0.0, 0.0, -1.0], atol=ROUND_OFF)


def test_a_soft_needle_bends_beside():
    """One half magnetised along, the other across: the field turns it as a whole and bends it."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (8, 2)).select_nodes(
        "middle", within=lambda x: np.linalg.norm(x - MIDDLE, axis=1) < 1e-6
    )
    halves = ms.remanence.function(lambda x: np.where(x[..., :1] < MIDDLE[0], [0.1, 0, 0], [0, 0, 0.1]))
    shell = ms.Shell(mesh, THICKNESS, ms.MicropolarNeoHookean(300e3, 7.5e6), halves)
    path = ms.solve(ms.Model(shell, [PIN, HELD[1], HELD[3]], ms.UniformField(ALONG_1)))
    assert path.converged
    assert np.linalg.norm(path.summary["magnetic_torque"]) < 1e-6 * MOMENT * FIELD
    first, last = (path.steps[number].state.u for number in (1, -1))
    assert np.abs(last - first).max() > 0.1 * THICKNESS
    assert path.summary["moment_imbalance"] < 1e-6


def test_it_follows_a_field_that_turns():
    """About a hinge, by 120°."""
    field = ms.UniformField(ALONG_1, history=[1.0, 1.0], rotation_axis=(0, 0, 1), rotation=[0.0, np.radians(120.0)])
    path = ms.solve(needle(at(40.0), [PIN, HELD[1], HELD[2]], field))
    turned = np.array([at(80.0) for step in path.steps if step.stage == 1 and step.load_factor == 1.0])
    assert len(turned) == 1
    np.testing.assert_allclose(axis_of(path)[-1], turned[0], atol=ROUND_OFF)


def test_in_the_field_of_a_magnet():
    """Pinned on the axis of a magnet, 15 of its lengths away, it points along this axis; the pin holds it back."""
    radius, away = 30e-3, 15 * LENGTH
    magnet = Source(Sphere(2.0 * radius, (1.2, 0.0, 0.0)), np.add(MIDDLE, (away, 0.0, 0.0)))
    path = ms.solve(needle(at(70.0), [PIN, HELD[1], HELD[2]], ms.MagnetField([magnet])))
    np.testing.assert_allclose(axis_of(path)[-1], at(-70.0), atol=(LENGTH / away) ** 2)
    pull = MOMENT * 2.0 / 3.0 * 1.2 * (radius / away) ** 3 * 3.0 / away
    force = path.summary["reactions"]["middle"]["force"]
    np.testing.assert_allclose(force, [-pull, 0.0, 0.0], atol=10.0 * (LENGTH / away) ** 2 * pull)


def test_opposite_to_the_field(caplog):
    """An unstable equilibrium: followed, counted and said."""
    with caplog.at_level(logging.WARNING):
        path = ms.solve(needle(at(180.0), [PIN, HELD[1]]))
    np.testing.assert_allclose(axis_of(path)[-1], at(0.0), atol=1e-6)
    assert path.steps[-1].negative_pivots == 2
    assert "stands opposite to the field, an unstable equilibrium" in caplog.text


def rigid_needle(stiffness, angle):
    """On a torsion spring about X3; all of it is one rigid body."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2)).select_elements("all", x1=(0.0, LENGTH))
    body = ms.RigidBody("all", "needle")
    remanence = ms.remanence.constant([REMANENCE, 0, 0])
    shell = ms.Shell(mesh, THICKNESS, STIFF, remanence, rigid=[body])
    supports = [ms.SimpleSupport("needle"), *(ms.Prescribe("needle", "omega", axis, 0.0) for axis in (1, 2))]
    springs = [] if stiffness is None else [ms.TorsionSpring("needle", stiffness, (0, 0, 1), name="spring")]
    return ms.Model(shell, supports, ms.UniformField(FIELD * at(angle)), springs=springs)


def angle_of(path, step=-1):
    """By which the rigid needle has turned about X3."""
    q = path.steps[step].state.q[path.discretisation.rows.nodes]
    return 2.0 * np.arctan2(q[3], q[0])


@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("direction", [30.0, 100.0])
def test_on_a_torsion_spring(ratio, direction):
    """k α = m B sin(ψ - α), where the whole needle is rigid; ratio is m B / k."""
    path = ms.solve(rigid_needle(MOMENT * FIELD / ratio, direction))
    ψ = np.radians(direction)
    expected = brentq(lambda α: α - ratio * np.sin(ψ - α), 0.0, ψ, xtol=1e-14)
    assert angle_of(path) == pytest.approx(expected, rel=1e-6)


def test_a_rigid_needle_without_a_spring():
    path = ms.solve(rigid_needle(None, 100.0))
    angles = [angle_of(path, number) for number in range(1, len(path.steps))]
    np.testing.assert_allclose(angles, np.radians(100.0), rtol=1e-9)


@pytest.mark.parametrize("kept", [1, 2, 3])
def test_going_on(kept):
    """After the undeformed state, the turned one and the next: the same bits."""
    waypoints: list[Waypoint] = []

    class Collector(Observer):
        def kept(self, path):
            waypoints.append(path.trail[-1])

    model = needle(at(30.0), [PIN, HELD[1]])
    path = ms.solve(model, observers=[Collector()])
    other = ms.resume(path_through(model, path.settings, waypoints[:kept]))
    np.testing.assert_array_equal(other.probe("right").u, path.probe("right").u)
    assert [step.load_factor for step in other.steps] == [step.load_factor for step in path.steps]


def test_work_starts_where_it_has_turned():
    """Up to there the body jumps, which is no work along a path of equilibria."""
    path = ms.solve(needle(at(30.0), [PIN, HELD[1]]))
    work = np.array(path.history.rows(path.steps))[:, path.history.columns.index("work_field")].astype(float)
    assert np.abs(work).max() < ROUND_OFF * MOMENT * FIELD


@pytest.mark.parametrize(
    ("supports", "field", "message"),
    [
        ([PIN], ALONG_1, r"can turn about X1, the direction of the field, and the field does not resist that"),
        ([PIN, HELD[2]], ALONG_1, r"can turn about X1, the direction of the field"),
        (
            [HELD[1]],
            ALONG_1,
            "translation along X1 and rotation about X3 and rotation about X2. Add",
        ),
        ([], ALONG_1, "floats freely"),
        ([PIN, HELD[1]], (0.0, 0.0, 0.0), "can still move as a rigid body: rotation about X3 and rotation about X2"),
    ],
    ids=["about the field", "about the field and across", "translations", "nothing", "no field"],
)
def test_what_the_field_does_not_hold(supports, field, message):
    with pytest.raises(InputError, match=message):
        needle(at(30.0), supports, field, loads=[ms.Traction(None, (0, 0, 1.0))])


def test_about_the_field_in_a_later_stage():
    field = ms.UniformField(ALONG_1, history=[1.0, 1.0], rotation_axis=(0, 1, 0), rotation=[0.0, np.radians(-90.0)])
    with pytest.raises(InputError, match="about X3, the direction of the field at the end of stage 2"):
        needle(at(30.0), [PIN, HELD[1]], field)


def test_an_axis_along_the_remanence():
    with pytest.raises(ms.SolveError, match="no torque about X2, so that nothing holds the rotation about it"):
        ms.solve(needle((0.0, 1.0, 0.0), [PIN, HELD[1], HELD[3]]))


def test_supports_that_hold_small_rotations_only():
    """A corner on a table lets the body turn about two axes, but not far about both."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2))
    mesh = mesh.select_nodes("middle", within=lambda x: np.linalg.norm(x - MIDDLE, axis=1) < 1e-6)
    mesh = mesh.select_nodes("corner", within=lambda x: np.linalg.norm(x - [LENGTH, WIDTH, 0.0], axis=1) < 1e-6)
    shell = ms.Shell(mesh, THICKNESS, STIFF, ms.remanence.constant([REMANENCE, 0.0, REMANENCE]))
    across = (-FIELD * MIDDLE[1], FIELD * MIDDLE[0], 0.0) / np.linalg.norm(MIDDLE)
    model = ms.Model(shell, [PIN, ms.Prescribe("corner", "u", 3, 0.0)], ms.UniformField(across))
    with pytest.raises(ms.SolveError, match="let the body turn by a small angle only"):
        ms.solve(model)


@pytest.mark.parametrize(
    ("direction", "held", "field", "words"),
    [
        ((1, 0, 0), (2, 3), (0.0, FIELD, 0.0), "no torque about X1, so that nothing holds"),
        ((0, 1, 0), (1, 3), ALONG_1, "no torque about X2, so that nothing holds"),
        ((-1, 0, 0), (1, 2), ALONG_1, "stands opposite to the field"),
        ((1, 0, 0), (1, 2), ALONG_1, None),
        ((0, 1, 0), (1, 2), ALONG_1, None),
        ((1, 1, 0), (1,), ALONG_1, None),
    ],
)
def test_doubted_before_the_solve(direction, held, field, words):
    """What the solve tells of the rotation is told without it."""
    said = needle(direction, [PIN, *(HELD[axis] for axis in held)], field).doubts()
    of_the_rotation = [one for one in said if "torque about" in one or "opposite" in one]
    assert len(of_the_rotation) == (words is not None)
    assert all(words in one for one in of_the_rotation)
