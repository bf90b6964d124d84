"""The exported body: closed, outward, with the volume of the shell; at steps of the thickness too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from solver.models import LENGTH, THICKNESS, WIDTH, rubber, strip

import magshell as ms
from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.mesh.edges import find_edges
from magshell.output.joints import joints_of
from magshell.output.solid.cells import solid_grid
from magshell.output.solid.export import stl, write_solid
from magshell.output.solid.slab import slab, slab_of, volume
from magshell.output.solid.surface import closed_surface, surface
from magshell.shell.normals import nodal_normals

trimesh = pytest.importorskip("trimesh")


@pytest.fixture(scope="module")
def bent():
    return ms.solve(strip((6, 2)))


@pytest.fixture(scope="module")
def triangles():
    mesh = ms.mesh.split(ms.mesh.rectangle(LENGTH, WIDTH, (4, 2)))
    shell = ms.Shell(mesh, THICKNESS, rubber(), ms.remanence.constant((143e-3, 0, 0)))
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, 0, 20e-3))))


def shaped(mesh, thickness, phi=0.0):
    """A body on a bowl over a mesh in a plane, with a thickness and a stretch of each element."""
    points = mesh.points.copy()
    points[:, 2] = 0.15 * points[:, 0] ** 2 - 0.1 * points[:, 0] * points[:, 1]
    d = 0.9 * nodal_normals(points, mesh.elements)
    z = np.multiply.outer([-0.5, 0.5], np.broadcast_to(thickness, len(mesh.elements)))[..., None]
    return body_of(mesh, points, d, np.broadcast_to(z + phi * z**2, (*z.shape[:2], 8)))


def body_of(mesh, points, directors, t):
    """A body with directors and heights t in them."""
    above = t[..., None] * directors[mesh.elements]
    return slab(joints_of(ms.Shell(mesh, 1e-4, rubber())), points[mesh.elements] + above, above, t)


def check_closed(made, body, bodies=1):
    """As a body of trimesh, whose volume is that of the shell between the faces."""
    solid = trimesh.Trimesh(made.points, made.triangles, process=False)
    assert solid.is_watertight
    assert solid.is_winding_consistent
    assert solid.body_count == bodies
    assert not (solid.area_faces < 1e-14 * solid.area_faces.max()).any()
    assert made.volume == pytest.approx(volume(body), rel=1e-6)
    assert solid.volume == pytest.approx(made.volume, rel=1e-9)


def test_file_is_closed_and_has_the_volume_of_the_body(bent, tmp_path):
    written = write_solid(bent, tmp_path / "body.stl")
    solid = trimesh.load(tmp_path / "body.stl")
    assert solid.is_watertight
    assert solid.is_winding_consistent
    assert 1e-9 * solid.volume == pytest.approx(written.volume, rel=1e-6)
    assert len(solid.faces) == written.cells
    thickness = converged(bent.discretisation, bent.steps[-1])
    F = thickness.fields.F
    exact = (np.linalg.det(F) * bent.discretisation.reference.geometry.volume).sum()
    assert written.volume == pytest.approx(exact, rel=2e-2)  # of the shell's own kinematics, with enhanced modes


def test_undeformed_is_a_plate(bent, tmp_path):
    bent.export(tmp_path / "plate.stl", step=0)
    solid = trimesh.load(tmp_path / "plate.stl")
    assert np.abs(solid.bounds - 1e3 * np.array([[0, 0, -THICKNESS / 2], [LENGTH, WIDTH, THICKNESS / 2]])).max() < 1e-6
    assert 1e-9 * solid.volume == pytest.approx(LENGTH * WIDTH * THICKNESS, rel=1e-6)
    assert len(solid.faces) == 2 * 2 * 12 + 2 * 16


def test_faces_have_the_thickness_stretch(bent):
    step = bent.steps[-1]
    reached = converged(bent.discretisation, step)
    assert np.abs(step.state.phi).max() * THICKNESS > 0.01
    body = slab_of(reached)
    mesh, h = bent.discretisation.mesh, THICKNESS
    for side, z in ((0, -h / 2), (1, h / 2)):
        x = mesh.points + step.state.u + (z + z**2 * reached.phi())[:, None] * reached.director()
        assert np.abs(body.faces[side] - x[mesh.elements]).max() < 1e-15


def stepped():
    """A strip whose far half is thinner and flush with the bottom of the near one, in two materials."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2))
    far = np.flatnonzero(mesh.points[mesh.elements].mean(axis=1)[:, 0] > LENGTH / 2)
    mesh = replace(mesh, element_groups={"far": far})
    thin = ms.Region("far", thickness=0.5 * THICKNESS, material=rubber(0.6 * THICKNESS, 0.2), offset=0.25 * THICKNESS)
    shell = ms.Shell(mesh, THICKNESS, rubber(), ms.remanence.constant((143e-3, 0.0, 0.0)), regions=[thin])
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0.0, 0.0, 10e-3))))


