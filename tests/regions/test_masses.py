"""Weight of regions and layers against hand sums: forces, and their moments where the mass lies off the mesh."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.model.rows import rows_of
from magshell.shell.normals import nodal_normals
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS
from regions.models import LENGTH, SOFT, STIFF, WIDTH, of_regions, strip

G = np.array([0.3, -2.0, -9.8])


def forces(shell, group=None):
    state = State.undeformed(len(shell.mesh.points), len(shell.mesh.elements), 0)
    return ms.Gravity(G, group).applied(shell, rows_of(shell)).forces(state)[: len(state.u)]


def moment(shell, F):
    normals = nodal_normals(shell.mesh.points, shell.mesh.elements)
    arms = np.cross(shell.mesh.points, F[:, COLUMNS["u"]]) + np.cross(normals, F[:, COLUMNS["w"]])
    return arms.sum(axis=0)


def test_weight_of_regions():
    shell = of_regions(ms.Region("outer", 0.4e-3, density=2000.0), density=1000.0)
    area = 0.5 * LENGTH * WIDTH
    inner, outer = area * 1e-3 * 1000.0, area * 0.4e-3 * 2000.0
    F = forces(shell)
    assert not F[:, COLUMNS["w"]].any()
    np.testing.assert_allclose(F[:, COLUMNS["u"]].sum(axis=0), (inner + outer) * G, rtol=1e-13)
    for group, mass in (("inner", inner), ("outer", outer)):
        np.testing.assert_allclose(forces(shell, group)[:, COLUMNS["u"]].sum(axis=0), mass * G, rtol=1e-13)
    centre = np.array([inner * 0.25 * LENGTH + outer * 0.75 * LENGTH, (inner + outer) * 0.5 * WIDTH, 0.0])
    np.testing.assert_allclose(moment(shell, F), np.cross(centre, G), rtol=1e-12, atol=1e-18)


def test_weight_acts_at_the_height_of_the_layers():
    """Flush at the bottom: the centre of a layer lies half its thickness above its bottom."""
    layers = [ms.Layer(0.6e-3, SOFT, density=1000.0), ms.Layer(0.2e-3, STIFF, density=5000.0)]
    shell = ms.Shell(strip(), layers=layers, offset="bottom")
    masses = np.array([0.6e-3 * 1000.0, 0.2e-3 * 5000.0]) * LENGTH * WIDTH
    height = masses @ [0.3e-3, 0.7e-3]
    centre = np.array([masses.sum() * 0.5 * LENGTH, masses.sum() * 0.5 * WIDTH, height])
    F = forces(shell)
    np.testing.assert_allclose(F[:, COLUMNS["u"]].sum(axis=0), masses.sum() * G, rtol=1e-13)
    np.testing.assert_allclose(moment(shell, F), np.cross(centre, G), rtol=1e-12)


def test_weight_of_a_taper():
    taper = ms.thickness.profile([1, 0, 0], [0.0, LENGTH], [1e-3, 0.5e-3])
    shell = ms.Shell(strip(), taper, SOFT, density=1000.0)
    mass = 0.75e-3 * LENGTH * WIDTH * 1000.0
    x = WIDTH * 1000.0 * (1e-3 * LENGTH**2 / 2 - 0.5e-3 * LENGTH**2 / 3)
    F = forces(shell)
    np.testing.assert_allclose(F[:, COLUMNS["u"]].sum(axis=0), mass * G, rtol=1e-12)
    np.testing.assert_allclose(moment(shell, F), np.cross([x, 0.5 * mass * WIDTH, 0.0], G), rtol=1e-10, atol=1e-18)


@pytest.mark.parametrize(("offset", "inner"), [("middle", -0.5), ("bottom", 0.0), ("top", -1.0), (0.2, -0.7)])
def test_volume_of_a_tube_with_an_offset(offset, inner):
    """Between two circles: of the mesh and of the faces, which the offset moves."""
    R, h, length = 1.0, 0.5, 2.0
    given = offset if isinstance(offset, str) else offset * h
    mesh = ms.mesh.cylinder(R, length, (48, 1))
    shell = ms.Shell(mesh, h, ms.MicropolarNeoHookean(1.0, 1.7, 0.3, 0.2), offset=given, density=1.0)
    low = R + inner * h
    exact = np.pi * ((low + h) ** 2 - low**2) * length
    found = forces(shell)[:, COLUMNS["u"]].sum(axis=0)
    np.testing.assert_allclose(found, exact * G, rtol=2e-6)


@pytest.mark.parametrize(
    ("shell", "where"),
    [
        (lambda: of_regions(ms.Region("outer", density=1000.0)), "^shell: density is missing; gravity needs it$"),
        (
            lambda: ms.Shell(
                strip(), 1e-3, SOFT, density=1.0, regions=[ms.Region("outer", layers=[ms.Layer(1e-3, SOFT)])]
            ),
            None,
        ),
        (
            lambda: of_regions(ms.Region("outer", layers=[ms.Layer(1e-3, SOFT, density=1.0), ms.Layer(1e-3, SOFT)])),
            r"^shell: density is missing",
        ),
        (
            lambda: ms.Shell(
                strip(),
                regions=[
                    ms.Region("inner", 1e-3, SOFT, density=1.0),
                    ms.Region("outer", layers=[ms.Layer(1e-3, SOFT, density=1.0), ms.Layer(1e-3, SOFT)]),
                ],
            ),
            r"^region 'outer': layers\[1\]: density is missing; gravity needs it$",
        ),
    ],
)
def test_who_has_no_density(shell, where):
    if where is None:
        assert np.isfinite(forces(shell())).all()
        return
    with pytest.raises(ms.InputError, match=where):
        forces(shell())
    assert np.isfinite(forces(of_regions(ms.Region("outer", density=1000.0)), "outer")).all()
