"""Half a body with a mirror plane is half of the whole one, curved or not."""

from __future__ import annotations

import numpy as np
import pytest
from battery import MATERIAL, THICKNESS, example

import magshell as ms
from magshell.mesh import Mesh

RADIUS, PUSH = 1.0, 0.1


def arch(stop, elements, supports, crown):
    """An arch of a tube about X3 from angle 0 to `stop`, its crown (group `crown`) pushed down by PUSH."""
    mesh = ms.mesh.cylinder(RADIUS, 0.5, (elements, 1), angle=(0.0, stop))
    top = np.flatnonzero(np.abs(mesh.points[:, 0]) < 1e-9)
    mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups, {crown: top})
    push = ms.Prescribe(crown, "u", 2, -PUSH)
    return ms.Model(ms.Shell(mesh, THICKNESS, example(MATERIAL)), [ms.Clamp("angle-start"), push, *supports])


@pytest.mark.parametrize("elements", [2, 4])
def test_half_an_arch_is_half_of_it(elements):
    half = ms.solve(arch(90.0, elements, [ms.SymmetryPlane("angle-stop", (1, 0, 0))], "crown"))
    whole = ms.solve(arch(180.0, 2 * elements, [ms.Clamp("angle-stop")], "crown"))
    points, u = whole.model.shell.mesh.points, whole.steps[-1].state.u
    for point, displacement in zip(half.model.shell.mesh.points, half.steps[-1].state.u, strict=True):
        same = np.argmin(np.linalg.norm(points - point, axis=1))
        error = np.abs(u[same] - displacement).max() / PUSH
        assert error < 1e-8, f"{error:.1e} at {point}"
