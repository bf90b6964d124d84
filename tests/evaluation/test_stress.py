"""Stress at the faces: of the law, true under large stretches, the same after a rigid rotation."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    COUPLING,
    MATERIALS,
    bowl,
    each_element,
    each_material,
    example,
    free_body,
    homogeneous,
    patch,
    random_state,
)
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.evaluation.converged import Converged
from magshell.evaluation.maxima import FACES, described, maxima
from magshell.evaluation.outputs import OUTPUTS
from magshell.evaluation.series import SERIES
from magshell.evaluation.strain import axial, von_mises
from magshell.materials.law import evaluate
from magshell.shell.point import INTERNAL
from magshell.shell.rotation import product

IN_AXES = [
    output for output in OUTPUTS.values() if output.where == "patch" and not output.name.startswith("local_axis")
]


def cauchy_of_energy(material, F, R, step=1e-6):
    """J⁻¹ ∂W/∂F Fᵀ by central differences of the energy at fixed micro-rotation."""
    P = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for sign in (1.0, -1.0):
                moved = F.copy()
                moved[i, j] += sign * step
                P[i, j] += sign * float(evaluate(material, (R.T @ moved)[None])[0][0]) / (2.0 * step)
    return P @ F.T / np.linalg.det(F)


@each_material
def test_stress_is_the_derivative_of_the_energy(material):
    """Under a homogeneous deformation, with a micro-rotation of its own; axes turned by the surface's rotation."""
    d = free_body(patch((2, 2), distortion=0.2), material)
    rng = np.random.default_rng(3)
    F = Rotation.from_rotvec([0.4, 1.1, -0.7]).as_matrix() @ (np.eye(3) + 0.2 * rng.uniform(-1, 1, (3, 3)))
    R = Rotation.from_rotvec([0.5, 0.9, -0.8]).as_matrix()
    reached = Converged(d, homogeneous(d, F, R), d.model.loading(1.0))
    normal = np.cross(F[:, 0], F[:, 1])
    surface = np.column_stack([F[:, :2], normal / np.linalg.norm(normal)])
    left, _, right = np.linalg.svd(surface)
    axes = left @ right
    expected = axes.T @ cauchy_of_energy(material, F, R) @ axes
    scale = np.abs(expected).max()
    for face in ("top", "middle", "bottom"):
        found = reached.at_face("cauchy", face)
        assert np.abs(found - expected).max() < 1e-8 * scale, face
        symmetric = 0.5 * (expected + expected.T)
        np.testing.assert_allclose(
            reached.at_face("principal_stress", face)[0], np.linalg.eigvalsh(symmetric)[::-1], atol=1e-8 * scale
        )
        vector = reached.at_face("axial_stress", face)[0]
        np.testing.assert_allclose(np.cross(vector, np.eye(3)).T, 0.5 * (expected - expected.T), atol=1e-8 * scale)
    for i in (0, 1):
        np.testing.assert_allclose(
            reached.resultant("axes")[:, i], np.tile(axes[:, i], (len(d.mesh.points), 1)), atol=1e-12
        )


def test_von_mises_of_simple_states():
    tension, shear = np.diag([7.0, 0.0, 0.0]), np.zeros((3, 3))
    shear[0, 1] = shear[1, 0] = 2.0
    np.testing.assert_allclose(
        von_mises(np.stack([tension, shear, 5.0 * np.eye(3)])), [7.0, 2.0 * 3**0.5, 0.0], atol=1e-14
    )
    np.testing.assert_allclose(axial(np.cross([1.0, 2.0, 3.0], np.eye(3)).T[None])[0], [1.0, 2.0, 3.0])


@pytest.mark.parametrize("material", MATERIALS, ids=lambda one: type(one).__name__)
def test_uniaxial_tension(material):
    """A stretch of 1.3 with free sides: force over deformed area, and no other stress."""
    h, b, length = 0.1, 1.0, 4.0
    mesh = ms.mesh.rectangle(length, b, (4, 1))
    supports = [
        ms.Prescribe("left", "u", 1),
        ms.Prescribe("right", "u", 1, 0.3 * length),
        ms.Prescribe("bottom", "u", 2),
        ms.Prescribe("left", "u", 3),
        ms.Prescribe("left", "w", 1),
    ]
    path = ms.solve(ms.Model(ms.Shell(mesh, h, material), supports))
    reached = Converged(path.discretisation, path.steps[-1].state, path.model.loading(1.0))
    stress = reached.at_face("stress", "top")
    force = reached.assembly.residual[mesh.nodes_of("right"), 0].sum()
    across = np.exp(reached.at_face("log_strain", "top")[0, [1, 2], [1, 2]]).prod()
    assert stress[:, 0, 0] == pytest.approx(force / (h * b * across), rel=1e-6)
    stress[:, 0, 0] = 0.0
    assert np.abs(stress).max() < 1e-6 * force / (h * b)
    np.testing.assert_allclose(reached.at_face("von_mises", "bottom"), force / (h * b * across), rtol=1e-6)
    np.testing.assert_allclose(reached.at_face("log_strain", "middle")[:, 0, 0], np.log(1.3), rtol=1e-9)
    N = reached.resultant("forces")
    np.testing.assert_allclose(N[:, 0, 0], force / b, rtol=1e-6)
    assert np.abs(N[:, 1:]).max() < 1e-6 * force / b


