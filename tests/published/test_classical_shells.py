"""The shell of seven parameters with St Venant–Kirchhoff's law on published problems.

Tables: Sze, Liu and Lo, Finite Elem. Anal. Des. 40, 2004 (columns: P over its largest value, displacements in the
lengths of the problem). Every point within 1 % of the column's range.
"""

from __future__ import annotations

import pathlib

import numpy as np
import pytest
from battery import PATCHES, Unsupported, each_mesh
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.assembly import Discretisation

HERE = pathlib.Path(__file__).parent


def classical(youngs_modulus, poissons_ratio):
    """St Venant–Kirchhoff without the parameters of the micro-rotation."""
    mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
    lam = 2.0 * mu * poissons_ratio / (1.0 - 2.0 * poissons_ratio)
    return ms.MicropolarStVenantKirchhoff(mu, lam, 0.0, 0.0)


def compared(path, table, probe, columns):
    """Largest difference from the table's columns over their range; the table's loads by interpolation of the path.

    The path is smooth and its steps are short, so a cubic through four states is exact beside 1 %.
    """
    loads = table["load_ratio"]
    computed = path.probe(probe)
    worst = 0.0
    for name, value in columns.items():
        ours = interpolated(computed.load_factor, value(computed), loads)
        worst = max(worst, np.abs(ours - table[name]).max() / np.ptp(np.append(table[name], 0.0)))
    return worst


def interpolated(x, y, at):
    """Local cubics through four points."""
    values = []
    for point in at:
        first = int(np.clip(np.searchsorted(x, point) - 2, 0, len(x) - 4))
        nodes = slice(first, first + 4)
        values.append(np.polyval(np.polyfit(x[nodes] - point, y[nodes], 3), 0.0))
    return np.array(values)


def read(name):
    return np.genfromtxt(HERE / name, delimiter=",", names=True)


def test_cantilever_with_end_shear():
    mesh = ms.mesh.rectangle(10.0, 1.0, (16, 1))
    shell = ms.Shell(mesh, 0.1, classical(1.2e6, 0.0), micro_rotation=False)
    model = ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 4.0))], probes={"tip": (10, 0, 0)})
    path = ms.solve(model, ms.Settings(largest_step=0.1))
    columns = {"minus_u_tip": lambda tip: -tip.u1, "w_tip": lambda tip: tip.u3}
    worst = compared(path, read("cantilever_end_shear.csv"), "tip", columns)
    assert worst < 0.01, f"{100 * worst:.2f} %"


def test_hemisphere_with_a_hole():
    """A quarter, pulled outwards at one point of the equator and inwards at the other; 12 × 12 elements.

    2 %: this mesh is 1.2 % off what 24 × 24 elements give, and the table is of 16 × 16 four-node elements.
    """
    mesh = ms.mesh.sphere_patch(10.0, polar=(18, 90), azimuth=(0, 90), elements=(12, 12))
    mesh = mesh.select_nodes("out", x1=10.0, x2=0.0, x3=0.0).select_nodes("in", x1=0.0, x2=10.0, x3=0.0)
    shell = ms.Shell(mesh, 0.04, classical(6.825e7, 0.3), micro_rotation=False)
    supports = [
        ms.SymmetryPlane("left", (0, 1, 0)),
        ms.SymmetryPlane("right", (1, 0, 0)),
        ms.Prescribe("out", "u", 3, 0.0),
    ]
    loads = [ms.Force("out", (200.0, 0, 0)), ms.Force("in", (0, -200.0, 0))]
    model = ms.Model(shell, supports, loads=loads, probes={"out": (10, 0, 0), "in": (0, 10, 0)})
    path = ms.solve(model, ms.Settings(largest_step=0.1))
    table = read("hemisphere_18deg_hole.csv")
    worst = {
        "out": compared(path, table, "out", {"smaller_radial": lambda point: point.u1}),
        "in": compared(path, table, "in", {"larger_radial": lambda point: -point.u2}),
    }
    print({name: f"{100 * value:.2f} %" for name, value in worst.items()})
    assert max(worst.values()) < 0.02, worst


def free(mesh, thickness):
    """Discretisation of the body that nothing holds."""
    shell = ms.Shell(mesh, thickness, classical(1.0, 0.3), micro_rotation=False)
    body = Unsupported(shell, ms.UniformField((0, 0, 0)), ms.DeformationGradientEnergy(), (), ())
    return Discretisation(body, lambda graph: np.arange(graph.shape[0]))


@pytest.mark.parametrize("thickness", [0.15, 0.01])
@each_mesh(PATCHES)
def test_a_patch_has_six_zero_modes(mesh, thickness):
    """(A lone flat element has two more, the membrane modes of reduced integration; no two elements can share them.)"""
    d = free(mesh, thickness)
    K = d.assemble(d.undeformed(), d.model.loading(0.0)).matrix.toarray()
    scale = 1.0 / np.sqrt(np.diag(K))
    eigenvalues = np.abs(np.linalg.eigvalsh(scale[:, None] * K * scale))
    eigenvalues.sort()
    assert eigenvalues[5] < 1e-11 * eigenvalues[-1], eigenvalues[:8]
    assert eigenvalues[6] > 1e-3 * thickness**2 * eigenvalues[-1], eigenvalues[:8]


def test_a_turned_patch_is_free_of_forces():
    d = free(PATCHES["curved patch"](), 0.15)
    R = Rotation.from_rotvec([0.4, -2.0, 1.1]).as_matrix() - np.eye(3)
    state = d.undeformed()
    turned = state._replace(u=d.mesh.points @ R.T, w=d.normals @ R.T)
    stretched = state._replace(u=1e-3 * d.mesh.points)
    force, scale = (np.abs(d.assemble(s, d.model.loading(0.0)).residual).max() for s in (turned, stretched))
    assert force < 1e-11 * scale, f"{force:.1e} against {scale:.1e} of a stretch of 0.1 %"