def test_body_of_two_regions_is_closed_at_their_border(tmp_path):
    """At rest flush below; bent, each side has its own stretch of the thickness."""
    path = stepped()
    for step in (0, -1):
        written = write_solid(path, tmp_path / "body.stl", step)
        solid = trimesh.load(tmp_path / "body.stl")
        assert solid.is_watertight
        assert solid.is_winding_consistent
        assert 1e-9 * solid.volume == pytest.approx(written.volume, rel=1e-6)
        if step == 0:
            assert written.volume == pytest.approx(0.75 * LENGTH * WIDTH * THICKNESS, rel=1e-12)
            below = solid.vertices[solid.vertices[:, 2] < -0.4e3 * THICKNESS]
            assert np.ptp(below[:, 0]) == pytest.approx(1e3 * LENGTH, rel=1e-6)
    assert np.abs(converged(path.discretisation, path.steps[-1]).element_stretch()).max() > 1e-3


def test_risers_too_low_for_the_numbers_of_the_file_are_left_out(tmp_path):
    """Two materials in a weak field: their thicknesses differ by less than single precision tells."""
    whole = strip((4, 2), field=(0.0, 0.0, 1e-7))
    mesh = replace(whole.shell.mesh, element_groups={"far": np.array([2, 3, 6, 7])})
    shell = replace(whole.shell, mesh=mesh, regions=[ms.Region("far", material=rubber(THICKNESS, 0.2))])
    path = ms.solve(replace(whole, shell=shell))
    body = slab_of(converged(path.discretisation, path.steps[-1]))
    risers = len(closed_surface(body).triangles)
    written = write_solid(path, tmp_path / "body.stl")
    solid = trimesh.load(tmp_path / "body.stl")
    assert len(solid.faces) == written.cells < risers
    assert solid.is_watertight
    assert solid.is_winding_consistent


