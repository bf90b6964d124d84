"""What makes no sense of repeated parts, said by name; and what breaks them, told."""

from __future__ import annotations

import logging

import numpy as np
import pytest

import magshell as ms
from magshell.mesh import Mesh, annulus, rectangle

RUBBER = ms.MicropolarNeoHookean(1e5, 4e5)
SECTOR = annulus(0.01, 0.02, (2, 2), angle=(0.0, 60.0))
CELL = rectangle(0.02, 0.01, (2, 2))
CYCLIC, PERIODIC = ms.Cyclic("start", "stop", sectors=6), ms.Periodic("left", "right", "pull")
PULLED = [ms.Prescribe("pull", "u", 1, 1e-3), ms.Prescribe("pull", "u", 2), ms.Prescribe("pull", "u", 3)]


def model(mesh, repeated, supports=(), field=(0.0, 0.0, 0.01), loads=(), rigid=(), **made):
    made = {"remanence": ms.remanence.per_element(np.full((len(mesh.elements), 3), 0.05)), **made}
    shell = ms.Shell(mesh, 5e-4, RUBBER, density=1000.0, repeated=repeated, rigid=rigid, **made)
    return ms.Model(shell, supports or [ms.Clamp("inner")], ms.UniformField(field), loads=loads)


def pinned(mesh):
    return Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups, {"pin": [0], "corner": [4]})


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ms.Cyclic("start", "stop", sectors=1), "sectors is 1; it must be a whole number, 2 or more"),
        (lambda: ms.Cyclic("start", "stop", sectors=2.5), "sectors is 2.5"),
        (lambda: ms.Cyclic("a", "b", sectors=3, axis=(0, 0, 0)), "its length must not be zero"),
        (lambda: ms.Cyclic("a", "b", sectors=3, point=(0, 0)), "point is .* it needs 3 finite numbers"),
    ],
)
def test_values(make, words):
    with pytest.raises(ms.InputError, match=words):
        make()


@pytest.mark.parametrize(
    ("repeated", "words"),
    [
        ([ms.Cyclic("start", "stopp", sectors=6)], "no group 'stopp'.*stop"),
        ([ms.Cyclic("start", "stop", sectors=5)], r"turned by 72°, comes to .* is 4.18 mm away"),
        ([ms.Cyclic("start", "stop", sectors=6, axis=(1, 0, 0))], "away; mesh both alike"),
        ([ms.Cyclic("start", "inner", sectors=6)], "away; mesh both alike"),
        ([ms.Cyclic("start", "outer", sectors=6, point=(0.1, 0, 0))], "mesh both alike"),
        ([CYCLIC, ms.Periodic("start", "stop")], "away; mesh both alike"),
    ],
)
def test_groups_that_do_not_match(repeated, words):
    with pytest.raises(ms.InputError, match=words):
        model(SECTOR, repeated)


def test_motions_that_disagree():
    mesh = rectangle(0.02, 0.02, (2, 2))
    with pytest.raises(ms.InputError, match="in two ways that disagree"):
        model(mesh, [ms.Periodic("left", "right", "a"), ms.Periodic("left", "right", "b")])


def test_rigid_body_on_a_side():
    with pytest.raises(ms.InputError, match="rigid body 'start': node 0 is on a side of the repeated part"):
        model(SECTOR, [CYCLIC], rigid=[ms.RigidBody("start")])


@pytest.mark.parametrize("name", ["left", "inner group"])
def test_name_of_a_jump_that_is_taken(name):
    mesh = Mesh(CELL.points, CELL.elements, {"inner group": [0]}, CELL.edge_groups)
    with pytest.raises(ms.InputError, match=f"the name '{name}' is taken"):
        model(mesh, [ms.Periodic("left", "right", name)])


@pytest.mark.parametrize(
    ("supports", "words"),
    [
        ([ms.SimpleSupport("right")], "node 4 follows node 0 on the other side of the cell"),
        ([ms.Clamp("left"), ms.Prescribe("pull", "omega", 1)], "a jump has no 'omega', only u"),
        ([ms.Clamp("left"), ms.Prescribe("pul", "u", 1)], "There is no group or jump 'pul'.*pull"),
        (
            [ms.SimpleSupport("pin"), *PULLED[:2]],
            r"can still move as a rigid body: rotation about .* and rotation about .*, 0\)",
        ),
        ([*PULLED], "translation along X3 and translation along X2 and translation along X1 and rotation about X1"),
    ],
)
def test_supports_of_a_cell(supports, words):
    with pytest.raises(ms.InputError, match=words):
        model(pinned(CELL), [PERIODIC], supports)


def test_only_motions_along_the_axis_are_left_to_hold():
    with pytest.raises(ms.InputError, match="translation along X3 and rotation about X3") as refused:
        model(SECTOR, [CYCLIC], [ms.Prescribe("outer", "phi")])
    assert "X1" not in str(refused.value)


def test_sides_that_both_are_held_make_the_jump_level():
    held = [ms.Clamp("bottom"), *PULLED[2:]]
    made = model(CELL, [PERIODIC], held, (0.0, 0.0, 0.0), [ms.Gravity((0.0, 0.0, -9.81))])
    assert made.constraints.fixed[made.rows.jumps[0], :3].all()


def test_followers_of_a_jump():
    with pytest.raises(ms.InputError, match="a jump does not turn"):
        model(pinned(CELL), [PERIODIC], [ms.Clamp("left")], loads=[ms.Force("pull", (1.0, 0.0, 0.0), follower=True)])
    with pytest.raises(ms.InputError, match="pull"):
        model(pinned(CELL), [PERIODIC], [ms.Clamp("left")], loads=[ms.Moment("pull", (1.0, 0.0, 0.0))])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"field": (0.01, 0.0, 0.0)}, "a uniform field must lie along the axis"),
        ({"loads": [ms.Gravity((0.0, -9.81, 0.0))]}, "gravity is not along the axis"),
    ],
)
def test_what_breaks_the_repetition_is_told(given, words, caplog):
    with caplog.at_level(logging.WARNING):
        model(SECTOR, [CYCLIC], **given)
    assert words in caplog.text
    caplog.clear()
    with caplog.at_level(logging.WARNING):
        model(SECTOR, [CYCLIC], loads=[ms.Gravity((0.0, 0.0, -9.81))])
    assert not caplog.text


def test_field_that_varies_must_be_repeated(caplog):
    shell = ms.Shell(
        SECTOR, 5e-4, RUBBER, ms.remanence.per_element(np.full((len(SECTOR.elements), 3), 0.05)), repeated=[CYCLIC]
    )
    below = ms.FunctionField(lambda x: np.column_stack([-x[:, 0], -x[:, 1], 2.0 * x[:, 2]]), 0.01)
    aside = ms.FunctionField(lambda x: np.column_stack([x[:, 0], 0.0 * x[:, 1], -x[:, 2]]), 0.01)
    with caplog.at_level(logging.WARNING):
        ms.Model(shell, [ms.Clamp("inner")], below)
    assert not caplog.text
    with caplog.at_level(logging.WARNING):
        ms.Model(shell, [ms.Clamp("inner")], aside)
    assert "it must be repeated as the shell is" in caplog.text
