"""How a total is shared by the nodes of a group: sums, moments, and the work on fields that the functions hold."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from battery import PATCHES
from hypothesis import given
from hypothesis import strategies as st

import magshell as ms
from loads.bodies import grouped
from loads.cases import applied, at_rest, shell_of, torques
from magshell.model.rows import rows_of
from magshell.shell.elements import ELEMENTS

MESHES = {name: grouped(make()) for name, make in PATCHES.items()}
FLAT, CURVED = MESHES["flat patch"], MESHES["curved patch"]
GROUPS = ("left", "top", "half", "scattered")
vectors = st.tuples(*[st.floats(-1e3, 1e3, allow_subnormal=False)] * 3)
each_element = pytest.mark.parametrize("element", ELEMENTS.values(), ids=ELEMENTS)
each_load = pytest.mark.parametrize("load", [ms.Force, ms.Moment])


@cache
def body(mesh, element):
    """A shell and its rows."""
    shell = shell_of(mesh, element)
    return shell, rows_of(shell)


def on_nodes(mesh, element, load):
    """Forces or torques of the nodes, (nodes, 3)."""
    forces = load.applied(*body(mesh, element)).forces(at_rest(mesh))
    return forces[:, :3] if load.kind == "force" else torques(mesh, at_rest(mesh), forces)


@cache
def shares(mesh, element, load, group):
    """The nodes' parts of a unit total, (nodes,)."""
    return on_nodes(mesh, element, load(group, (1.0, 0.0, 0.0)))[:, 0]


def edge_measure(mesh, group):
    """Length and mean position along a group of edges, each the parabola through its three nodes: A + B s + C s²."""
    start, end, middle = np.moveaxis(mesh.points[mesh.edge_groups[group]], 1, 0)
    B, C = 0.5 * (end - start), 0.5 * (start + end) - middle
    s, weights = np.polynomial.legendre.leggauss(40)
    X = middle[:, None] + B[:, None] * s[:, None] + C[:, None] * s[:, None] ** 2
    length = np.linalg.norm(B[:, None] + 2 * C[:, None] * s[:, None], axis=-1) * weights
    return length.sum(), np.einsum("ep,epx->x", length, X) / length.sum()


def flat_measure(mesh, group):
    """Area and centroid of a group of flat elements with straight sides, by the shoelace formula."""
    corners = mesh.points[mesh.elements[mesh.element_groups[group], :4], :2]
    after = np.roll(corners, -1, axis=1)
    cross = corners[..., 0] * after[..., 1] - corners[..., 1] * after[..., 0]
    centroid = np.einsum("es,esx->x", cross, corners + after) / (3.0 * cross.sum())
    return 0.5 * cross.sum(), np.append(centroid, 0.0)


@each_element
@each_load
@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
@given(total=vectors.filter(any), about=vectors)
def test_totals_and_moments_about_any_point(mesh, load, element, total, about):
    """For every group the forces add up to the total, and act at one and the same centre whatever the total is."""
    for group in GROUPS:
        nodal = on_nodes(mesh, element, load(group, total))
        size = np.abs(total).max()
        error = np.abs(nodal.sum(axis=0) - total).max() / size
        assert error < 1e-14, f"{group}: total off by {error:.1e}"
        parts = shares(mesh, element, load, group)
        arm = parts @ mesh.points - about
        moment = np.cross(mesh.points - about, nodal).sum(axis=0)
        error = np.abs(moment - np.cross(arm, total)).max() / (size * (1.0 + np.abs(about).max()))
        assert error < 1e-13, f"{group}: moment about {about} off by {error:.1e}"


@each_element
@each_load
def test_the_centre_is_that_of_straight_edges_and_flat_elements(load, element):
    for group, measure in (("left", edge_measure), ("half", flat_measure)):
        error = np.abs(shares(FLAT, element, load, group) @ FLAT.points - measure(FLAT, group)[1]).max()
        assert error < 1e-14, f"{group}: centre off by {error:.1e}"


@each_element
def test_the_centre_of_a_force_is_that_of_curved_edges(element):
    """To the error of the rule: these edges rise by 5 % of their chord, where five points are good for 1e-11."""
    length, centre = edge_measure(CURVED, "top")
    error = np.abs(shares(CURVED, element, ms.Force, "top") @ CURVED.points - centre).max() / length
    assert error < 1e-11, f"centre off by {error:.1e} of the length"


@each_element
@each_load
def test_mean_of_a_quadratic_field_over_an_edge(load, element):
    """Exact where the functions are quadratic; the mean of the chords, a good deal more, where they are linear."""
    mesh = ms.mesh.rectangle(1.0, 1.0, (2, 3))
    y = mesh.points[:, 1]
    exact, chords = 1.0 / 3.0, (y[mesh.edge_groups["left"][:, :2]] ** 2).mean()
    expected = exact if load is ms.Force or element.rest_nodes == 8 else chords
    assert shares(mesh, element, load, "left") @ y**2 == pytest.approx(expected, rel=1e-14)
    assert chords > 1.05 * exact


@each_element
@each_load
def test_only_nodes_that_carry_the_field_get_a_part(load, element):
    carriers = element.carriers(FLAT.elements, len(FLAT.points))["u" if load is ms.Force else "omega"]
    for group in GROUPS:
        members = np.zeros(len(FLAT.points), dtype=bool)
        members[FLAT.nodes_of(group)] = True
        parts = shares(FLAT, element, load, group)
        assert np.array_equal(parts != 0.0, members & carriers), group
    equal = shares(FLAT, element, load, "scattered")
    assert np.ptp(equal[equal != 0.0]) == 0.0


@each_element
@pytest.mark.parametrize("group", GROUPS)
def test_turning_loads_are_shared_by_the_nodes_that_turn(group, element):
    """A turning force as a moment is, since a node without micro-rotation has nothing to turn it with."""
    shell, total = shell_of(CURVED, element), (0.3, -0.2, 0.5)
    force, moment = (
        applied(kind(group, total, follower=True), shell).forces(at_rest(CURVED)) for kind in (ms.Force, ms.Moment)
    )
    error = np.abs(force[:, :3] - torques(CURVED, at_rest(CURVED), moment)).max()
    assert error < 1e-15, f"{error:.1e}"
    expected = np.outer(shares(CURVED, element, ms.Moment, group), total)
    error = np.abs(force[:, :3] - expected).max()
    assert error < 1e-15, f"{error:.1e}"


@each_element
def test_traction_is_a_force_per_area(element):
    area, _ = flat_measure(FLAT, "half")
    traction = np.array([0.3, -0.2, 0.5])
    found = applied(ms.Traction("half", traction), shell_of(FLAT, element)).forces(at_rest(FLAT))[:, :3]
    error = np.abs(found - on_nodes(FLAT, element, ms.Force("half", area * traction))).max()
    assert error < 1e-15, f"{error:.1e}"
