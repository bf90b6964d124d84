"""The composite's helper, against the formulas written out."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError
from magshell.materials import mixture as module
from magshell.materials.mixture import STIFFENINGS, Composite

MATRIX = {"youngs_modulus": 60e3, "poissons_ratio": 0.49}


@pytest.mark.parametrize(
    ("stiffening", "factor"),
    [
        ("guth-gold", 1.0 + 0.5 + 0.564),
        ("mooney", math.exp(0.5 / 0.73)),
        ("krieger-dougherty", 1.0 / (0.44 / 0.64) ** 1.6),
    ],
)
def test_a_fifth_of_powder(stiffening, factor):
    found = ms.composite(0.2, 0.715, stiffening=stiffening, **MATRIX)
    mu = 60e3 / 2.98
    assert found == pytest.approx((factor * mu, factor * mu * 49.0, 0.143, 0.2 * 7600 + 0.8 * 1070), rel=1e-12)
    assert isinstance(found, Composite)


def test_the_figures_of_the_docstring():
    said = re.search(r"are ([\d., and]+) at\s+f = 0.2 and ([\d., and]+) at f = 0.3", module.__doc__ or "")
    assert said is not None
    for fraction, text in ((0.2, said[1]), (0.3, said[2])):
        factors = [STIFFENINGS[name](fraction) for name in ("guth-gold", "mooney", "krieger-dougherty")]
        assert [float(number) for number in re.findall(r"\d\.\d", text)] == [round(factor, 1) for factor in factors]


@given(fraction=st.floats(0.0, 0.4), stiffening=st.sampled_from(sorted(STIFFENINGS)))
def test_particles_stiffen_and_few_do_so_with_einsteins_slope(fraction, stiffening):
    factor = STIFFENINGS[stiffening]
    assert factor(fraction) >= 1.0 + 2.5 * fraction - 1e-12
    assert (factor(1e-7) - 1.0) / 1e-7 == pytest.approx(2.5, rel=1e-5)


def test_without_particles_it_is_the_matrix():
    assert ms.composite(0.0, 0.8, shear_modulus=20e3, lame_lambda=1e6) == (20e3, 1e6, 0.0, 1070.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"particle_fraction": 0.7}, "particle_fraction is 0.7; it must be below 0.64.*not of the mass"),
        ({"particle_fraction": -0.1}, "particle_fraction is -0.1; it must be finite and zero or positive"),
        ({"particle_remanence": float("nan")}, "particle_remanence is nan"),
        ({"stiffening": "moony"}, "stiffening is 'moony'. Did you mean 'mooney'"),
        ({"bulk_modulus": 1e6}, "composite: youngs_modulus, poissons_ratio and bulk_modulus are given"),
    ],
)
def test_what_cannot_be(arguments, message):
    with pytest.raises(InputError, match=message):
        ms.composite(**{"particle_fraction": 0.2, "particle_remanence": 0.7, **MATRIX, **arguments})


def test_an_unknown_modulus():
    with pytest.raises(TypeError, match=r"composite has no argument 'young_modulus'\. Did you mean 'youngs_modulus'"):
        ms.composite(0.2, 0.7, young_modulus=1e5, poissons_ratio=0.4)
