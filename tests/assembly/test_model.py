"""The model as data: what it is given, what it refuses, its probes."""

from __future__ import annotations

import numpy as np
import pytest
from battery import COUPLING, MATERIAL, example

import magshell as ms
from magshell.errors import InputError
from magshell.mesh import rectangle

MESH = rectangle(3.0, 1.0, (3, 1))
ALONG = ms.remanence.constant((1.0, 0.0, 0.0))
FIELD = ms.UniformField((0.0, 0.0, 1.0))


def shell(thickness=0.1, remanence=ALONG):
    return ms.Shell(MESH, thickness, example(MATERIAL), remanence)


@pytest.mark.parametrize(
    ("thickness", "message"),
    [
        (0.0, "thickness is 0 m; it must be positive and finite"),
        (-1.0, "thickness is -1 m; it must be positive and finite"),
        (float("nan"), "thickness is nan m; it must be positive and finite"),
        ("thin", "thickness is 'thin'; it must be a number"),
        (4.0, r"thickness is 4 m, larger than the .*body \(3\.16\d* m\)"),
    ],
)
def test_thickness(thickness, message):
    with pytest.raises(InputError, match=message):
        shell(thickness)


def test_probes_are_nodes():
    model = ms.Model(shell(), [ms.Clamp("left")], FIELD, probes={"tip": (3.0, 0.5, 0.0), "corner": (0.0, 1.0, 0.0)})
    assert {name: MESH.points[node].tolist() for name, node in model.probe_nodes.items()} == {
        "tip": [3.0, 0.5, 0.0],
        "corner": [0.0, 1.0, 0.0],
    }


def test_a_probe_off_the_nodes_is_named():
    with pytest.raises(InputError, match=r"probe 'tip': .*nearest"):
        ms.Model(shell(), [ms.Clamp("left")], FIELD, probes={"tip": (2.9, 0.5, 0.0)})


def test_the_couple_is_the_default_law():
    assert isinstance(ms.Model(shell(), [ms.Clamp("left")], FIELD).coupling, COUPLING)


def test_nothing_that_loads_the_shell():
    none = ms.UniformField((0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="flux_density is zero and no support moves"):
        ms.Model(shell(), [ms.Clamp("left")], none)
    with pytest.raises(InputError, match="remanence: it is zero everywhere and no support moves"):
        ms.Model(shell(remanence=ms.remanence.constant((0.0, 0.0, 0.0))), [ms.Clamp("left")], FIELD)
    lifted = [ms.Clamp("left"), ms.Prescribe("right", "u", 3, 0.1)]
    assert np.any(ms.Model(shell(), lifted, none).constraints.values[0])


def test_normals_of_a_flat_mesh():
    assert np.array_equal(ms.Model(shell(), [ms.Clamp("left")], FIELD).normals, [[0.0, 0.0, 1.0]] * len(MESH.points))
