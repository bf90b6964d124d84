"""What the integration points do not see of the nodal values: it must fall like h², as the curvature of a smooth field.

Of a field on eight nodes the 2 × 2 points see the bilinear function through its values there. The nodal values less
that function are invisible: h²/2 times second derivatives in a smooth field, of any size in a pattern of hourglasses.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import magshell as ms
from elements.linear import Response, respond
from magshell import problem
from magshell.problem.building import build
from magshell.shell.shape_functions import NODES

FIELDS = {"u": slice(0, 3), "w": slice(3, 6), "micro-rotation": slice(7, 10)}


@cache
def gripper(divide: int) -> Response:
    """The gripper in 10 µT, every element divided into divide × divide."""
    source, file = problem.read("gripper")
    along, across = file.mesh.elements
    file = file.model_copy(
        update={"mesh": file.mesh.model_copy(update={"elements": (along * divide, across * divide)})}
    )
    model = build(file, source).model
    field = ms.UniformField(1e-5 * model.field.vector / np.linalg.norm(model.field.vector))
    return respond(ms.Model(model.shell, model.supports, field, model.coupling))


def invisible(response: Response, columns: slice) -> float:
    """Root mean square of what the points do not see over that of the field.

    Away from the clamp's corners, from the free edges and from the equator, where the remanence turns over: there the
    micro-rotation has layers of the width of the length scale.
    """
    mesh, element = response.discretisation.mesh, response.discretisation.model.shell.element
    x, y, z = mesh.points[mesh.elements].mean(axis=1).T
    polar, azimuth = np.degrees(np.arctan2(np.hypot(x, y), z)), np.degrees(np.arctan2(y, x))
    away = mesh.elements[(polar > 30.0) & (np.abs(polar - 90.0) > 15.0) & (np.abs(azimuth) < 10.0)]
    bilinear = lambda at: np.stack([np.ones(len(at)), *at.T, at[:, 0] * at[:, 1]], axis=1)  # noqa: E731
    through = bilinear(NODES) @ np.linalg.inv(bilinear(element.rule.points))
    functions = element.functions(8, element.rule.points, mesh.points[away]).values
    nodal = response.increment[away, columns]
    hidden = nodal - np.einsum("np,epm,emx->enx", through, functions, nodal)
    return float(np.sqrt(np.mean(hidden**2) / np.mean(nodal**2)))


@pytest.mark.parametrize("columns", FIELDS.values(), ids=FIELDS)
def test_invisible_part_falls_like_h2(columns: slice) -> None:
    coarse, fine = (invisible(gripper(divide), columns) for divide in (1, 2))
    print(f"{coarse:.1e}, {fine:.1e}: order {np.log2(coarse / fine):.2f}")
    assert coarse < 5e-3, f"{coarse:.1e} of the field"
    assert np.log2(coarse / fine) > 1.8, f"{coarse:.2e}, at half the size {fine:.2e}"
