"""Weight: density times acceleration times the volume of the body, solid between its two faces."""

from __future__ import annotations

import numpy as np
import pytest
from battery import each_element, for_element

import magshell as ms
from loads.cases import DENSITY, MESHES, applied, at_rest, each_patch, shell_of
from magshell.errors import InputError
from magshell.shell.normals import nodal_normals
from magshell.shell.shape_functions import gauss_legendre

G = np.array([0.3, -2.0, -9.8])
THICK = 0.5


def weight(shell, group=None):
    F = applied(ms.Gravity(G, group), shell).forces(at_rest(shell.mesh))
    assert not np.any(F[:, 3:])
    return F[:, :3]


def solid_volume(shell, elements):
    """Volume of elements as solids X(ξ, η) + z D(ξ, η), from differences of that position (exact to h⁴)."""
    mesh, element, count = shell.mesh, shell.element, shell.element.rest_nodes
    normals, rows = nodal_normals(mesh.points, mesh.elements), mesh.elements[elements]
    X, D_nodes = mesh.points[rows], normals[rows[:, :count]]
    parent, weights = gauss_legendre(7)

    def director(at):
        D = element.functions(count, at, X).values @ D_nodes
        return D / np.linalg.norm(D, axis=2, keepdims=True)

    def position(at, z):
        return element.functions(8, at, X).values @ X + z * director(at)

    def slope(axis, z, h=1e-3):
        near, far = (position(parent + k * h * axis, z) - position(parent - k * h * axis, z) for k in (1, 2))
        return (8.0 * near - far) / (12.0 * h)

    total = 0.0
    for s, share in zip(*np.polynomial.legendre.leggauss(3), strict=True):
        z = 0.5 * shell.thickness * s
        area = np.cross(slope(np.array([1.0, 0.0]), z), slope(np.array([0.0, 1.0]), z))
        total += 0.5 * shell.thickness * share * np.sum(area * director(parent), axis=2).sum(axis=0) @ weights
    return total


@each_element
@each_patch
def test_weight_is_that_of_the_solid(mesh, element):
    mesh = for_element(mesh, element)
    shell = shell_of(mesh, element)
    for group in (None, "half"):
        elements = np.arange(len(mesh.elements)) if group is None else mesh.element_groups[group]
        error = np.abs(weight(shell, group).sum(axis=0) / (DENSITY * G * solid_volume(shell, elements)) - 1.0).max()
        # five points leave of the area of these elements, which is no polynomial, less than this
        assert error < 1e-9, f"{group}: {error:.1e}"


def tube(count):
    """Inner and outer faces of a tube change area in opposite senses: the volume is that of the mid-surface times h."""
    return ms.mesh.cylinder(1.0, 1.0, (4 * count, 1)), 2.0 * np.pi * THICK


def cap(count):
    """A part of a sphere gains h²/12R²."""
    solid_angle = np.radians(60.0) * (np.cos(np.radians(60.0)) - np.cos(np.radians(120.0)))
    return ms.mesh.sphere_patch(1.0, (60, 120), (-30, 30), (count, count)), solid_angle * (THICK + THICK**3 / 12.0)


@each_element
@pytest.mark.parametrize("body", [tube, cap])
def test_thick_curved_bodies(body, element):
    """Towards the exact volume with the mesh, and closer to it than 1 % of what the curvature gives a sphere."""
    errors = []
    for count in (4, 8):
        mesh, volume = body(count)
        mesh = for_element(mesh, element)
        found = weight(shell_of(mesh, element, thickness=THICK)).sum(axis=0) @ G / (DENSITY * volume * G @ G)
        errors.append(abs(found - 1.0))
    assert errors[1] < 0.5 * errors[0], errors
    assert errors[1] < 0.01 * THICK**2 / 12.0, errors


def test_flat_bodies_have_no_moment_about_their_middle():
    mesh = MESHES["flat patch"]
    F = weight(shell_of(mesh))
    for about in np.random.default_rng(1).uniform(-5, 5, (3, 3)):
        centre = (mesh.points * F[:, [2]]).sum(axis=0) / F[:, 2].sum()
        moment, expected = np.cross(mesh.points - about, F).sum(axis=0), np.cross(centre - about, F.sum(axis=0))
        assert moment == pytest.approx(expected, abs=1e-12)


def test_it_needs_a_density():
    shell = ms.Shell(MESHES["flat patch"], 0.1, ms.MicropolarNeoHookean(1.0, 1.7, 0.3, 0.2))
    with pytest.raises(InputError, match=r"^shell: density is missing; gravity needs it$"):
        weight(shell)
