"""What supports hold, in which directions; what they refuse; and that slanted ones do the same as straight ones."""

from __future__ import annotations

import numpy as np
import pytest
from battery import COUPLING, MATERIAL, each_element, example, patch, with_points
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.errors import InputError
from magshell.mesh import rectangle
from magshell.model.constraints import resolve
from magshell.model.places import Places
from magshell.model.supports import Clamp, Prescribe, SimpleSupport, SymmetryPlane
from magshell.shell.elements import PAPER, QUADRATIC

U, W, PHI, OMEGA = slice(0, 3), slice(3, 6), 6, slice(7, 10)


@pytest.fixture
def mesh():
    """3 × 1 elements, some nodes named."""
    mesh = rectangle(3.0, 1.0, (3, 1))
    return mesh.select_nodes("origin", x1=0, x2=0).select_nodes("far", x1=3, x2=1).select_nodes("middle", x1=0, x2=0.5)


def carrying(mesh, group, element, field):
    """Nodes of a group that carry a field: all, or the corners."""
    count = {"u": 8, "w": element.rest_nodes, "omega": element.rest_nodes, "phi": element.stretch_nodes}[field]
    nodes = mesh.nodes_of(group)
    return nodes if count == 8 else np.intersect1d(nodes, mesh.corner_nodes)


def constrained(mesh, supports, element=QUADRATIC):
    return resolve(Places(mesh, element.carriers(mesh.elements, len(mesh.points))), supports)


def held(mesh, element, *supports):
    """Held components and their values, no node having a frame of its own."""
    constraints = constrained(mesh, supports, element)
    assert np.all(constraints.frame_of < 0)
    return constraints.fixed, constraints.values[0]


@each_element
def test_clamp_leaves_the_thickness_free(mesh, element):
    fixed, value = held(mesh, element, Clamp("left"))
    expected = np.zeros_like(fixed)
    for field, columns in (("u", U), ("w", W), ("omega", OMEGA)):
        expected[carrying(mesh, "left", element, field), columns] = True
    assert np.array_equal(fixed, expected)
    assert not value.any()


def test_simple_support_holds_u(mesh):
    fixed, _ = held(mesh, QUADRATIC, SimpleSupport("left"))
    expected = np.zeros_like(fixed)
    expected[mesh.nodes_of("left"), U] = True
    assert np.array_equal(fixed, expected)


@each_element
@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("length", [1.0, -3.0])
def test_symmetry_plane_along_an_axis(mesh, axis, length, element):
    """u and w along the normal, rotation across it; no frames are needed."""
    fixed, _ = held(mesh, element, SymmetryPlane("left", length * np.eye(3)[axis]))
    rest = carrying(mesh, "left", element, "w")
    across = np.delete(np.arange(3), axis)
    expected = np.zeros_like(fixed)
    expected[mesh.nodes_of("left"), axis] = True
    expected[rest, 3 + axis] = True
    expected[np.ix_(rest, 7 + across)] = True
    assert np.array_equal(fixed, expected)


@each_element
def test_slanted_symmetry_plane_has_frames_of_its_own(mesh, element):
    normal = np.array([1.0, 2.0, -2.0]) / 3.0
    constraints = constrained(mesh, [SymmetryPlane("left", 5.0 * normal)], element)
    rest = carrying(mesh, "left", element, "w")
    others = np.setdiff1d(mesh.nodes_of("left"), rest)
    assert (constraints.frame_of[rest] >= 0).all()
    assert ((constraints.frame_of[others] >= 0) == [True, False, False]).all()
    for node in rest:
        for field, column, count in ((0, 0, 1), (1, 3, 1), (2, 7, 2)):
            frame = constraints.frames[constraints.frame_of[node, field]]
            assert np.abs(frame @ frame.T - np.eye(3)).max() < 1e-15
            assert constraints.fixed[node, column : column + 3].sum() == count
            along = np.abs(frame[constraints.fixed[node, column : column + 3]] @ normal)
            assert along == pytest.approx([1.0] if count == 1 else [0.0, 0.0], abs=1e-15)


