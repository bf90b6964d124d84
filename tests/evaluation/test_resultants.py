"""Resultants against hand statics: what a section carries is what acts on the part beyond it."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.evaluation.converged import Converged, converged
from magshell.evaluation.patches import patches_of
from magshell.evaluation.points import magnetic_torque
from magshell.shell.deformed import of_couplings

LENGTH, WIDTH, THICKNESS = 20e-3, 4e-3, 0.8e-3
MU, LAMBDA = 1e5, 4e5
POISSON = 0.5 * LAMBDA / (LAMBDA + MU)
RUBBER = ms.MicropolarNeoHookean(MU, LAMBDA, 0.1 * MU, 0.1 * THICKNESS)
QUICK = ms.Settings(first_step=0.5)


def end_of(model, settings=QUICK):
    path = ms.solve(model, settings)
    return converged(path.discretisation, path.steps[-1])


def strip(divisions=(10, 2), thickness=THICKNESS, remanence=None):
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, divisions)
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, {"strip": np.arange(len(mesh.elements))}, mesh.edge_groups)
    return ms.Shell(mesh, thickness, RUBBER, remanence or ms.remanence.constant((0.0, 0.0, 0.0)))


def across(mesh, x):
    """Nodes of the section at x in rising order, and the weights of Simpson's rule over its width."""
    nodes = np.flatnonzero(np.abs(mesh.points[:, 0] - x) < 1e-9)
    nodes = nodes[np.argsort(mesh.points[nodes, 1])]
    weights = np.zeros(len(nodes))
    step = np.ptp(mesh.points[nodes, 1]) / (len(nodes) - 1)
    for first in range(0, len(nodes) - 2, 2):
        weights[first : first + 3] += step / 3.0 * np.array([1.0, 4.0, 1.0])
    return nodes, weights


