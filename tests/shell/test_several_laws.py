"""Bodies whose elements, or levels, are made of different laws are sums of bodies of one; coupling laws of any kind."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    COUPLING,
    FIELD,
    MATERIAL,
    PATCHES,
    SINGLES,
    dense,
    each_element,
    example,
    free_body,
    random_state,
    scaled_error,
    strain_energy,
)

from magshell.equations.insertion import Insertion
from magshell.equations.instant import STATIC, Instant
from magshell.equations.numbering import Numbering
from magshell.equations.shell import ShellTerm
from magshell.magnetics import DeformationGradientEnergy, MicroRotationEnergy
from magshell.magnetics import law as coupling_laws
from magshell.materials import MicropolarMooneyRivlin, MicropolarStVenantKirchhoff
from magshell.model.reference import make_of, stiffest_of
from magshell.shell.body import Surface, reference_of
from magshell.shell.geometry import Sections
from shell import jets, nonlinear_coupling, oracle, point_oracle
from shell.kernel_access import energy_gradient_and_hessian, unpack
from shell.test_element import TOLERANCE, reference
from shell.test_point import random_point, the_point

MATERIALS = [example(MATERIAL), MicropolarMooneyRivlin(2.5, 4.0, 0.6, 0.1, 0.4), example(MicropolarStVenantKirchhoff)]
COUPLINGS = [example(COUPLING), example(DeformationGradientEnergy), MicroRotationEnergy(0.5)]


def evaluated(d, make, state, elements=slice(None)):
    """Residuals, dense tangent and energies of some elements of a body, made as told."""
    term = ShellTerm(reference_of(surface_of(d, elements), make), len(d.mesh.points), stiffest_of(make))
    numbering = Numbering(d.rows, d.free, d.shell.couplings(), lambda graph: np.arange(graph.shape[0]))
    insertion = Insertion(numbering, d.model.constraints)
    term.place(numbering, d.model.constraints)
    instant = Instant(state._replace(alpha=state.alpha[elements]), d.model.loading(1.0))
    part = term.evaluate(instant, STATIC, insertion, None)
    return part.residual, part.condensed, insertion.tangent().toarray(), term.energy(instant)


def surface_of(d, elements=slice(None)):
    """The mid-surface of some elements of a body without regions."""
    nodes, shell = d.mesh.elements[elements].copy(), d.model.shell  # as in models no read-only array: a further type
    ties = d.reference.body.ties
    ties = ties._replace(kind=ties.kind[elements], host=ties.host[elements])
    return Surface(nodes, ties, d.mesh.points[nodes], d.normals[nodes], shell.element, shell.micro_rotation)


def of_element(d, make, e):
    """What one element is made of, with no other law in the lists."""
    material, coupling = make.materials[make.material_of[e, 0]], make.couplings[make.coupling_of[e, 0]]
    _, weights = d.model.shell.element.integration(d.mesh.points[d.mesh.elements[e : e + 1]])
    own = np.s_[e : e + 1, : weights.shape[-1]]  # a triangle by itself has fewer points
    return make._replace(
        thickness=make.thickness[e : e + 1],
        sections=Sections(make.sections.z[own], make.sections.heights[own]),
        levels=make.levels[e : e + 1],
        by_level=make.by_level[e : e + 1],
        warping=make.warping[own],
        remanence=make.remanence[own],
        materials=[material],
        couplings=[coupling],
        material_of=np.zeros((1, make.material_of.shape[1]), dtype=np.int64),
        coupling_of=np.zeros((1, make.coupling_of.shape[1]), dtype=np.int64),
    )


def mixed(d, levels=2):
    """Thickness, laws and remanence change from element to element."""
    count = len(d.mesh.elements)
    numbers, rng = np.arange(count), np.random.default_rng(5)
    thickness = 0.1 + 0.02 * numbers
    parent, weights = np.polynomial.legendre.leggauss(levels)
    shape = (*d.reference.geometry.volume.shape[:2], levels)
    half = 0.5 * thickness[:, None, None] * np.ones(shape)
    remanence = rng.uniform(-1, 1, (count, 1, 1, 3)) * np.ones((*shape, 1))
    return make_of(d.model)._replace(
        thickness=thickness,
        sections=Sections(half * parent, half * weights),
        levels=np.full(count, levels),
        warping=np.zeros(shape),
        remanence=remanence,
        materials=MATERIALS,
        couplings=COUPLINGS,
        material_of=np.repeat(numbers[:, None] % 3, levels, axis=1),
        coupling_of=np.repeat(numbers[:, None] // 2 % 3, levels, axis=1),
    )


@each_element
@pytest.mark.parametrize("levels", [1, 2, 5])
def test_a_body_of_several_laws_and_thicknesses_is_the_sum_of_its_elements(element, levels):
    d = free_body(PATCHES["curved patch"](), element=element)
    make, state = mixed(d, levels), random_state(d, 3)
    whole = evaluated(d, make, state)
    parts = [evaluated(d, of_element(d, make, e), state, slice(e, e + 1)) for e in range(len(d.mesh.elements))]
    *sums, energies = [sum(one) for one in list(zip(*parts, strict=True))[:3]], np.vstack([part[3] for part in parts])
    for name, together, expected in zip(("residual", "condensed", "tangent"), whole, sums[0], strict=False):
        error = scaled_error(together, expected)
        assert error < 1e-13, f"{name}: {error:.1e}"
    assert np.array_equal(whole[3], energies)
    different = evaluated(d, make._replace(material_of=make.material_of[::-1].copy()), state)
    assert scaled_error(different[0], whole[0]) > 1e-3, "it does not matter which law an element has"


@each_element
def test_regions_of_one_element_with_equal_data_are_one_region(element):
    d = free_body(PATCHES["curved patch"](), element=element)
    one, count, state = make_of(d.model), len(d.mesh.elements), random_state(d, 3)
    numbers = np.repeat(np.arange(count)[:, None], one.material_of.shape[1], axis=1)
    many = one._replace(
        materials=one.materials * count, couplings=one.couplings * count, material_of=numbers, coupling_of=numbers[::-1]
    )
    for together, apart in zip(evaluated(d, one, state), evaluated(d, many, state), strict=True):
        assert scaled_error(apart, together) < 1e-12


def test_levels_of_different_laws_add_up():
    """Energies, gradient and Hessian of a point; of the couple stress too, whose modulus is that of the level."""
    d = free_body(SINGLES["curved"]())
    surface, make = surface_of(d), mixed(d, 3)
    remanence = np.random.default_rng(6).uniform(-1, 1, make.remanence.shape)
    make = make._replace(remanence=remanence, material_of=np.array([[2, 0, 1]]), coupling_of=np.array([[1, 2, 0]]))
    alone = [
        make._replace(
            sections=Sections(make.sections.z[..., [k]], make.sections.heights[..., [k]]),
            levels=np.ones(1, dtype=np.int64),
            warping=make.warping[..., [k]],
            remanence=remanence[:, :, [k]],
            material_of=make.material_of[:, [k]],
            coupling_of=make.coupling_of[:, [k]],
        )
        for k in range(3)
    ]
    whole, *levels = (reference_of(surface, one).body for one in (make, *alone))
    for seed in range(3):
        x = random_point(d, seed)
        together = energy_gradient_and_hessian(d, 0, 1, x, FIELD, whole)
        apart = [energy_gradient_and_hessian(d, 0, 1, x, FIELD, body) for body in levels]
        for part, parts in zip(together, zip(*apart, strict=True), strict=True):
            assert scaled_error(part, sum(parts)) < 1e-13


# -- a coupling law that is not linear in m and n --------------------------------------------------------------------


def test_point_of_a_nonlinear_coupling(nonlinear):
    d = free_body(SINGLES["curved"](), coupling=nonlinear)
    for seed in range(4):
        x, point = random_point(d, seed), the_point(d, FIELD)
        energies, g, H = energy_gradient_and_hessian(d, 0, 0, x, FIELD)
        f = unpack(jets.variables(x))
        elastic, (magnetic, H_magnetic) = (
            point_oracle.strain_energy(f, point),
            point_oracle.magnetic_work(nonlinear, f, point),
        )
        errors = {
            "elastic energy": abs(energies[0] / elastic.value - 1.0),
            "magnetic gradient": scaled_error(g[:, 1], magnetic),
            "Hessian": scaled_error(H, elastic.hessian + H_magnetic),
        }
        assert max(errors.values()) < 1e-12, f"state {seed}: {errors}"


@each_element
def test_element_of_a_nonlinear_coupling(nonlinear, element):
    d = free_body(SINGLES["curved"](), coupling=nonlinear, element=element)
    state = random_state(d, 1)
    assembly = d.assemble(Instant(state, d.model.loading(1.0)))
    elastic, r, K = reference(d, state)
    _, K_condensed, _, _ = oracle.condensed(d, r, K)
    tangent = dense(d, assembly.matrix)
    errors = {
        "energy": abs(strain_energy(d, state)[0] / elastic - 1.0),
        "residual": scaled_error(assembly.residual.ravel(), r[: d.free.size]),
        "tangent": scaled_error(tangent, K_condensed),
        "symmetry": scaled_error(tangent, tangent.T),
    }
    assert max(errors.values()) < TOLERANCE, errors


def test_magnetic_energy_of_elements(nonlinear):
    """Column 1 of the energies: with its law summed over the points."""
    d = free_body(PATCHES["curved patch"](), coupling=nonlinear)
    state, loading = random_state(d, 2), d.model.loading(1.0)
    still = jets.variables(np.zeros(oracle.unknowns(d)))
    expected = np.zeros(len(d.mesh.elements))
    for e in range(len(expected)):
        for p, (parent, weight) in enumerate(oracle.points(d, e)):
            f, here = oracle.element_parts(d, state, e, parent, still)
            point = oracle.point_of(d, here, e, p, weight, np.array(FIELD))
            R = jets.value(oracle.rotation(f["q"]))
            levels = zip(oracle.deformation_gradients(f, point), point.volume, point.section.remanence, strict=True)
            for F, volume, vector in levels:
                expected[e] += volume * nonlinear_coupling.energy(
                    nonlinear, jets.value(F) @ vector, R @ vector, point.B
                )
    assert scaled_error(d.shell.energy(Instant(state, loading))[:, 1], expected) < 1e-12
    assert coupling_laws.is_conservative(nonlinear)
