"""Loads that make no sense are refused, with the group and what would be right."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from battery import MATERIAL, example

import magshell as ms
from loads.bodies import grouped
from loads.cases import at_rest
from magshell.errors import InputError

MESH = grouped(ms.mesh.rectangle(3.0, 1.0, (3, 1)))
CLAMP = [ms.Clamp("left")]
corners_only = partial(ms.Shell, element="paper")
classical = partial(ms.Shell, micro_rotation=False)
CLASSICAL = example(MATERIAL)._replace(coupling_modulus=0.0, length_scale=0.0)


def model(*loads, shell=ms.Shell, material=None, **options):
    return ms.Model(shell(MESH, 0.1, material or example(MATERIAL), density=1.0), CLAMP, loads=loads, **options)


def forces(model):
    """All loads at rest, (nodes, 11)."""
    return sum(applied.forces(at_rest(MESH)) for applied in model.applied)


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
        (ms.Traction("right", (1, 0, 0)), r"loads: traction on 'right': 'right' is a group of edges, not of elements"),
        (
            ms.Traction("hafl", (1, 0, 0)),
            r"loads: traction on 'hafl': There is no element group.*Did you mean 'half'\?",
        ),
        (ms.Traction("half", 1.0), "loads: traction on 'half': traction is 1.0; it needs 3 finite components"),
        (ms.Traction("half", (0, 0, 0)), "loads: traction on 'half': traction is zero; leave the load out"),
        (ms.Pressure("scattered", 1.0), r"loads: pressure on 'scattered': 'scattered' is a group of nodes"),
        (ms.Pressure("half", float("nan")), "loads: pressure on 'half': pressure is nan; it must be finite"),
        (ms.Pressure("half", (0, 0, 1)), r"loads: pressure on 'half': pressure is \(0, 0, 1\); it takes one number"),
        (ms.Pressure("half", "1 kPa"), "loads: pressure on 'half': pressure is '1 kPa'; it takes one number"),
        (ms.Pressure("half", 0.0), "loads: pressure on 'half': pressure is zero; leave the load out"),
        (ms.Gravity((0, 0, -9.81), "left"), "loads: gravity on 'left': 'left' is a group of edges, not of elements"),
        (ms.Gravity((0, -9.81)), "loads: gravity: acceleration is .*3 finite components"),
        (ms.Gravity((0, 0, 0)), "loads: gravity: acceleration is zero; leave the load out"),
    ],
)
def test_refused(load, message):
    with pytest.raises(InputError, match=message):
        model(ms.Force("right", (0, 0, 1)), load)


def test_a_moment_needs_a_node_that_rotates():
    with pytest.raises(InputError, match=r"loads: moment on 'mid-sides': node \d+ is a mid-side node .* corner nodes"):
        model(ms.Moment("mid-sides", (0, 1, 0)), shell=corners_only)
    with pytest.raises(InputError, match=r"loads: force on 'mid-sides': node \d+ is a mid-side node .* corner nodes"):
        model(ms.Force("mid-sides", (0, 1, 0), follower=True), shell=corners_only)
    assert np.count_nonzero(forces(model(ms.Force("mid-sides", (0, 1, 0)), shell=corners_only))) == 3


@pytest.mark.parametrize("load", [ms.Force, ms.Moment])
def test_a_follower_needs_something_to_turn_with(load):
    with pytest.raises(InputError, match=rf"loads: {load.kind} on 'right': a follower turns .* leave follower out"):
        model(load("right", (0, 1, 0), follower=True), shell=classical, material=CLASSICAL)


@pytest.mark.parametrize(
    ("history", "message"),
    [
        (0.5, r"loads: pressure on 'half': history is 0.5; it takes finite numbers"),
        ("full", r"loads: pressure on 'half': history is 'full'; it takes numbers"),
        ((), r"loads: pressure on 'half': history is \(\); it takes finite numbers"),
        ((1.0, float("nan")), r"loads: pressure on 'half': history is \(1.0, nan\); it takes finite numbers"),
        ((1.0, None), r"loads: pressure on 'half': history is \(1.0, None\); it takes finite numbers"),
        (((1.0,), (2.0,)), r"loads: pressure on 'half': history is .*; it takes finite numbers"),
    ],
)
def test_histories_that_are_none(history, message):
    with pytest.raises(InputError, match=message):
        ms.Pressure("half", 1.0, history)


def test_history_is_kept_as_numbers():
    assert ms.Gravity((0, 0, -9.81), history=[1, 0.5]).history == (1.0, 0.5)
    assert ms.Force("right", (0, 0, 1)).history is None


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
        model(ms.Force("right", (0, 0, 1), history=(0.0, 0.0)))


def test_a_moment_needs_a_coupling_modulus():
    rigid = example(MATERIAL)._replace(coupling_modulus=0.0)
    with pytest.raises(InputError, match=r"coupling_modulus is 0.*that a moment works on never reaches"):
        model(ms.Moment("right", (0, 1, 0)), material=rigid)
    assert np.any(forces(model(ms.Force("right", (0, 0, 1)), material=rigid)))