def carried(reached: Converged, x: float) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment about the origin that the section at x exerts on the part before it: on that with lower X1."""
    nodes, weights = across(reached.mesh, x)
    axes = np.empty((len(nodes), 3, 3))
    axes[:, :2] = reached.resultant("axes")[nodes, :2]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    force = np.einsum("ni,nix->nx", reached.resultant("forces")[nodes, :, 0], axes)
    M, C = (reached.resultant(name)[nodes, :, 0] for name in ("moments", "couples"))
    moment = M[:, :1] * axes[:, 1] - M[:, 1:] * axes[:, 0] + np.einsum("ni,nix->nx", C, axes)
    moment = moment + np.cross((reached.mesh.points + reached.state.u)[nodes], force)
    return weights @ force, weights @ moment


def test_bending_by_end_moments():
    """Plate strip bent by a couple: M11 is the couple per width, M22 none at free edges; curvature M/EI."""
    total = 2e-9
    reached = end_of(ms.Model(strip(), [ms.Clamp("left")], loads=[ms.Moment("right", (0.0, total, 0.0))]))
    nodes, weights = across(reached.mesh, 0.5 * LENGTH)
    M, C = reached.resultant("moments")[nodes], reached.resultant("couples")[nodes]
    assert weights @ (M[:, 0, 0] + C[:, 1, 0]) == pytest.approx(total, rel=1e-4)
    assert np.abs(reached.resultant("forces")[nodes]).max() < 1e-3 * total / THICKNESS / WIDTH
    stress = reached.at_face("stress", "top")[nodes, 0, 0]
    share = (weights @ M[:, 0, 0]) / total
    assert weights @ stress == pytest.approx(6.0 * share * total / THICKNESS**2, rel=5e-3)
    assert 0.9 < share < 1.0, "the couple stress carries a little"


def test_tension_with_lateral_contraction():
    total = 1e-4
    supports = [ms.Prescribe("left", "u", 1), ms.Prescribe("bottom", "u", 2), ms.Prescribe("left", "u", 3)]
    supports.append(ms.Prescribe("left", "w", 1))
    reached = end_of(ms.Model(strip(), supports, loads=[ms.Force("right", (total, 0.0, 0.0))]))
    N = reached.resultant("forces")
    np.testing.assert_allclose(N[:, 0, 0], total / WIDTH, rtol=1e-7)
    N[:, 0, 0] = 0.0
    assert np.abs(N).max() < 1e-7 * total / WIDTH
    H = reached.at_face("log_strain", "middle")
    np.testing.assert_allclose(H[:, 1, 1] / H[:, 0, 0], -POISSON, rtol=1e-3)
    np.testing.assert_allclose(H[:, 2, 2], H[:, 1, 1], rtol=1e-6)
    assert np.abs(reached.resultant("moments")).max() < 1e-7 * total * THICKNESS / WIDTH


def test_held_sides_carry_poissons_share():
    """Sides that cannot come closer: N22 = nu N11."""
    total = 1e-7
    planes = [ms.SymmetryPlane(side, (0, 1, 0)) for side in ("bottom", "top")]
    supports = [*planes, ms.SymmetryPlane("left", (1, 0, 0)), ms.Prescribe("left", "u", 3)]
    reached = end_of(ms.Model(strip(), supports, loads=[ms.Force("right", (total, 0.0, 0.0))]))
    N = reached.resultant("forces")
    np.testing.assert_allclose(N[:, 0, 0], total / WIDTH, rtol=1e-6)
    np.testing.assert_allclose(N[:, 1, 1], POISSON * total / WIDTH, rtol=1e-4)


def test_shear_force_under_a_load_on_the_area():
    """Q1 falls linearly to nothing at the free end, M11 quadratically; at the ends, too."""
    pull = 1e-2
    reached = end_of(ms.Model(strip((10, 1)), [ms.Clamp("left")], loads=[ms.Traction("strip", (0.0, 0.0, pull))]))
    for x in np.linspace(0.0, LENGTH, 6):
        nodes, weights = across(reached.mesh, x)
        Q = weights @ reached.resultant("forces")[nodes, 2, 0] / WIDTH
        rest = LENGTH - x
        assert Q == pytest.approx(pull * rest, abs=3e-3 * pull * LENGTH), x
        M = weights @ (reached.resultant("moments")[nodes, 0, 0] + reached.resultant("couples")[nodes, 1, 0]) / WIDTH
        assert M == pytest.approx(-0.5 * pull * rest**2, abs=1e-2 * 0.5 * pull * LENGTH**2), x


COUPLINGS = [ms.MicropolarCouple(), ms.MicroRotationEnergy(), ms.DeformationGradientEnergy()]


@pytest.mark.parametrize("coupling", COUPLINGS, ids=lambda law: type(law).__name__)
def test_sections_of_a_magnetic_strip_are_in_equilibrium(coupling):
    """A cantilever that turns far in a field, with a force at its end: every section carries what acts beyond it.

    The field exerts no force; its torque is integrated over the volume beyond the section. (Next to the clamp the
    forces vary across the width more than three nodes can show.)
    """
    force = np.array([0.0, 0.0, -1.5e-5])
    shell = strip((16, 1), remanence=ms.remanence.constant((0.08, 0.0, 0.02)))
    field = ms.UniformField((2e-3, 0.0, 8e-3))
    model = ms.Model(shell, [ms.Clamp("left")], field, coupling, loads=[ms.Force("right", force)])
    reached = end_of(model, ms.Settings(first_step=0.1))
    assert np.abs(reached.state.u[:, 2]).max() > 0.4 * LENGTH
    d = reached.discretisation
    forces = of_couplings(d.reference, d.couplings, reached.fields, reached.local_field)
    torque = magnetic_torque(d.reference, reached.fields, forces) * d.reference.geometry.volume[..., None]
    of_elements = torque.sum(axis=(1, 2))
    middles = d.mesh.points[d.mesh.elements].mean(axis=1)[:, 0]
    nodes, weights = across(d.mesh, LENGTH)
    tip = weights @ (d.mesh.points + reached.state.u)[nodes] / WIDTH
    scale = np.linalg.norm(np.cross(tip, force)) + np.linalg.norm(of_elements, axis=1).sum()
    for x in np.linspace(0.0, LENGTH, 9)[3:-1]:
        section_force, section_moment = carried(reached, x)
        assert np.linalg.norm(section_force - force) < 6e-3 * np.linalg.norm(force), x
        expected = np.cross(tip, force) + of_elements[middles > x].sum(axis=0)
        assert np.linalg.norm(section_moment - expected) < 2e-3 * scale, x


def bent(shell, total):
    """A strip with held sides (plane strain), clamped to turn freely in thickness, under a moment at its end."""
    planes = [ms.SymmetryPlane(side, (0, 1, 0)) for side in ("bottom", "top")]
    supports = [*planes, ms.SymmetryPlane("left", (1, 0, 0)), ms.Prescribe("left", "u", 3)]
    return end_of(ms.Model(shell, supports, loads=[ms.Moment("right", (0.0, total, 0.0))]))


def test_stress_on_both_sides_of_a_step():
    """Twice as thick beyond the middle: the moment goes through, the stress at the face falls to a quarter."""
    total = 1e-9
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (20, 1))
    middles = mesh.points[mesh.elements].mean(axis=1)[:, 0]
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, {"thick": np.flatnonzero(middles > 0.5 * LENGTH)}, mesh.edge_groups)
    material = RUBBER._replace(length_scale=1e-3 * THICKNESS)
    thick = ms.Region("thick", thickness=2.0 * THICKNESS, material=material)
    reached = bent(ms.Shell(mesh, THICKNESS, material, regions=[thick]), total)
    patches = patches_of(reached.discretisation.model.shell)
    rows = np.flatnonzero(np.abs(mesh.points[patches.nodes, 0] - 0.5 * LENGTH) < 1e-9)
    heavy = np.isin(patches.first[rows], mesh.element_groups["thick"])
    assert heavy.sum() == 3
    assert (~heavy).sum() == 3
    np.testing.assert_allclose(reached.resultant("moments")[rows, 0, 0], total / WIDTH, rtol=2e-2)
    for thickness, side in ((THICKNESS, rows[~heavy]), (2.0 * THICKNESS, rows[heavy])):
        for face, sign in (("top", 1.0), ("bottom", -1.0)):
            stress = reached.at_face("stress", face)[side, 0, 0]
            np.testing.assert_allclose(stress, sign * 6.0 * total / WIDTH / thickness**2, rtol=3e-2)


def test_stresses_at_the_faces_of_two_layers():
    """A soft layer with nu 0.49 on a stiff one with nu 0.3, bent in plane strain, against laminate theory."""
    total, heights = 1e-9, np.array([0.5e-3, 0.3e-3])
    young, poisson = np.array([3e5, 1e5]), np.array([0.3, 0.49])
    mu = young / (2.0 * (1.0 + poisson))
    laws = [
        ms.MicropolarNeoHookean(m, 2.0 * m * nu / (1.0 - 2.0 * nu), 0.1 * m, 1e-6)
        for m, nu in zip(mu, poisson, strict=True)
    ]
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (10, 1))
    layers = [ms.Layer(height, law) for height, law in zip(heights, laws, strict=True)]
    reached = bent(ms.Shell(mesh, layers=layers), total)
    modulus = young / (1.0 - poisson**2)
    ends = np.array([-0.5 * heights.sum(), heights[0] - 0.5 * heights.sum(), 0.5 * heights.sum()])
    first, second = (modulus * np.diff(ends**power) / power for power in (2, 3))
    neutral = first.sum() / (modulus * heights).sum()
    curvature = total / WIDTH / (second.sum() - neutral * first.sum())
    nodes, _ = across(mesh, 0.6 * LENGTH)
    for face, k, z in (("bottom", 0, ends[0]), ("top", 1, ends[2])):
        stress = reached.at_face("stress", face)[nodes]
        np.testing.assert_allclose(stress[:, 0, 0], modulus[k] * curvature * (z - neutral), rtol=1e-2)
        np.testing.assert_allclose(stress[:, 1, 1], poisson[k] * stress[:, 0, 0], rtol=1e-2)
        assert np.abs(stress[:, 2, 2]).max() < 1e-2 * np.abs(stress[:, 0, 0]).max()
    np.testing.assert_allclose(reached.resultant("moments")[nodes, 0, 0], total / WIDTH, rtol=1e-3)
