"""The undeformed shell: base vectors, shifter, volumes of cylinders and spheres, and thicknesses that cannot be."""

from __future__ import annotations

import numpy as np
import pytest
from battery import PATCHES, SINGLES, THICKNESS, each_element, each_mesh, free_body

from magshell.errors import InputError
from magshell.mesh import cylinder, sphere_patch
from shell import oracle
from shell.point_oracle import two_levels


@each_element
@each_mesh(SINGLES | PATCHES)
def test_base_vectors_and_shifter(mesh, element):
    """Against the dual base and shifter of the paper, at every point and level."""
    d = free_body(mesh, element=element)
    geometry, couple_modulus = d.reference.geometry, d.model.shell.material.couple_modulus
    for e in range(len(d.mesh.elements)):
        for p, (parent, weight) in enumerate(oracle.points(d, e)):
            here = oracle.surface(d, e, parent)
            section = two_levels(THICKNESS, np.zeros(3), None)
            point = oracle.make_point(here.A, here.D, here.dD, weight, section, np.zeros(3))
            G = np.einsum("ai,kij->kaj", point.dual, point.Q_inverse)
            metric = couple_modulus * np.einsum("k,kai,kbi->ab", point.volume, G[:, :2], G[:, :2])
            for actual, expected, size in (
                (geometry.A[e, p], here.A, 1.0),
                (geometry.D[e, p], here.D, 1.0),
                (geometry.dD[e, p], here.dD, 1.0),
                (geometry.z[e, p], section.z, THICKNESS),
                (geometry.G[e, p], G, np.abs(G).max()),
                (geometry.volume[e, p], point.volume, point.volume.max()),
                (d.reference.body.points["couple_metric"][e, p], metric, np.abs(metric).max()),
            ):
                error = np.abs(actual - expected).max() / size
                assert error < 1e-14, f"element {e}, point {p}: {error:.1e}"


def order(errors):
    """Observed order of convergence between meshes of halved element size."""
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


RADIUS = 2.0
BODIES = {
    # mesh by number of elements, area, total Gaussian curvature, normal at points, order of the director at the points
    "cylinder": (
        lambda n: cylinder(RADIUS, 3.0, (n, n), angle=(10, 130)),
        np.radians(120) * 3.0 * RADIUS,
        0.0,
        lambda x: x * [1.0, 1.0, 0.0],
        3,
    ),
    "sphere": (
        lambda n: sphere_patch(RADIUS, polar=(40, 120), azimuth=(0, 90), elements=(n, n)),
        np.radians(90) * (np.cos(np.radians(40)) - np.cos(np.radians(120))) * RADIUS**2,
        np.radians(90) * (np.cos(np.radians(40)) - np.cos(np.radians(120))),
        lambda x: x,
        2,
    ),
}
each_body = pytest.mark.parametrize(("mesh_of", "area", "curvature", "normal", "power"), BODIES.values(), ids=BODIES)


@each_body
def test_volume_converges_to_the_shells(mesh_of, area, curvature, normal, power):
    """∫ det Q dz = h + K h³/12, two parts told apart by two thicknesses.

    The area of a quadratic surface converges with the fourth power of the element size. Gaussian curvature is that of
    the director, interpolated along great circles between normals: where mesh lines are no geodesics, the second power.
    """
    areas, curvatures = [], []
    for n in (8, 16, 32):
        thin, thick = (free_body(mesh_of(n), thickness=h).reference.geometry.volume.sum() / h for h in (0.2, 0.8))
        curvatures.append(abs(12 * (thick - thin) / (0.8**2 - 0.2**2) - curvature))
        areas.append(abs(thin - 0.2**2 * (thick - thin) / (0.8**2 - 0.2**2) - area) / area)
    assert areas[-1] < 1e-6, f"{areas}"
    assert order(areas)[-1] > 3.8, f"errors of the area {areas}, orders {order(areas)}"
    assert curvatures[-1] < 1e-2 * area / RADIUS**2, f"{curvatures}"
    if curvature:
        assert order(curvatures)[-1] > 1.8, f"errors of the curvature {curvatures}, orders {order(curvatures)}"
    else:
        assert max(curvatures) < 1e-12, f"a cylinder's curvature {curvatures}"


@each_element
@each_body
def test_director_converges_to_the_normal(mesh_of, area, curvature, normal, power, element):
    """At the Gauss points; with the third power where mesh lines are geodesics, else with the second."""
    errors = []
    for n in (4, 8, 16):
        d = free_body(mesh_of(n), element=element)
        worst = 0.0
        for e, row in enumerate(d.mesh.elements):
            for p, (parent, _) in enumerate(oracle.points(d, e)):
                x = d.mesh.points[row]
                exact = normal((oracle.six if oracle.is_triangle(x) else oracle.eight)(parent) @ x)
                worst = max(worst, np.abs(d.reference.geometry.D[e, p] - exact / np.linalg.norm(exact)).max())
        errors.append(worst)
    assert order(errors)[-1] > power - 0.2, f"errors {errors}, orders {order(errors)}"


@each_body
def test_nodal_normals_converge_to_the_normal(mesh_of, area, curvature, normal, power):
    errors = []
    for n in (4, 8, 16):
        d = free_body(mesh_of(n))
        assert np.abs(np.linalg.norm(d.normals, axis=1) - 1.0).max() < 1e-15
        exact = normal(d.mesh.points)
        errors.append(np.abs(d.normals - exact / np.linalg.norm(exact, axis=1, keepdims=True)).max())
    assert order(errors)[-1] > 1.8, f"errors {errors}, orders {order(errors)}"


def test_flat_shell_is_its_area_times_its_thickness():
    d = free_body(PATCHES["flat patch"]())
    boundary = d.mesh.points[d.mesh.boundary_edges]
    start, end = boundary[:, 0], boundary[:, 1]
    area = 0.5 * np.sum(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0])
    assert d.reference.geometry.volume.sum() == pytest.approx(area * THICKNESS, rel=1e-14)


TIGHT = {
    "cylinder": lambda: cylinder(1.0, 3.0, (8, 1), angle=(0, 180)),
    "sphere": lambda: sphere_patch(1.0, polar=(10, 170), azimuth=(0, 180), elements=(6, 6)),
}


@pytest.mark.parametrize("mesh_of", TIGHT.values(), ids=TIGHT)
def test_thickness_of_more_than_the_diameter_is_refused(mesh_of):
    """Inside the centre of curvature layers overlap: at the inner face, so before they do so at the Gauss points."""
    mesh = mesh_of()
    assert free_body(mesh, thickness=1.8).dofs
    with pytest.raises(InputError, match=r"thickness is larger than the curvature of element \d+ allows"):
        free_body(mesh, thickness=2.2)
