"""Loads on joints and rigid bodies: the tangent in equilibrium, and the balance with reactions."""

from __future__ import annotations

import numpy as np
import pytest
from battery import dense
from shell.test_parts import slope

import magshell as ms
from joints.bodies import FLAT, TEE, extruded
from magshell import solve
from magshell.equations.instant import Increment, Instant
from magshell.mesh import Mesh
from magshell.model.hinge import Hinge
from magshell.model.rigid_body import RigidBody
from magshell.solver.settings import Settings

WHOLE = "whole"
LOADS = {
    "dead force": [ms.Force("far", (6e-5, 3e-5, -9e-5))],
    "following force": [ms.Force("far", (6e-5, 3e-5, -9e-5), follower=True)],
    "moment": [ms.Moment("joint", (6e-5, 3e-5, -9e-5)), ms.Moment("far", (3e-5, -6e-5, 3e-5))],
    "following moment": [ms.Moment("joint", (6e-5, 3e-5, -9e-5), follower=True)],
    "pressure": [ms.Pressure("sheet1", 6e-4), ms.Pressure("sheet0", 3e-4)],
    "weight": [ms.Gravity((0.0003, 0.0006, -0.0015))],
}
SPRINGS = [ms.Spring("far", 1e-4, name="spring"), ms.Spring("joint", per_length=2e-4, direction=(1, 2, 3))]
TORSION = [ms.TorsionSpring("far", 2e-4, axis=(1, 2, 3), name="spring")]
MOMENT = (3.0, -1.0, 2.0)
BODIES = {
    "tee": {"lines": TEE},
    "rigid end": {"lines": FLAT, "rigid": [RigidBody("far", point=(2.5, 0.1, 0.7))]},
    "rigid sheet": {"lines": TEE, "rigid": [RigidBody("sheet2", name="far")]},
    "rigid joint": {"lines": TEE, "rigid": [RigidBody("joint", point=(0.2, 0.1, 0.3))]},
    "magnet": {"lines": FLAT, "rigid": [RigidBody("far", point=(2.5, 0.1, 0.7), moment=MOMENT, mass=0.1)]},
    "magnet at a joint": {"lines": TEE, "rigid": [RigidBody("joint", moment=MOMENT, mass=0.1)]},
    "sprung hinge": {"lines": FLAT, "hinges": [Hinge("joint", 3e-4)]},
    "sprung hinges of a tee": {"lines": TEE, "hinges": [Hinge("joint", 3e-4)]},
    "body on a torsion spring": {"lines": FLAT, "rigid": [RigidBody("far", point=(2.5, 0.1, 0.7))], "springs": TORSION},
    "body on springs": {"lines": TEE, "rigid": [RigidBody("far", point=(0.7, 0.2, 1.3))], "springs": SPRINGS},
}
HELD = {
    "free": [],
    "one rotation": [ms.Prescribe("far", "omega", 2, 0.3)],
    "two rotations": [ms.Prescribe("far", "omega", 1, 0.1), ms.Prescribe("far", "omega", 2, 0.3)],
}


def solved(lines, loads, supports=(), rigid=(), hinges=(), springs=()):
    mesh = extruded(lines)
    taken = [body.name for body in rigid if body.name != body.group]
    edges = {name: group for name, group in mesh.edge_groups.items() if name not in taken}
    mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, edges)
    magnets = ms.remanence.per_element(np.tile((0.5, 0.1, 0.2), (len(mesh.elements), 1)))
    rubber = ms.MicropolarNeoHookean(1.0, 1.7, length_scale=0.03)
    shell = ms.Shell(mesh, 0.1, rubber, magnets, density=1.0, rigid=rigid, hinges=hinges)
    field, held = ms.UniformField((1e-9, 2e-9, -3e-9)), [ms.Clamp("near"), *supports]
    model = ms.Model(shell, held, field, loads=loads, springs=springs)
    return solve(model, Settings(tolerance=1e-12))


def combinations():
    """Every one of each kind with every one of the others, of which `make verify` takes all three at a time."""
    for h, held in enumerate(HELD):
        for b, body in enumerate(BODIES):
            for l, loads in enumerate(LOADS):
                marks = () if (b + l) % len(HELD) == h else pytest.mark.verify
                yield pytest.param(HELD[held], BODIES[body], LOADS[loads], id=f"{held}-{body}-{loads}", marks=marks)


@pytest.mark.parametrize(("held", "body", "loads"), list(combinations()))
def test_tangent_in_equilibrium(body, loads, held):
    path = solved(loads=loads, supports=held, **body)
    d, step = path.discretisation, path.steps[-1]
    loading = path.model.loading(1.0)
    state, instant = step.state, Instant(step.state, loading)
    K = dense(d, d.assemble(instant).matrix)
    for seed in range(2):
        rng = np.random.default_rng(seed)
        nodal = d.rows.shared(0.02 * rng.uniform(-1, 1, d.free.shape) * d.free)
        d.assemble(instant)
        alpha = d.shell.recovered(nodal, whole=False)

        def residual(s, nodal=nodal, alpha=alpha):
            moved = d.moved(state, s * Increment(nodal, alpha))
            return (d.assemble(Instant(moved, loading), tangent=False).residual * d.free).ravel()

        expected, found = slope(residual), K @ (nodal * d.free).ravel()
        scale = np.abs(K) @ np.abs(nodal * d.free).ravel()
        assert np.abs(expected - found).max() < 1e-9 * scale.max()
        assert path.steps[-1].balance.force_imbalance < 1e-9
        assert path.steps[-1].balance.moment_imbalance < 1e-9