@pytest.mark.parametrize("pieces", [1, 2, 3, 5])
@pytest.mark.parametrize("shapes", ["quadrilaterals", "triangles", "both"])
def test_steps_of_the_thickness_are_closed(pieces, shapes):
    """Thick and thin side by side, three at a corner, a thin one inside, at rim and middle."""
    mesh = ms.mesh.rectangle(3.0, 2.0, (3, 2))
    if shapes != "quadrilaterals":
        mesh = ms.mesh.split(mesh)
    if shapes == "both":
        mesh = two_kinds()
    thickness = np.array([0.1, 0.2, 0.2, 0.1, 0.1, 0.3, 0.1, 0.2, 0.3, 0.3, 0.2, 0.2])[: len(mesh.elements)]
    for phi in (0.0, 0.4):
        body = shaped(mesh, thickness, phi)
        made = surface(body, pieces)
        solid = trimesh.Trimesh(made.points, made.triangles, process=False)
        edges = np.sort(made.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        _, counts = np.unique(edges, axis=0, return_counts=True)
        assert (counts % 2 == 0).all(), "an edge is open"
        assert solid.is_winding_consistent
        assert solid.is_watertight == (counts == 2).all()
        assert solid.is_watertight or shapes != "quadrilaterals", "no two bodies touch at an edge here"
        assert made.volume == pytest.approx(volume(body), rel=0.05 / pieces**2)


def two_kinds():
    """Quadrilaterals beside triangles."""
    mesh = ms.mesh.rectangle(3.0, 2.0, (3, 2))
    halves = ms.mesh.split(mesh)
    elements = np.concatenate([mesh.elements[:2], halves.elements[4:]])
    used, elements = np.unique(elements, return_inverse=True)
    return ms.mesh.Mesh(halves.points[used], elements.reshape(-1, 8))


def test_step_of_thickness_has_its_volume():
    mesh = ms.mesh.rectangle(3.0, 2.0, (3, 2))
    body = shaped(mesh, np.array([0.1, 0.2, 0.2, 0.1, 0.3, 0.2]), 0.3)
    check_closed(closed_surface(body), body)


def test_one_element_thicker_than_its_neighbours_rises_upright():
    mesh = ms.mesh.rectangle(3.0, 3.0, (3, 3))
    flat = body_of(mesh, mesh.points, np.tile([0.0, 0.0, 1.0], (len(mesh.points), 1)), heights_of(mesh, 4))
    made = surface(flat, 1)
    solid = trimesh.Trimesh(made.points, made.triangles, process=False)
    assert solid.is_watertight
    assert made.volume == pytest.approx(9 * 0.2 + 0.2, rel=1e-14)
    assert len(made.triangles) == 2 * 2 * 9 + 2 * 12 + 2 * 2 * 4
    risers = np.abs(np.abs(made.points[:, 2]) - 0.2) < 1e-12
    assert risers.sum() == 8


def heights_of(mesh, thick):
    h = np.full(len(mesh.elements), 0.2)
    h[thick] = 0.4
    return np.broadcast_to(np.multiply.outer([-0.5, 0.5], h)[..., None], (2, len(h), 8))


def test_tube_has_an_inside():
    mesh = ms.mesh.cylinder(10e-3, 20e-3, elements=(12, 3))
    normals = nodal_normals(mesh.points, mesh.elements)
    z = np.broadcast_to(np.array([-0.5e-3, 0.5e-3])[:, None, None], (2, len(mesh.elements), 8))
    body = body_of(mesh, mesh.points, normals, z)
    made = closed_surface(body)
    assert find_edges(mesh.elements).sharing.max() == 2
    check_closed(made, body)
    assert volume(body) == pytest.approx(2 * np.pi * 10e-3 * 1e-3 * 20e-3, rel=5e-4)
    assert trimesh.Trimesh(made.points, made.triangles).euler_number == 0


def test_triangles_are_wedges_and_closed(triangles, tmp_path):
    written = write_solid(triangles, tmp_path / "body.stl")
    solid = trimesh.load(tmp_path / "body.stl")
    assert solid.is_watertight
    assert solid.is_winding_consistent
    assert 1e-9 * solid.volume == pytest.approx(written.volume, rel=1e-6)
    grid = solid_grid(converged(triangles.discretisation, triangles.steps[-1]), triangles.steps[-1])
    assert (grid.celltypes == 26).all()


def shape_functions(cell):
    """VTK's own functions and derivatives of a cell, and its rule of integration in the parent cube or prism."""
    from vtkmodules.vtkCommonDataModel import vtkQuadraticHexahedron, vtkQuadraticWedge

    one = vtkQuadraticHexahedron() if cell == 25 else vtkQuadraticWedge()
    count = 20 if cell == 25 else 15
    s, w = np.polynomial.legendre.leggauss(6)
    s, w = 0.5 * (1 + s), 0.5 * w
    a, b, c = (axis.ravel() for axis in np.meshgrid(s, s, s, indexing="ij"))
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel()
    if cell == 26:
        weights, b = weights * (1 - a), b * (1 - a)
    derivatives = np.zeros((len(a), 3 * count))
    for row, place in zip(derivatives, zip(a, b, c, strict=True), strict=True):
        found = [0.0] * (3 * count)
        one.InterpolationDerivs(place, found)
        row[:] = found
    return derivatives.reshape(-1, 3, count), weights


@pytest.mark.parametrize("which", ["bent", "triangles"])
def test_solid_elements_have_the_volume_of_the_body(which, request, tmp_path):
    """Each of them is right side out, and together they fill what is between the faces to round-off."""
    import pyvista

    path = request.getfixturevalue(which)
    written = write_solid(path, tmp_path / "body.vtu")
    grid = pyvista.read(tmp_path / "body.vtu")
    assert grid.n_cells == written.cells == len(path.discretisation.mesh.elements)
    total = 0.0
    for number in range(grid.n_cells):
        cell = grid.GetCell(number)
        points = np.array([cell.GetPoints().GetPoint(i) for i in range(cell.GetNumberOfPoints())])
        derivatives, weights = shape_functions(grid.celltypes[number])
        jacobian = np.linalg.det(derivatives @ points)
        assert (jacobian > 0.0).all(), number
        total += jacobian @ weights
    assert total == pytest.approx(written.volume, rel=1e-12)
    u = path.steps[-1].state.u
    assert np.abs(np.abs(grid["displacement"]).max(axis=0) - np.abs(u).max(axis=0)).max() < 1e-15
    assert grid["energy"].sum() == pytest.approx(
        converged(path.discretisation, path.steps[-1]).energies[:, 0].sum(), rel=1e-12
    )
    assert grid.extract_surface(algorithm="dataset_surface").n_open_edges == 0


def test_bad_names_and_steps(bent, tmp_path):
    with pytest.raises(InputError, match=r"only .stl or .vtu can be written"):
        bent.export(tmp_path / "body.obj")
    with pytest.raises(InputError, match="There is no step 99"):
        bent.export(tmp_path / "body.stl", step=99)
    assert not list(tmp_path.iterdir())


def test_stl_has_outward_normals(bent):
    made = closed_surface(slab_of(converged(bent.discretisation, bent.steps[0])))
    content = stl(made)
    assert content[:5] != b"solid"
    count = int(np.frombuffer(content[80:84], "<u4")[0])
    assert len(content) == 84 + 50 * count
    records = np.frombuffer(content[84:], dtype=[("n", "<f4", 3), ("x", "<f4", (3, 3)), ("a", "<u2")])
    middle = records["x"].mean(axis=(0, 1))
    outward = np.einsum("ni,ni->n", records["n"], records["x"].mean(axis=1) - middle)
    assert (outward > 0.0).all()
