"""A law with a limit: uniaxial tension against its closed form, and a path that meets the limit."""

from __future__ import annotations

import numpy as np
import pytest
from battery import example, free_body, homogeneous, patch
from scipy.optimize import brentq

import magshell as ms
from magshell.equations.instant import Instant
from magshell.solver.extension import beyond

SIDE, THICKNESS, MU, LIMIT = 0.02, 1e-3, 1e5, 10.0
GENT = ms.MicropolarGent.from_moduli(shear_modulus=MU, poissons_ratio=0.4999, extension_limit=LIMIT)


def pulled(thickness_stretch, loads=(), stretch=None):
    """One element in uniaxial tension."""
    mesh = ms.mesh.rectangle(SIDE, SIDE, (1, 1))
    shell = ms.Shell(mesh, THICKNESS, GENT, thickness_stretch=thickness_stretch, micro_rotation=False)
    supports = [
        ms.SymmetryPlane("left", (1, 0, 0)),
        ms.SymmetryPlane("bottom", (0, 1, 0)),
        ms.Prescribe("bottom", "u", component=3),
    ]
    if stretch is not None:
        supports.append(ms.Prescribe("right", "u", component=1, value=(stretch - 1.0) * SIDE))
    return ms.Model(shell, supports, loads=loads, probes={"corner": (SIDE, SIDE, 0.0)})


def stretches(path):
    return 1.0 + path.probe("corner").u[:, 0] / SIDE


def nominal_stress(λ):
    """Of the law in uniaxial tension, with the lateral stretch at which the lateral stress vanishes."""
    k = GENT.lame_lambda - 2.0 * MU / LIMIT

    def stresses(across):
        log_J, x = np.log(λ * across**2), λ**2 + 2.0 * across**2 - 3.0
        slope = MU / (1.0 - x / LIMIT)
        return slope * λ - (MU - k * log_J) / λ, slope * across - (MU - k * log_J) / across

    across = brentq(lambda across: stresses(across)[1], 0.9 / np.sqrt(λ), 1.001 / np.sqrt(λ), xtol=1e-15)
    return stresses(across)[0], λ**2 + 2.0 * across**2 - 3.0


@pytest.mark.parametrize("thickness_stretch", ["linear", "plane-stress"])
def test_uniaxial_tension(thickness_stretch):
    greatest = 8e5
    force = ms.Force("right", (greatest * SIDE * THICKNESS, 0.0, 0.0))
    path = ms.solve(pulled(thickness_stretch, loads=[force]))
    expected, x = np.transpose([nominal_stress(λ) for λ in stretches(path)[1:]])
    assert x[-1] > 0.6 * LIMIT
    assert expected == pytest.approx([greatest * step.load_factor for step in path.steps[1:]], rel=1e-7)


def test_a_path_that_meets_the_limit_says_so():
    with pytest.raises(ms.SolveError, match=r"stretched to (99|100) % of the limit of its law in element 0") as caught:
        ms.solve(pulled("linear", stretch=4.0))
    λ = stretches(caught.value.path)[-1]
    assert 0.99 * LIMIT < λ**2 + 2.0 / λ - 3.0 < LIMIT
    assert all(np.isfinite(step.state.u).all() for step in caught.value.path.steps)


def test_a_state_beyond_the_limit_has_no_residual_and_is_told():
    """I1 - 3 is 14.25, the limit of the battery's law 9."""
    d = free_body(patch((1, 1)), example(ms.MicropolarGent))
    for stretch, told in ((1.5, ""), (4.0, ": element 0 is stretched to 158 % of the limit of its law")):
        state = homogeneous(d, np.diag([stretch, 1.0, stretch**-0.5]), np.eye(3))
        assembly = d.assemble(Instant(state, d.model.loading(1.0)), tangent=False)
        assert np.isfinite(assembly.worst[1]) == (not told)
        assert beyond(d, state) == told


def test_the_limit_of_a_layer():
    """Of a layer between two of laws without one, its own levels count."""
    neo, gent = example(ms.MicropolarNeoHookean), example(ms.MicropolarGent)
    for layers in ([neo, gent, neo], [gent, neo]):
        d = free_body(patch((1, 1)), layers=[ms.Layer(0.05, law) for law in layers])
        state = homogeneous(d, np.diag([4.0, 1.0, 0.5]), np.eye(3))
        assert beyond(d, state) == ": element 0 is stretched to 158 % of the limit of its law"
    d = free_body(patch((1, 1)), layers=[ms.Layer(0.05, neo), ms.Layer(0.05, neo)])
    assert beyond(d, homogeneous(d, np.diag([4.0, 1.0, 0.5]), np.eye(3))) == ""
