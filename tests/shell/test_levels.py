"""A stretch of its own at every level, eliminated at the point: against jets that have it as a variable."""

from __future__ import annotations

import numpy as np
import pytest
from battery import COUPLINGS as ALL_COUPLINGS
from battery import FIELD, SINGLES, free_body, name_of, scaled_error

from magshell.model.reference import make_of
from magshell.shell.body import reference_of
from magshell.shell.geometry import Sections
from shell import point_oracle
from shell.kernel_access import energy_gradient_and_hessian, pack, unpack
from shell.point_oracle import Section, eliminated, make_point
from shell.test_point import random_point
from shell.test_several_laws import MATERIALS, surface_of

each_coupling = pytest.mark.parametrize("coupling", [*ALL_COUPLINGS, None], ids=[*map(name_of, ALL_COUPLINGS), "other"])


def section_of(levels, seed, warped):
    """Levels of uneven heights, each of another law and remanence."""
    rng = np.random.default_rng(seed)
    heights = rng.uniform(0.5, 1.5, levels)
    heights *= 0.15 / heights.sum()
    z = np.cumsum(heights) - 0.5 * heights - 0.06
    materials = [MATERIALS[k % len(MATERIALS)] for k in range(levels)]
    warping = rng.uniform(-0.6, 0.5, levels) if warped else np.zeros(levels)
    return Section(z, heights, rng.uniform(-1, 1, (levels, 3)), materials, warping, by_level=True)


def body_of(d, section):
    """The kernels' arrays of the section at every point of a body."""
    shape = (*d.reference.geometry.volume.shape[:2], len(section.z))
    spread = lambda values: np.broadcast_to(values, (*shape, *np.shape(values)[1:])).copy()  # noqa: E731
    numbers = np.array([[next(n for n, one in enumerate(MATERIALS) if one is law) for law in section.materials]])
    make = make_of(d.model)._replace(
        sections=Sections(spread(section.z), spread(section.heights)),
        levels=np.array([len(section.z)]),
        by_level=np.array([True]),
        warping=spread(section.warping),
        remanence=spread(section.remanence),
        materials=MATERIALS,
        material_of=numbers,
        coupling_of=np.zeros_like(numbers),
    )
    return reference_of(surface_of(d), make).body


def point_with(d, section):
    """Point 0 of the body for the oracle, from the discretisation's own mid-surface."""
    geometry = d.reference.geometry
    weight = d.model.shell.element.rule.weights[0]
    return make_point(geometry.A[0, 0], geometry.D[0, 0], geometry.dD[0, 0], weight, section, np.array(FIELD))


def seen(d, seed):
    """A random x (31,) without φ."""
    parts = unpack(random_point(d, seed))
    return pack(parts | {"phi": np.zeros(())})


@each_coupling
@pytest.mark.parametrize("levels", [1, 2, 3, 6])
@pytest.mark.parametrize("warped", [False, True], ids=["plain", "warped"])
def test_energy_gradient_and_hessian(request, coupling, levels, warped):
    coupling = coupling or request.getfixturevalue("nonlinear")
    d = free_body(SINGLES["curved"](), coupling=coupling)
    for seed in range(2):
        section = section_of(levels, seed, warped)
        x = seen(d, seed)
        expected = eliminated(unpack(x), coupling, point_with(d, section))
        energies, g, H = energy_gradient_and_hessian(d, 0, 0, x, FIELD, body_of(d, section))
        errors = {
            "energy": abs(energies[0] / expected.energy - 1.0),
            "internal gradient": scaled_error(g[:, 0], expected.internal),
            "magnetic gradient": scaled_error(g[:, 1], expected.magnetic),
            "Hessian": scaled_error(H, expected.hessian),
        }
        if levels > 1:
            assert np.abs(expected.zeta).max() > 1e-5, "the levels do not stretch"
        assert max(errors.values()) < 1e-11, f"state {seed}: {errors}"


def test_the_field_stretches_levels_that_are_magnetised_across():
    """Otherwise the test above says nothing of the coupling's part of the force on ζ."""
    d = free_body(SINGLES["curved"]())
    section, x = section_of(3, 0, warped=False), seen(d, 0)
    coupling = ALL_COUPLINGS[[name_of(one) for one in ALL_COUPLINGS].index("DeformationGradientEnergy")]
    point = point_with(d, section)
    with_field, without = (
        point_oracle.stretches(unpack(x), coupling, at) for at in (point, point._replace(B=np.zeros(3)))
    )
    assert np.abs(with_field - without).max() > 0.01


def test_the_mean_stretch_vanishes_and_the_force_is_the_same_everywhere():
    """Of the kernels' own solution: Σ c_k ζ_k = 0, and a change of ζ that keeps it does no work."""
    d = free_body(SINGLES["curved"](), coupling=ALL_COUPLINGS[0])
    section, x = section_of(6, 3, warped=True), seen(d, 1)
    expected = eliminated(unpack(x), ALL_COUPLINGS[0], point_with(d, section))
    assert abs(section.heights @ expected.zeta) < 1e-14
    assert np.ptp(expected.zeta) > 1e-2
