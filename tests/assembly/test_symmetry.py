"""Mirror planes: the half is half of the whole exactly where the rule for field and remanence says so; else a word."""

from __future__ import annotations

import logging
import re

import numpy as np
import pytest
from battery import COUPLINGS, MATERIAL, example, name_of

import magshell as ms
from magshell.magnetics.fields import Dipole, Source
from magshell.mesh import Mesh, rectangle
from magshell.model import reflection
from magshell.model.symmetry import MIRRORED, REVERSED, broken, planes, remanence_sign

NORMAL = np.array([1.0, 0.0, 0.0])
REMANENT = np.array([0.4, 0.2, 0.5])


def moved(mesh, shift):
    return Mesh(mesh.points + shift, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)


HALF = rectangle(3.0, 1.0, (3, 1))
WHOLE = moved(rectangle(6.0, 1.0, (6, 1)), [-3.0, 0.0, 0.0])
PLANE = ms.SymmetryPlane("left", (2.0, 0.0, 0.0))


def model(mesh, supports, field=(0.0, 0.0, 0.01), remanence=None, coupling=None, loads=(), density=None, **more):
    remanence = ms.remanence.constant(REMANENT) if remanence is None else remanence
    shell = ms.Shell(mesh, 0.2, example(MATERIAL), remanence, density=density)
    field = ms.UniformField(field) if isinstance(field, tuple) else field
    return ms.Model(shell, supports, field, coupling, loads=loads, **more)


@pytest.mark.parametrize("coupling", COUPLINGS, ids=name_of)
@pytest.mark.parametrize(
    ("field", "sign"), [((0.0, 0.004, 0.01), MIRRORED), ((0.012, 0.0, 0.0), REVERSED)], ids=["in plane", "normal"]
)
def test_half_is_half_of_the_whole(coupling, field, sign):
    """With the other half magnetised as the sign of the field demands, and with no other remanence."""

    def both(x, other=sign):
        image = other * reflection.polar(REMANENT, NORMAL)
        return np.where(x[:, :1] > 0.0, REMANENT, image)

    clamped = [ms.Clamp("left"), ms.Clamp("right")]
    half = model(HALF, [ms.Clamp("right"), PLANE], field, coupling=coupling)
    whole = model(WHOLE, clamped, field, ms.remanence.function(both), coupling)
    wrong = model(WHOLE, clamped, field, ms.remanence.function(lambda x: both(x, -sign)), coupling)
    assert remanence_sign(half, planes(half)[0]) == sign
    assert not broken(half)
    small, large, other = (ms.solve(one).steps[-1].state for one in (half, whole, wrong))
    at = [WHOLE.node_at(point) for point in HALF.points]
    scale = np.abs(small.u).max()
    assert scale > 0.05
    assert np.abs(small.u - large.u[at]).max() < 1e-7 * scale
    assert np.abs(small.w - large.w[at]).max() < 1e-7 * np.abs(small.w).max()
    assert np.abs(small.u - other.u[at]).max() > 0.1 * scale


VARYING = {
    "its own image": (lambda x, y, z: (-x, 0.0 * y, 1.0 + z), MIRRORED),
    "the opposite of its image": (lambda x, y, z: (1.0 + z, 0.0 * y, x), REVERSED),
    "neither": (lambda x, y, z: (1.0 + z, 0.0 * y, 1.0 + x), None),
}


@pytest.mark.parametrize(("function", "sign"), VARYING.values(), ids=VARYING)
def test_field_that_varies(function, sign, caplog):
    field = ms.FunctionField(lambda x: 0.01 * np.stack(function(*x.T), axis=1), length=1.0)
    with caplog.at_level(logging.WARNING):
        half = model(HALF, [ms.Clamp("right"), PLANE], field)
    assert remanence_sign(half, planes(half)[0]) == sign
    assert len(broken(half)) == (sign is None)
    assert ("place its sources alike" in caplog.text) == (sign is None)


@pytest.mark.parametrize(("x", "faults"), [(0.0, 0), (0.3, 1)])
def test_magnet_above_the_plane_and_beside_it(x, faults):
    above = Source(Dipole(moment=(0.0, 0.0, 1e3)), position=(x, 0.5, 3.0))
    assert len(broken(model(HALF, [ms.Clamp("right"), PLANE], ms.MagnetField([above])))) == faults


