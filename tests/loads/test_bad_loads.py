"""Loads that make no sense are refused, with the group and what would be right."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from battery import MATERIAL, example

import magshell as ms
from loads.bodies import grouped
from magshell.errors import InputError

MESH = grouped(ms.mesh.rectangle(3.0, 1.0, (3, 1)))
CLAMP = [ms.Clamp("left")]
corners_only = partial(ms.Shell, element="paper")


def model(*loads, shell=ms.Shell, material=None, **options):
    return ms.Model(shell(MESH, 0.1, material or example(MATERIAL)), CLAMP, loads=loads, **options)


@pytest.mark.parametrize(
    ("load", "message"),
    [
        (ms.Force("rihgt", (1, 0, 0)), r"loads: force on 'rihgt': There is no group 'rihgt'.*Did you mean 'right'\?"),
        (ms.Moment("tpo", (1, 0, 0)), r"loads: moment on 'tpo': There is no group.*Did you mean 'top'\?"),
        (ms.Force("right", (1, float("nan"), 0)), "loads: force on 'right': total is .*nan.*3 finite components"),
        (ms.Moment("right", (float("inf"), 0, 0)), "loads: moment on 'right': total is .*inf.*3 finite components"),
        (ms.Force("right", (1, 0)), "loads: force on 'right': total is .*3 finite components"),
        (ms.Force("right", 1.0), "loads: force on 'right': total is 1.0; it needs 3 finite components"),
        (ms.Force("right", ("1 N", 0, 0)), "loads: force on 'right': total is .*takes three numbers"),
        (ms.Force("right", (0, 0, 0)), "loads: force on 'right': total is zero; leave the load out"),
    ],
)
def test_refused(load, message):
    with pytest.raises(InputError, match=message):
        model(ms.Force("right", (0, 0, 1)), load)


def test_a_moment_needs_a_node_that_rotates():
    with pytest.raises(InputError, match=r"loads: moment on 'mid-sides': node \d+ is a mid-side node .* corner nodes"):
        model(ms.Moment("mid-sides", (0, 1, 0)), shell=corners_only)
    nodal = model(ms.Force("mid-sides", (0, 1, 0)), shell=corners_only).nodal_loads
    assert np.count_nonzero(nodal) == 3


def test_a_load_is_enough():
    loaded = model(ms.Force("right", (0, 0, 1)))
    assert loaded.field.magnitude == 0.0
    assert not np.any(loaded.shell.remanence(MESH, MESH.points[MESH.elements]))


def test_nothing_loads():
    with pytest.raises(InputError, match=r"field: flux_density is zero.*nor is there a load: nothing loads the shell"):
        model()
    with pytest.raises(InputError, match=r"remanence: it is zero.*nor is there a load: nothing loads the shell"):
        model(field=ms.UniformField((0, 0, 1)))
    with pytest.raises(InputError, match="nothing loads the shell"):
        model(ms.Force("right", (0, 0, 1)), ms.Force("right", (0, 0, -1)))


def test_a_moment_needs_a_coupling_modulus():
    rigid = example(MATERIAL)._replace(coupling_modulus=0.0)
    with pytest.raises(InputError, match=r"coupling_modulus is 0.*that a moment works on never reaches"):
        model(ms.Moment("right", (0, 1, 0)), material=rigid)
    assert np.any(model(ms.Force("right", (0, 0, 1)), material=rigid).nodal_loads)