@each_element
def test_a_rigid_rotation_changes_nothing(element):
    d = free_body(patch((2, 2), distortion=0.2, surface=bowl), element=element)
    state = random_state(d, 4, turn=[0.3, 0.2, -0.1])
    R = Rotation.from_rotvec([0.9, -1.3, 0.7])
    matrix, q = R.as_matrix(), R.as_quat(scalar_first=True)
    turned = state._replace(
        u=(d.mesh.points + state.u) @ matrix.T - d.mesh.points,
        w=(d.normals + state.w) @ matrix.T - d.normals,
        q=product(np.broadcast_to(q, state.q.shape), state.q),
        alpha=state.alpha @ matrix.T,
    )
    loading = d.model.loading(1.0)
    B = loading.flux_density
    here, there = Converged(d, state, loading), Converged(d, turned, loading._replace(flux_density=matrix @ B))
    for output in IN_AXES:
        before, after = output.evaluate(here), output.evaluate(there)
        assert np.abs(before).max() > 0.0, output.name
        np.testing.assert_allclose(after, before, atol=1e-11 * np.abs(before).max(), err_msg=output.name)
    for name in ("local_axis_1", "torque_density"):
        before, after = (OUTPUTS[name].evaluate(one) for one in (here, there))
        np.testing.assert_allclose(after, before @ matrix.T, atol=1e-11 * np.abs(before).max(), err_msg=name)


def test_chosen_axes_turn_components_and_nothing_else():
    one, other = (free_body(patch((2, 2), distortion=0.2)) for _ in range(2))
    object.__setattr__(other.model, "local_axis", (0.0, 3.0, 5.0))
    state = random_state(one, 4, turn=[0.3, 0.2, -0.1])
    here, there = (Converged(d, state, d.model.loading(1.0)) for d in (one, other))
    quarter = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    for name in ("cauchy", "green_strain"):
        before, after = here.at_face(name, "top"), there.at_face(name, "top")
        np.testing.assert_allclose(after, quarter @ before @ quarter.T, atol=1e-11 * np.abs(before).max())
    np.testing.assert_allclose(there.at_face("von_mises", "top"), here.at_face("von_mises", "top"), rtol=1e-10)
    before, after = here.resultant("moments"), there.resultant("moments")
    q = quarter[:2, :2]
    np.testing.assert_allclose(after, q @ before @ q.T, atol=1e-11 * np.abs(before).max())


def test_energy_density_integrates_to_the_energy_of_the_points():
    """Against the laws evaluated at the points, and the couple stress; nothing of the kernels."""
    from magshell.evaluation.points import micropolar_stretch, of_materials
    from magshell.shell.deformed import evaluate as fields_at

    d = free_body(patch((2, 2), distortion=0.2, surface=bowl), coupling=example(COUPLING))
    state = random_state(d, 4)
    state = state._replace(alpha=np.zeros_like(state.alpha))
    reached = Converged(d, state, d.model.loading(1.0))
    fields, volume = fields_at(d.reference, state), d.reference.geometry.volume
    W = of_materials(d.reference, d.materials, micropolar_stretch(fields))[0]
    metric = d.reference.body.points["couple_metric"]
    couples = 0.5 * np.einsum("epab,epax,epbx->e", metric, fields.kappa, fields.kappa)
    expected = np.einsum("epk,epk->e", volume, W) + couples
    found = OUTPUTS["energy_density"].evaluate(reached) * volume.sum(axis=(1, 2))
    np.testing.assert_allclose(found, expected, rtol=1e-11)
    np.testing.assert_allclose(found, reached.energies[:, INTERNAL], rtol=1e-14)


def test_maxima_are_those_of_the_outputs():
    d = free_body(patch((3, 2), distortion=0.2, surface=bowl))
    reached = Converged(d, random_state(d, 4), d.model.loading(1.0))
    found = maxima(reached)
    for name, largest in found.items():
        values = {
            face: OUTPUTS[f"{name}_{face}"].evaluate(reached).reshape(len(d.mesh.points), -1)[:, 0] for face in FACES
        }
        assert largest.value == max(one.max() for one in values.values())
        assert values[largest.face][largest.node] == largest.value
        assert largest.node in d.mesh.elements[largest.element]
        np.testing.assert_array_equal(largest.position, d.mesh.points[largest.node])
    row = {}
    for series in (SERIES[name] for name in ("largest stress", "largest strain", "places of the largest")):
        row |= dict(zip(series.columns(d.model), series.evaluate(reached), strict=True))
    told = described(row, d.mesh.points)
    for name, largest in found.items():
        assert row[f"max_{name}"] == told[name]["value"] == largest.value
        assert row[f"max_{name}.face"] == FACES[largest.face]
        assert tuple(told[name].values())[1:4] == (largest.face, largest.node, largest.element)
        assert told[name]["position"] == largest.position.tolist()