def test_images_of_polar_and_axial_vectors():
    """A moment is the cross product of an arm and a force; its image is that of their images."""
    rng = np.random.default_rng(3)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    arm, force = rng.normal(size=(2, 5, 3))
    images = [reflection.polar(each, normal) for each in (arm, force)]
    assert np.abs(np.cross(*images) - reflection.axial(np.cross(arm, force), normal)).max() < 1e-14
    tangent = np.cross(normal, arm[0])
    assert reflection.in_plane(tangent, normal)
    assert not reflection.is_normal(tangent, normal)
    assert reflection.is_normal(-3.0 * normal, normal)
    assert reflection.angle_to_plane(normal + tangent / np.linalg.norm(tangent), normal) == pytest.approx(45.0)


def turning(angles, axis, start=(0.0, 0.0, 0.01)):
    return ms.UniformField(start, history=(1.0,) * len(angles), rotation_axis=axis, rotation=np.radians(angles))


FIELDS = [
    ((0.0, 0.0, 0.01), None),
    ((0.0, -3.0, 4.0), None),
    ((0.01, 0.0, 0.0), None),
    ((0.01, 0.0, 5e-7), None),
    ((0.005, 0.0, 0.005), "the field (5 mT, 0, 5 mT) is 45° off the plane"),
    ((1e-3, 0.0, 0.1), "0.573° off the plane"),
    (turning((90.0,), (1, 0, 0)), None),
    (turning((0.0, 360.0), (1, 0, 0)), None),
    (turning((360.0,), (0, 1, 0)), "off the plane"),
    (turning((0.0, 90.0), (0, 1, 0)), "in stage 2 is"),
    (turning((0.0, 30.0), (0, 1, 0), (0.01, 0.0, 0.0)), "in stage 2 is"),
    (ms.UniformField((0.0, 0.0, 0.01), history=(1.0, -2.0)), None),
    (ms.UniformField((0.01, 0.0, 0.01), history=(0.0, 1.0)), "in stage 2 is 45° off"),
]


@pytest.mark.parametrize(("field", "words"), FIELDS)
def test_fields(field, words, caplog):
    with caplog.at_level(logging.WARNING):
        found = broken(model(HALF, [ms.Clamp("right"), PLANE], field))
    assert bool(found) == bool(words), found
    assert [one.getMessage() for one in caplog.records if one.name == "magshell.model.symmetry"] == found
    if words:
        assert found[0].startswith("symmetry 'left': the field (")
        assert words in found[0]
        assert "Model the whole part" in found[0]


def test_a_field_that_jumps_from_the_plane_to_its_normal():
    """Each alone would do, for another remanence of the other half."""
    field = ms.UniformField(
        (0.0, 0.0, 0.01), history=(0.0, 0.0, 1.0), rotation_axis=(0, 1, 0), rotation=(0, 1.57079, 1.57079)
    )
    assert not broken(model(HALF, [ms.Clamp("right"), PLANE], field, loads=[ms.Force("right", (0, 0, 1e-9))]))
    field = ms.UniformField(
        (0.0, 0.0, 0.01), history=(1.0, 0.0, 0.0, 1.0), rotation_axis=(0, 1, 0), rotation=(0, 0, np.pi / 2, np.pi / 2)
    )
    found = broken(model(HALF, [ms.Clamp("right"), PLANE], field))
    assert len(found) == 1
    assert "lies in the plane in stage 1 and is normal to it in stage 4" in found[0]


def test_a_field_without_remanence_breaks_nothing():
    push = ms.Force("right", (0.0, 0.0, 1e-4))
    supports = [ms.Clamp("bottom"), PLANE]
    bare = model(HALF, supports, (0.01, 0.0, 0.01), ms.remanence.constant((0, 0, 0)), loads=[push])
    assert not broken(bare)