@each_element
@pytest.mark.parametrize(
    ("support", "columns", "values"),
    [
        (Prescribe("left", "u", 2, 0.3), [1], [0.3]),
        (Prescribe("left", "u"), [0, 1, 2], [0, 0, 0]),
        (Prescribe("left", "u", value=(1, 2, 3)), [0, 1, 2], [1, 2, 3]),
        (Prescribe("left", "w", value=0.5), [3, 4, 5], [0.5, 0.5, 0.5]),
        (Prescribe("left", "w", 1, -1.0), [3], [-1.0]),
        (Prescribe("left", "phi", value=7.0), [6], [7.0]),
        (Prescribe("left", "omega", 3, 0.2), [9], [0.2]),
        (Prescribe("left", "omega", value=(0.1, 0.2, 0.3)), [7, 8, 9], [0.1, 0.2, 0.3]),
    ],
)
def test_prescribed_values(mesh, support, columns, values, element):
    fixed, value = held(mesh, element, support)
    nodes = carrying(mesh, "left", element, support.field)
    expected, expected_value = np.zeros_like(fixed), np.zeros_like(value)
    expected[np.ix_(nodes, columns)] = True
    expected_value[np.ix_(nodes, columns)] = values
    assert np.array_equal(fixed, expected)
    assert np.array_equal(value, expected_value)


def test_supports_that_say_the_same_twice_agree(mesh):
    """A value along a slanted normal that components imply already; a clamp on a plane of symmetry."""
    both = constrained(mesh, [Prescribe("left", "u", value=(1.0, -1.0, 0.5)), SymmetryPlane("left", (1.0, 1.0, 0.0))])
    nodes = mesh.nodes_of("left")
    assert both.fixed[nodes][:, U].all()
    assert np.array_equal(both.values[0][nodes][:, U], np.broadcast_to((1.0, -1.0, 0.5), (len(nodes), 3)))
    assert constrained(mesh, [Clamp("left"), SymmetryPlane("left", (1.0, 1.0, 0.0))]).fixed[nodes][:, U].all()


def test_slanted_and_straight_conditions_combine(mesh):
    """u · n = 0 and u3 = 0.4: two directions are held, and what they hold is what was asked."""
    normal = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
    constraints = constrained(mesh, [SymmetryPlane("origin", normal), Prescribe("origin", "u", 3, 0.4)])
    node = mesh.nodes_of("origin")[0]
    frame, fixed = constraints.frames[constraints.frame_of[node, 0]], constraints.fixed[node, U]
    assert fixed.sum() == 2
    u = frame.T @ np.where(fixed, constraints.values[0][node, U], [9.0, 9.0, 9.0])
    assert u @ normal == pytest.approx(0.0, abs=1e-14)
    assert u[2] == pytest.approx(0.4, rel=1e-14)


# -- refusals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("supports", "message"),
    [
        ([Clamp("left"), Prescribe("bottom", "u", 3, 1.0)], "'bottom' wants another .*u.* than 'left'"),
        ([Prescribe("left", "u", 3, 1.0), Prescribe("left", "u", 3, 2.0)], "earlier support on the same group"),
        ([Prescribe("left", "u", 1, 1.0), SymmetryPlane("left", (1, 0, 0))], "contradict each other at node 0"),
        (
            [Prescribe("left", "u", 1, 1.0), Prescribe("left", "u", 2, 1.0), SymmetryPlane("origin", (1, 1, 0))],
            "contradict each other at node 0: 'origin' wants another .*u.* than 'left'",
        ),
        ([Clamp("left"), Prescribe("left", "omega", 2, 0.1)], "wants another .*omega"),
        ([Prescribe("left", "phi", value=1.0), Prescribe("bottom", "phi", value=0.0)], "wants another .*phi"),
    ],
)
def test_contradictions_are_named(mesh, supports, message):
    with pytest.raises(InputError, match=message):
        constrained(mesh, supports)


@pytest.mark.parametrize(
    ("support", "message"),
    [
        (Prescribe("left", "ph"), "support on 'left': field is 'ph'.*'phi'"),
        (Prescribe("lft", "u"), "no group 'lft'.*'left'"),
        (Prescribe("left", "u", 4), "component is 4; allowed are 1, 2, 3"),
        (Prescribe("left", "u", 0), "component is 0; allowed are 1, 2, 3"),
        (Prescribe("left", "u", 2, (1, 2, 3)), "one component takes one number"),
        (Prescribe("left", "u", value=(1, 2)), "3 numbers, or one for all"),
        (Prescribe("left", "phi", 1), "phi is a scalar, it has no component 1"),
        (Prescribe("left", "u", value=float("nan")), "must be finite"),
        (Prescribe("left", "u", 1, "up"), "support on 'left': value is .*up"),
        (SymmetryPlane("left", (0, 0, 0)), "normal is .* needs 3 components, not all zero"),
        (SymmetryPlane("left", (1, 0)), "normal is .* needs 3 components"),
        (SymmetryPlane("left", (1, 0, float("inf"))), "normal is .* needs 3 components"),
        (SymmetryPlane("left", "X1"), "support on 'left': normal is .*X1"),
        (Prescribe("middle", "phi"), r"support on 'middle': node \d+ is a mid-side node and does not carry 'phi'"),
    ],
)
def test_refused(mesh, support, message):
    with pytest.raises(InputError, match=message):
        constrained(mesh, [support])


