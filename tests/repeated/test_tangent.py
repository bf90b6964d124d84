"""The tangent and the rates of repeated parts, with jumps, against differences."""

from __future__ import annotations

import numpy as np
import pytest
from battery import COUPLING, FIELD, Unsupported, dense, example
from shell.test_parts import slope

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Increment, Instant
from repeated.bodies import AXIS, POINT, SECTORS, remanence, shell
from repeated.test_cyclic import BODIES
from repeated.test_periodic import cell


def sector(name):
    body = BODIES[name]
    mesh = body.mesh
    cyclic = ms.Cyclic("start", "stop", sectors=SECTORS, axis=AXIS, point=POINT)
    return shell(mesh, body.made(remanence(mesh)), remanence(mesh), repeated=[cyclic])


def cells():
    mesh = cell()
    return shell(mesh, {}, remanence(mesh), repeated=[ms.Periodic("left", "right"), ms.Periodic("bottom", "top")])


def sectors_of_cells():
    """Cyclic and periodic at once: a tube."""
    mesh = ms.mesh.cylinder(1.0, 0.7, (2, 2), angle=(0.0, 60.0))
    repeated = [ms.Cyclic("angle-start", "angle-stop", sectors=6), ms.Periodic("start", "end", "along")]
    return shell(mesh, {}, remanence(mesh), repeated=repeated)


SHELLS = {name: (lambda name=name: sector(name)) for name in BODIES} | {"cell": cells, "tube": sectors_of_cells}


@pytest.mark.parametrize("make", SHELLS.values(), ids=SHELLS)
def test_tangent(make):
    made = make()
    body = Unsupported(made, ms.UniformField(FIELD), example(COUPLING))
    d = Discretisation(body, lambda graph: np.arange(graph.shape[0]))
    loading = body.loading(0.3)
    rng = np.random.default_rng(3)

    def increment(size):
        nodal = d.rows.jumped(d.rows.shared(size * rng.uniform(-1, 1, d.free.shape) * d.free))
        return d.to_global(nodal), nodal * d.free

    d.assemble(Instant(d.undeformed(), loading))
    start, _ = increment(0.02)
    state = d.moved(d.undeformed(), Increment(start, np.zeros_like(d.undeformed().alpha)))
    moving, own = increment(0.02)
    K = dense(d, d.assemble(Instant(state, loading)).matrix)
    alpha = d.shell.recovered(moving, whole=False)

    def residual(s):
        moved = d.moved(state, s * Increment(moving, alpha))
        return (d.assemble(Instant(moved, loading), tangent=False).residual * d.free).ravel()

    expected, found = slope(residual), K @ own.ravel()
    at_rotations = np.zeros(d.free.shape, dtype=bool)
    at_rotations[:, 7:10] = True
    scale = np.abs(K) @ np.abs(own).ravel()
    error = np.abs(expected - found)[~at_rotations.ravel()]
    assert error.max() < 1e-8 * scale.max()