NODES = Mesh(
    HALF.points, HALF.elements, {"all": [0, 1, 2], "far": [2]}, HALF.edge_groups,
    {"corner": [HALF.node_at((0, 0, 0))], "tip": [HALF.node_at((3.0, 0, 0))]},
)  # fmt: skip
LOADS = [
    (ms.Gravity((0.0, 0.0, -9.81)), None),
    (ms.Gravity((-9.81, 0.0, 0.0)), "gravity (-9.81 m/s^2, 0, 0) is 90° off the plane: the other half would weigh"),
    (ms.Gravity((0.0, -1.0, -1.0), "far"), None),
    (ms.Gravity((0.0, -1.0, -1.0), "far"), None),
    (ms.Force("left", (0.0, 1.0, 1.0)), None),
    (ms.Force("left", (1.0, 0.0, 1.0)), "force on 'left' (1 N, 0, 1 N) is 45° off the plane: its support takes"),
    (ms.Force("corner", (1.0, 0.0, 0.0)), "force on 'corner' (1 N, 0, 0) is 90° off the plane"),
    (ms.Force("tip", (1.0, 0.0, 0.0)), None),
    (ms.Force("bottom", (1.0, 0.0, 0.0)), None),
    (ms.Force("all", (1.0, 0.0, 0.0)), "beyond it acts the image"),
    (ms.Force("far", (1.0, 0.0, 0.0)), None),
    (ms.Traction("all", (0.0, 0.0, 1.0)), None),
    (ms.Traction("all", (1.0, 0.0, 1.0)), "traction on 'all' (1 Pa, 0, 1 Pa) is 45° off the plane: beyond it acts"),
    (ms.Traction("far", (1.0, 0.0, 1.0)), None),
    (ms.Traction(None, (0.0, 1.0, 1.0)), None),
    (ms.Traction(None, (1.0, 0.0, 1.0)), "traction (1 Pa, 0, 1 Pa) is 45° off the plane: beyond it acts"),
    (ms.Pressure("all", 1.0), None),
    (ms.Moment("left", (1.0, 0.0, 0.0)), None),
    (ms.Moment("left", (0.0, 1.0, 0.0)), "moment on 'left' (0, 1 N m, 0) is 90° off the normal of the plane"),
    (ms.Moment("tip", (0.0, 1.0, 0.0)), None),
    (ms.Force("left", (0.0, 1.0, 0.0), follower=True), None),
]  # fmt: skip


@pytest.mark.parametrize(("load", "words"), LOADS)
def test_loads(load, words):
    """Forces are polar vectors, moments axial ones; a pressure is a number."""
    found = broken(model(NODES, [ms.Clamp("right"), PLANE], loads=[load], density=1.0))
    assert bool(found) == bool(words), found
    assert words is None or (len(found) == 1 and words in found[0]), found


def folded(angle):
    """A strip that leaves the plane X1 = 0 at an angle, degrees."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[s, 0, -c], [0, 1, 0], [c, 0, s]])
    return Mesh(HALF.points @ turn.T, HALF.elements, HALF.element_groups, HALF.edge_groups)


@pytest.mark.parametrize(
    ("mesh", "plane", "words"),
    [
        (HALF, ms.SymmetryPlane("left", (0, 1, 0)), r"nodes 0 and \d+ are 1 m apart"),
        (HALF, ms.SymmetryPlane("left", (0, 0, 1)), "the normal of the shell is 90° off the plane, in which it must"),
        (folded(90.0), ms.SymmetryPlane("left", (1, 0, 0)), None),
        (folded(80.0), ms.SymmetryPlane("left", (1, 0, 0)), None),
        (folded(60.0), ms.SymmetryPlane("left", (1, 0, 0)), "30° off the plane.*folded there by 60°"),
        (
            Mesh(WHOLE.points, WHOLE.elements, {}, {}, {"middle": np.flatnonzero(np.abs(WHOLE.points[:, 0]) < 1e-9)}),
            ms.SymmetryPlane("middle", (1, 0, 0)),
            "on both sides of the plane",
        ),
        (ms.mesh.cylinder(1.0, 1.0, (2, 1), angle=(0.0, 90.0)), ms.SymmetryPlane("angle-stop", (1, 0, 0)), None),
        (ms.mesh.cylinder(1.0, 1.0, (1, 1), angle=(0.0, 90.0)), ms.SymmetryPlane("angle-stop", (1, 0, 0)), None),
    ],
)
def test_where_the_shell_lies(mesh, plane, words):
    ends = Mesh(mesh.points, mesh.elements, {"all": np.arange(len(mesh.elements))}, mesh.edge_groups, mesh.node_groups)
    held = (
        ms.Clamp("all") if plane.group == "middle" else ms.Clamp(next(iter({"right", "angle-start"} & {*ends.groups})))
    )
    found = broken(model(ends, [held, plane], (0.0, 0.0, 0.0), loads=[ms.Pressure("all", 1e-6)]))
    assert bool(found) == bool(words), found
    if words:
        assert re.search(words, found[0]), found