@pytest.mark.parametrize("field", ["w", "omega"])
def test_mid_side_nodes_may_be_without_director_and_rotation(mesh, field):
    assert constrained(mesh, [Prescribe("middle", field)], QUADRATIC).fixed.any()
    with pytest.raises(InputError, match=rf"node \d+ is a mid-side node and does not carry '{field}'"):
        constrained(mesh, [Prescribe("middle", field)], PAPER)


@pytest.mark.parametrize("stretch", ["none", "plane-stress"])
def test_a_shell_without_thickness_stretch_has_nothing_to_hold(mesh, stretch):
    shell = ms.Shell(mesh, 0.2, example(MATERIAL), ms.remanence.constant(REMANENT), thickness_stretch=stretch)
    assert not shell.carriers["phi"].any()
    with pytest.raises(InputError, match="support on 'left': no node of this shell carries 'phi'"):
        ms.Model(shell, [Clamp("left"), Prescribe("left", "phi", value=1.0)], ms.UniformField(FIELD))


# -- solutions -------------------------------------------------------------------------------------------------------

REMANENT, FIELD = np.array([0.5, 0.1, 0.0]), np.array([0.0, 0.0, 0.02])


def strip(mesh, supports, turn=None, remanent=REMANENT, field=FIELD):
    """Last state of a strip in a field that bends it by about its length; everything turned by `turn`."""
    Q = np.eye(3) if turn is None else turn
    shell = ms.Shell(with_points(mesh, mesh.points @ Q.T), 0.2, example(MATERIAL), ms.remanence.constant(Q @ remanent))
    model = ms.Model(shell, supports, ms.UniformField(Q @ field), example(COUPLING))
    return ms.solve(model).steps[-1].state


def test_slanted_symmetry_plane_is_the_straight_one_turned(mesh):
    Q = Rotation.from_rotvec([0.8, -1.3, 0.5]).as_matrix()
    straight = strip(mesh, [Clamp("left"), SymmetryPlane("bottom", (0, 1, 0))])
    slanted = strip(mesh, [Clamp("left"), SymmetryPlane("bottom", Q @ (0, 1, 0))], Q)
    largest = np.abs(straight.u).max()
    assert largest > 0.5, "the strip hardly moves"
    for name in ("u", "w"):
        error = np.abs(getattr(slanted, name) - getattr(straight, name) @ Q.T).max()
        assert error < 1e-7 * largest, f"{name}: {error:.1e}"
    assert np.abs(slanted.phi - straight.phi).max() < 1e-7 * np.abs(straight.phi).max()


def test_half_a_body_with_a_symmetry_plane_is_half_of_the_whole():
    """A mirror image is made of u, w and of the axial vectors of rotation and remanence alike."""
    half = rectangle(3.0, 1.0, (3, 1))
    whole = with_points(rectangle(3.0, 2.0, (3, 2)), rectangle(3.0, 2.0, (3, 2)).points - [0.0, 1.0, 0.0])
    remanent = np.array([0.5, 0.0, 0.0])
    small = strip(half, [Clamp("left"), SymmetryPlane("bottom", (0, 1, 0))], remanent=remanent)
    large = strip(whole, [Clamp("left")], remanent=remanent)
    at = [whole.node_at(point) for point in half.points]
    for name in ("u", "w", "phi"):
        actual, expected = getattr(small, name), getattr(large, name)[at]
        error = np.abs(actual - expected).max() / np.abs(expected).max()
        assert error < 1e-7, f"{name}: {error:.1e}"


def test_prescribed_motion_carries_the_body_along():
    """A clamp lifted by u3 lifts the whole strip rigidly when no field acts."""
    mesh = patch((3, 1), distortion=0.1)
    supports = [Prescribe("left", "u", value=(0.0, 0.0, 0.7)), Prescribe("left", "w"), Prescribe("left", "omega")]
    state = strip(mesh, supports, field=np.zeros(3))
    assert np.abs(state.u - [0.0, 0.0, 0.7]).max() < 1e-9, f"{np.abs(state.u - [0.0, 0.0, 0.7]).max():.1e}"
    assert np.abs(state.w).max() < 1e-9
