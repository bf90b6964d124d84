"""Mass and centroid against closed forms, thickness and curvature included."""

from __future__ import annotations

import numpy as np
import pytest
from solver.models import rubber

import magshell as ms
from magshell.errors import InputError

DENSITY = 1500.0


def of(mesh, thickness, group, **options):
    shell = ms.Shell(mesh, thickness, rubber(thickness), density=DENSITY, **options)
    return ms.Model(shell, [ms.Clamp(group)], ms.UniformField((0, 0, 0)), loads=[ms.Gravity((0, 0, -9.81))])


@pytest.mark.parametrize("element", ["quadratic", "paper"])
def test_of_a_plate(element):
    found = of(ms.mesh.rectangle(0.1, 0.04, (3, 2)), 2e-3, "left", element=element).mass
    assert found.total == pytest.approx(DENSITY * 0.1 * 0.04 * 2e-3, rel=1e-13)
    assert np.abs(found.centroid - [0.05, 0.02, 0.0]).max() < 1e-15


def test_of_a_plate_of_triangles():
    mesh = ms.mesh.split(ms.mesh.rectangle(0.1, 0.04, (3, 2)))
    found = of(mesh, 2e-3, "left").mass
    assert found.total == pytest.approx(DENSITY * 0.1 * 0.04 * 2e-3, rel=1e-12)
    assert np.abs(found.centroid - [0.05, 0.02, 0.0]).max() < 1e-13


def test_of_a_thick_shell_of_half_a_tube():
    """Of a thick one the centroid is further out than the mid-surface's: 2 (a³ - b³) / (3 (a² - b²)) · 2 / π."""
    radius, thickness, length = 10e-3, 4e-3, 20e-3
    mesh = ms.mesh.cylinder(radius, length, elements=(24, 2), angle=(0, 180))
    model = of(mesh, thickness, next(iter(mesh.edge_groups)))
    a, b = radius + thickness / 2, radius - thickness / 2
    out = 4.0 * (a**3 - b**3) / (3.0 * np.pi * (a**2 - b**2))
    assert out > 1.01 * 2.0 * radius / np.pi
    assert model.mass.total == pytest.approx(DENSITY * np.pi * radius * thickness * length, rel=1e-6)
    distances = np.sort(np.abs(model.mass.centroid))
    assert distances[0] < 1e-8
    assert distances[1] == pytest.approx(out, rel=1e-5)
    assert distances[2] == pytest.approx(length / 2, rel=1e-9)
    weight = sum(model.forces_at_rest)[:, :3].sum(axis=0)
    assert weight[2] == pytest.approx(-9.81 * model.mass.total, rel=1e-12)


def test_without_density():
    shell = ms.Shell(ms.mesh.rectangle(0.1, 0.04, (3, 2)), 2e-3, rubber(2e-3), ms.remanence.constant((0.1, 0, 0)))
    with pytest.raises(InputError, match="density is missing; the mass needs it"):
        _ = ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, 0, 1e-3))).mass
