"""Stresses jump where the thickness does: files, pages and pictures show both sides."""

from __future__ import annotations

import base64
import json
import re

import numpy as np
import pytest

import magshell as ms
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import OUTPUTS, find
from magshell.evaluation.patches import patches_of
from magshell.output.page import page
from magshell.output.shape import shown_values
from magshell.output.tessellation import Tessellation
from magshell.output.vtu import grid

WIDTH, LENGTH = 4e-3, 16e-3


@pytest.fixture(scope="module")
def path():
    """A strip that is twice as thick beyond its middle, under a force at its end."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 1))
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, {"thick": [2, 3]}, mesh.edge_groups)
    rubber = ms.MicropolarNeoHookean(1e5, 2e6, 1e4, 8e-5)
    shell = ms.Shell(mesh, 0.8e-3, rubber, regions=[ms.Region("thick", thickness=1.6e-3)])
    model = ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 1e-5))], outputs=["stress"])
    return ms.solve(model, ms.Settings(first_step=1.0))


def test_nodes_on_the_border_are_in_the_file_once_for_each_side(path):
    mesh, patches = path.model.shell.mesh, patches_of(path.model.shell)
    border = np.flatnonzero(np.abs(mesh.points[:, 0] - 0.5 * LENGTH) < 1e-9)
    found = grid(path.discretisation, path.steps[-1])
    node = found.point_data["node"]
    np.testing.assert_array_equal(node[: len(mesh.points)], np.arange(len(mesh.points)))
    assert sorted(node[len(mesh.points) :]) == sorted(border)
    np.testing.assert_array_equal(found.points, mesh.points[node])
    np.testing.assert_array_equal(node[found.cells.reshape(-1, 9)[:, 1:]], mesh.elements)
    np.testing.assert_array_equal(
        found.point_data["displacement"], path.steps[-1].state.displacement(len(mesh.points))[node]
    )
    stress = found.point_data["stress_top"]
    np.testing.assert_array_equal(
        stress, OUTPUTS["stress_top"].evaluate(converged(path.discretisation, path.steps[-1]))
    )
    for one in border:
        thin, thick = sorted(np.abs(stress[node == one, 0]))
        assert thick > 2.0 * thin, "a quarter of the stress on the thick side, roughly"
    np.testing.assert_array_equal(patches.nodes, node)


def test_pages_and_pictures_show_both_sides(path):
    patches = patches_of(path.model.shell)
    text = page(path, color="s11_top")
    header = json.loads(re.search(r'id="header">(.*?)</script>', text)[1])
    rows = {about["name"]: about["rows"] for about in header["outputs"]}
    assert rows["stress_top"] == rows["displacement"] == len(patches.nodes)
    elements, nodes = (
        np.frombuffer(base64.b64decode(re.search(rf'id="array-{name}">(.*?)</script>', text)[1]), dtype="<u4")
        for name in ("elements-0", "nodes")
    )
    np.testing.assert_array_equal(nodes[elements.reshape(-1, 8)[:4]], patches.elements, "the upper faces come first")
    assert header["colour"] == "stress_top 0"
    tessellation = Tessellation(path.model.shell.mesh.elements, 2)
    (shown,) = shown_values(path, path.steps[-1:], *find("s11_top"), tessellation)
    positions = tessellation.at_points(path.model.shell.mesh.points)
    at = np.abs(positions - [0.5 * LENGTH, 0.5 * WIDTH, 0.0]).max(axis=1) < 1e-9
    sides = np.sort(np.abs(shown[at]))
    assert len(sides) == 2
    assert sides[1] > 2.0 * sides[0]


def test_values_of_a_path(path):
    reached = converged(path.discretisation, path.steps[-1])
    np.testing.assert_array_equal(path.values("stress_top"), OUTPUTS["stress_top"].evaluate(reached))
    np.testing.assert_array_equal(path.values("s12_top"), path.values("stress_top")[:, 3])
    np.testing.assert_array_equal(path.values("u3", step=0), 0.0)
    with pytest.raises(ms.InputError, match="There is no step 7; the path has steps 0 to"):
        path.values("u3", step=7)
    with pytest.raises(ms.InputError, match="There is no output 'sigma' to show"):
        path.values("sigma")
