"""Pictures, page and solid export of folded, ribbed, hinged and one-sided shells."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from joints.bodies import BOX, FLAT, FOLD, TEE, UPSIDE_DOWN, extruded
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.evaluation.converged import converged
from magshell.evaluation.patches import patches_of
from magshell.model.hinge import Hinge
from magshell.model.rows import rows_of
from magshell.output.joints import joints_of
from magshell.output.page.solid import solid
from magshell.output.shape import draw_shape
from magshell.output.skin import Hull, skin_of
from magshell.output.solid.cells import solid_grid
from magshell.output.solid.slab import slab, slab_of, volume
from magshell.output.solid.surface import closed_surface
from magshell.output.vtu import grid
from magshell.shell import rotation

trimesh = pytest.importorskip("trimesh")

THICK = 0.1
RUBBER = ms.MicropolarNeoHookean(1e5, 1.7e5, length_scale=3e-3)
SHARP = [((0, 0), (1, 0)), ((1, 0), (0.2, 0.4))]
ACUTE_FIN = [((0, 0), (1, 0)), ((1, 0), (2, 0)), ((1, 0), (2, 0.3))]


def from_places(elements):
    """A mesh of elements given by the positions of their nodes."""
    places = np.round(np.array(elements).reshape(-1, 3), 9)
    points, numbers = np.unique(places, axis=0, return_inverse=True)
    return ms.mesh.Mesh(points, numbers.reshape(-1, 8))


def moebius(count=8, width=0.4):
    """A band of radius 1 with half a twist."""
    parent = [(0, -1), (2, -1), (2, 1), (0, 1), (1, -1), (2, 0), (1, 1), (0, 0)]

    def place(i, t):
        a, r = np.pi * i / count, 1.0 + 0.5 * width * t * np.cos(0.5 * np.pi * i / count)
        return r * np.cos(a), r * np.sin(a), 0.5 * width * t * np.sin(0.5 * a)

    return from_places([[place(2 * e + i, t) for i, t in parent] for e in range(count)])


def corner():
    """Three faces of a cube of side 1."""
    parent = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]
    axes = np.eye(3)
    return from_places([[s * axes[i] + t * axes[j] for s, t in parent] for i, j in ((0, 1), (1, 2), (0, 2))])


# Bodies, and volume: thickness times area, by mitres; those of the cube lack or have a cube of a quarter of h³.
MESHES = {
    "fold": (extruded(FOLD, 1, 1), 1, 2 * THICK),
    "box": (extruded(BOX, 1, 1), 1, 4 * THICK),
    "triangles": (ms.mesh.split(extruded(BOX, 1, 1)), 1, 4 * THICK),
    "upside down": (extruded(UPSIDE_DOWN, 1, 1), 1, 2 * THICK),
    "folded upside down": (extruded([FOLD[0], FOLD[1][::-1]], 1, 2), 1, 2 * THICK),
    "tee": (extruded(TEE, 1, 2), 2, 3 * THICK),
    "tee of triangles": (ms.mesh.split(extruded(TEE, 1, 1)), 2, 3 * THICK),
    "sharp": (extruded(SHARP, 1, 1), 2, (1 + np.hypot(0.8, 0.4)) * THICK),
    "fin": (extruded(ACUTE_FIN, 1, 1), 3, None),
    "corner": (corner(), 1, 3 * THICK + 0.25 * THICK**3),
    "miura": (ms.mesh.miura((1.0, 1.0), 60, 45, (1, 1), (1, 1)), 1, 4 * np.sin(np.pi / 3) * THICK),
    "moebius": (moebius(), 1, None),
}


def undeformed(mesh, turn=None, **of_shell):
    """Its joints, and the faces; turned rigidly."""
    shell = ms.Shell(mesh, THICK, RUBBER, **of_shell)
    joints, rows = joints_of(shell), rows_of(shell)
    z, R = np.moveaxis(shell.faces_at_nodes, 2, 0), np.eye(3) if turn is None else turn
    middle = mesh.points[mesh.elements] @ R.T
    faces = joints.faces(middle, rows.normals[rows.elements] @ R.T, z)
    return joints, faces, slab(joints, faces, faces - middle, z)


@pytest.mark.parametrize("name", MESHES)
def test_bodies_are_closed_and_have_their_volume(name):
    mesh, bodies, expected = MESHES[name]
    _, faces, body = undeformed(mesh)
    made = closed_surface(body)
    found = trimesh.Trimesh(made.points, made.triangles, process=False)
    assert found.is_watertight
    assert found.is_winding_consistent
    assert found.body_count == bodies
    assert made.volume == pytest.approx(volume(body), rel=1e-6)
    if expected is not None:
        assert volume(body) == pytest.approx(expected, rel=1e-12)
    shell = ms.Shell(mesh, THICK, RUBBER)
    surface = Hull(shell, shell.part_of).between(*faces).surface
    x = surface.points[surface.triangles]
    area = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    assert np.abs(area.sum(axis=0)).max() < 1e-12 * np.abs(area).sum(), "the skin of pictures has a hole"
    assert np.einsum("ni,ni->", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6 == pytest.approx(volume(body), rel=1e-2)


def test_faces_turn_with_the_body():
    turn = Rotation.from_rotvec([0.4, -2.0, 1.3]).as_matrix()
    for name in ("corner", "tee", "moebius"):
        _, faces, _ = undeformed(MESHES[name][0])
        _, turned, _ = undeformed(MESHES[name][0], turn)
        assert np.abs(turned - faces @ turn.T).max() < 1e-14


def test_mitred_faces_lie_in_the_planes_of_all_sheets():
    mesh = MESHES["corner"][0]
    _, faces, _ = undeformed(mesh)
    apex = np.flatnonzero(np.abs(mesh.points).max(axis=1) < 1e-9)
    ends = faces[:, mesh.elements == apex]
    assert ends.shape[1] == 3
    np.testing.assert_allclose(np.abs(ends), 0.5 * THICK, atol=1e-12)
    assert len(np.unique(np.round(ends.reshape(-1, 3), 9), axis=0)) == 2


def test_sheets_at_a_hinge_are_bodies_of_their_own():
    for lines in (FLAT, FOLD):
        _, _, body = undeformed(extruded(lines, 1, 1), hinges=[Hinge("joint")])
        found = trimesh.Trimesh(*closed_surface(body), process=False)
        assert found.is_watertight
        assert found.body_count == 2
        assert found.volume == pytest.approx(2 * THICK, rel=1e-12)


def test_kinks_joints_and_hinges_are_outlined():
    """Of a closed box there would be nothing else to see."""
    for lines, hinges, count in ((BOX, (), 8 + 4), (TEE, (), 9 + 1), (FLAT, (Hinge("joint"),), 6 + 1), (FLAT, (), 6)):
        shell = ms.Shell(extruded(lines, 1, 1), THICK, RUBBER, hinges=hinges)
        assert len(joints_of(shell).outline) == count


def test_nothing_is_averaged_across_joints():
    for lines, hinges, rows in ((FOLD, (), 2), (UPSIDE_DOWN, (), 2), (TEE, (), 3), (FLAT, (Hinge("joint"),), 2)):
        mesh = extruded(lines, 1, 1)
        nodes = patches_of(ms.Shell(mesh, THICK, RUBBER, hinges=hinges)).nodes
        at = np.unique(mesh.edge_groups["joint"])
        np.testing.assert_array_equal(np.bincount(nodes)[at], rows)
        np.testing.assert_array_equal(np.delete(np.bincount(nodes), at), 1)


def loaded(lines, element="quadratic", **of_shell):
    mesh = extruded(lines, 1, 1, size=10e-3, width=10e-3)
    shell = ms.Shell(mesh, 1e-3, RUBBER._replace(length_scale=3e-5), element=element, **of_shell)
    return ms.solve(ms.Model(shell, [ms.Clamp("near")], loads=[ms.Force("far", (4e-4, 2e-4, -2e-3))]))


@pytest.fixture(scope="module")
def tee():
    return loaded(TEE, offset=0.2e-3)


@pytest.fixture(scope="module")
def fold():
    return loaded(FOLD, offset=0.2e-3)


@pytest.mark.parametrize("element", ["quadratic", "paper"])
def test_directors_are_those_of_the_sheets(element):
    path = loaded(FOLD, element)
    mesh, patches, rows = path.discretisation.mesh, patches_of(path.model.shell), path.discretisation.rows
    state, at = path.steps[-1].state, np.unique(mesh.edge_groups["joint"][:, :2])
    directors, normals = path.values("director"), path.values("normal")
    for element_number, sheet in enumerate(([0, 0, 1], [-1, 0, 0])):
        own = np.isin(mesh.elements[element_number], at)
        here = patches.elements[element_number, own]
        np.testing.assert_allclose(normals[here], np.tile(sheet, (2, 1)), atol=1e-12)
        turned = Rotation.from_rotvec(rotation.logarithm(state.q[mesh.elements[element_number, own]])).apply(sheet)
        s = state.s[rows.elements[element_number, own]]
        assert np.abs(s).max() > 1e-4
        np.testing.assert_allclose(directors[here], (1.0 + s[:, None]) * turned, atol=1e-12)
    reached = converged(path.discretisation, path.steps[-1])
    np.testing.assert_allclose(directors[patches.elements], reached.element_directors(), atol=1e-12)
    assert np.abs(np.linalg.norm(directors, axis=1) - 1.0).max() < 0.1, "no mean of two sheets"


def test_loaded_bodies_are_closed(fold, tee):
    for path, bodies in ((fold, 1), (tee, 2)):
        body = slab_of(converged(path.discretisation, path.steps[-1]))
        found = trimesh.Trimesh(*closed_surface(body), process=False)
        assert found.is_watertight
        assert found.is_winding_consistent
        assert found.body_count == bodies
        cells = solid_grid(converged(path.discretisation, path.steps[-1]), path.steps[-1])
        assert cells.extract_surface(algorithm="dataset_surface").n_open_edges == 0
        assert {"displacement", "director", "energy"} <= {*cells.point_data, *cells.cell_data}


def test_points_of_a_joint_are_in_the_file_for_each_sheet(tee):
    found = grid(tee.discretisation, tee.steps[-1])
    mesh = tee.discretisation.mesh
    at = np.unique(mesh.edge_groups["joint"])
    assert (np.bincount(found.point_data["node"])[at] == 3).all()
    rows = found.cells.reshape(-1, 9)[:, 1:]
    x = found.points + found.point_data["displacement"]
    across = np.cross(x[rows[:, 2]] - x[rows[:, 0]], x[rows[:, 3]] - x[rows[:, 1]])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    assert (np.einsum("ex,enx->en", across, found.point_data["director"][rows]) > 0.7).all()


def test_upper_and_lower_face_change_places_where_sheets_are_upside_down():
    """A strip in bending: what is pulled above on one side is pulled below on the other."""
    mesh = extruded(UPSIDE_DOWN, 2, 1, size=10e-3, width=10e-3)
    shell = ms.Shell(mesh, 1e-3, RUBBER._replace(length_scale=3e-5))
    path = ms.solve(ms.Model(shell, [ms.Clamp("near")], loads=[ms.Force("sheet1", (0, 0, -1e-5))]))
    nodes, joint = patches_of(shell).nodes, mesh.edge_groups["joint"][0, 2]
    top, bottom = (path.values(f"s11_{face}")[nodes == joint] for face in ("top", "bottom"))
    assert len(top) == 2
    assert top[0] * top[1] < 0.0
    np.testing.assert_allclose(top, bottom[::-1], rtol=0.1)


def placed_by_the_page(path, nodes, heights, mitres):
    """Positions (n, 3) as the page computes them from its outputs at the last step."""
    patches, mesh = patches_of(path.model.shell), path.discretisation.mesh
    moved = (mesh.points + path.values("u"))[patches.nodes]
    d, φ = path.values("director"), path.values("phi")
    x = moved[nodes] + (heights * (1.0 + heights * φ[nodes]))[:, None] * d[nodes]
    point, along, at = mitres.nodes.T
    z, weight = mitres.numbers.T
    length = np.linalg.norm(d, axis=1)
    x[point] = moved[nodes[point]]
    np.add.at(x, point, (weight * z * (1.0 + z * φ[at]) * length[at] / length[along])[:, None] * d[along])
    return x


def test_nodes_of_a_page_are_where_pictures_have_them(fold, tee):
    for path in (fold, tee):
        shell = path.model.shell
        hull = Hull(shell, shell.part_of)
        made = hull.nodal(patches_of(shell).elements)
        assert bool(len(made.mitres.nodes)) == (path is fold)
        x = placed_by_the_page(path, made.nodes, made.heights, made.mitres)
        lower, upper = hull.faces(converged(path.discretisation, path.steps[-1])).reshape(2, -1, 3)
        np.testing.assert_allclose(x[: len(upper)], upper, atol=1e-15)
        np.testing.assert_allclose(x[len(upper) : 2 * len(upper)], lower, atol=1e-15)
        posts, faces = x[2 * len(upper) :], 0.5 * (lower + upper)
        assert np.abs(posts[:, None] - faces).max(axis=2).min(axis=1).max() < 0.02e-3


def test_a_page_has_the_solid_of_every_shell(tee):
    about, arrays = solid(tee, tee.steps)
    assert about["heights"]["rows"] == len(slab_of(converged(tee.discretisation, tee.steps[-1])).levels)
    assert arrays["solid-mitres"] == ""


def test_picture_of_a_fold_has_no_hole(fold, can_draw):
    skin = skin_of(fold.model.shell)
    reached = converged(fold.discretisation, fold.steps[-1])
    surface = skin.placed(reached).surface
    x = surface.points[surface.triangles]
    area = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    assert np.abs(area.sum(axis=0)).max() < 1e-9 * np.abs(area).sum()
    assert draw_shape(fold, None, color="d1").size == (1600, 1120)


def test_shading_is_flat_across_a_kink():
    """Normals of the surface are those of the elements on both sides."""
    mesh = extruded(FOLD, 1, 1)
    shell = ms.Shell(mesh, THICK, RUBBER)
    whole = SimpleNamespace(model=SimpleNamespace(shell=shell))
    at_rest = SimpleNamespace(displacement=np.zeros_like(mesh.points), discretisation=whole)
    surface = skin_of(shell).placed(at_rest).surface
    on_kink = np.abs(surface.points - [1.0, 0.5, 0.0])[:, [0, 2]].max(axis=1) < 1e-9
    found = np.unique(np.round(surface.normals[on_kink], 9) + 0.0, axis=0)
    np.testing.assert_allclose(found, [[-1, 0, 0], [0, 0, 1]], atol=1e-9)
