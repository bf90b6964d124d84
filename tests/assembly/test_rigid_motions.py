"""Rigid motions that supports leave free are found and named before anything is solved."""

from __future__ import annotations

import numpy as np
import pytest
from battery import MATERIAL, example, with_points
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.errors import InputError
from magshell.mesh import Mesh, rectangle
from magshell.model.constraints import resolve
from magshell.model.places import Places
from magshell.model.rigid import free_motions
from magshell.model.supports import Clamp, Prescribe, SimpleSupport, SymmetryPlane
from magshell.shell.elements import QUADRATIC


def plate():
    mesh = rectangle(3.0, 1.0, (3, 1))
    return mesh.select_nodes("origin", x1=0, x2=0).select_nodes("far", x1=3, x2=0)


def model(mesh, *supports):
    """Without a field, which would hold rotations."""
    shell = ms.Shell(mesh, 0.1, example(MATERIAL), ms.remanence.constant((1.0, 0.0, 0.0)))
    return ms.Model(shell, supports, loads=[ms.Traction(None, (0.0, 0.0, 1.0))])


CASES = {
    "a hinge along X2": ([SimpleSupport("left")], {"rotation about X2"}),
    "a hinge along X1": ([SimpleSupport("origin"), SimpleSupport("far")], {"rotation about X1"}),
    "a plane of symmetry": (
        [SymmetryPlane("left", (1, 0, 0))],
        {"translation along X2", "translation along X3", "rotation about X1"},
    ),
    "two planes of symmetry": (
        [SymmetryPlane("left", (1, 0, 0)), SymmetryPlane("bottom", (0, 1, 0))],
        {"translation along X3"},
    ),
    "a table": (
        [Prescribe("left", "u", 3), Prescribe("right", "u", 3)],
        {"translation along X1", "translation along X2", "rotation about X3"},
    ),
    "a rail": (
        [Prescribe("left", "u", 3), Prescribe("right", "u", 3), Prescribe("bottom", "u", 2)],
        {"translation along X1"},
    ),
    "no rotation": (
        [Prescribe("left", "omega")],
        {"translation along X1", "translation along X2", "translation along X3"},
    ),
    "no tilt of the director": (
        [Prescribe("left", "w")],
        {"translation along X1", "translation along X2", "translation along X3", "rotation about X3"},
    ),
    "slanted planes": (
        [SymmetryPlane("left", (1, 1, 0)), SymmetryPlane("bottom", (0, 0, 1))],
        {"translation along (0.707, -0.707, 0)"},
    ),
}


@pytest.mark.parametrize(("supports", "motions"), CASES.values(), ids=CASES)
def test_free_motions_are_named(supports, motions):
    with pytest.raises(InputError, match="the body can still move as a rigid body") as caught:
        model(plate(), *supports)
    named = str(caught.value).split("rigid body: ")[1].split(". Add")[0].replace("-0)", "0)")
    assert set(named.split(" and ")) == motions


@pytest.mark.parametrize("supports", [[], [Prescribe("left", "phi", value=1.0)]])
def test_a_body_that_floats(supports):
    with pytest.raises(InputError, match="the body floats freely, nothing holds it"):
        model(plate(), *supports)


@pytest.mark.parametrize(
    "supports",
    [
        [Clamp("left")],
        [Clamp("origin")],
        [SimpleSupport("left"), Prescribe("right", "u", 3)],
        [SimpleSupport("origin"), Prescribe("origin", "omega")],
        [SymmetryPlane("left", (1, 0, 0)), SymmetryPlane("bottom", (0, 1, 0)), Prescribe("origin", "u", 3)],
    ],
)
def test_enough_supports(supports):
    assert model(plate(), *supports).constraints.fixed.any()


def test_the_part_that_is_loose_is_named():
    one, other = rectangle(1.0, 1.0, (1, 1)), rectangle(1.0, 1.0, (2, 1))
    points = np.vstack([one.points, other.points + np.array([0.0, 0.0, 0.5])])
    edges = {"left": one.edge_groups["left"]}
    mesh = Mesh(points, np.vstack([one.elements, other.elements + len(one.points)]), {}, edges, {})
    with pytest.raises(InputError, match=r"part 2 of 2 \(element 1 …\) floats freely"):
        model(mesh, Clamp("left"))


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e4])
def test_neither_units_nor_place_matter(size):
    """The same answer for a body of any size, far from the origin and turned anyhow."""
    Q = Rotation.from_rotvec([0.3, 1.0, -2.0]).as_matrix()
    mesh = plate()
    far = with_points(mesh, size * (mesh.points @ Q.T + [100.0, -50.0, 20.0]))
    for supports, count in (
        ([SimpleSupport("left")], 1),
        ([SymmetryPlane("left", Q @ (1, 0, 0))], 3),
        ([SymmetryPlane("left", Q @ (1, 0, 0)), SymmetryPlane("bottom", Q @ (0, 1, 0))], 1),
        ([Clamp("left")], 0),
    ):
        normals = np.broadcast_to(Q[:, 2], far.points.shape)
        constraints = resolve(Places(far, QUADRATIC.carriers(far.elements, len(far.points))), supports)
        motions = free_motions(far.points, normals, np.arange(len(far.points)), constraints)
        assert len(motions) == count, f"{supports}: {motions}"
