"""The point's gradient and Hessian, all laws, against the energy written from the paper and differentiated by jets."""

from __future__ import annotations

import numpy as np
from battery import FIELD, SINGLES, each_pair, free_body, scaled_error
from scipy.spatial.transform import Rotation

from shell import jets, oracle, point_oracle
from shell.kernel_access import energy_gradient_and_hessian, pack, unpack

TOLERANCE = 1e-9


def random_point(d, seed):
    """x of a large rotation with a strain of some 20 %, and a quaternion that is not of unit length."""
    rng = np.random.default_rng(seed)
    geometry = d.reference.geometry
    turn = Rotation.random(rng=rng)
    F = turn.as_matrix() @ (np.eye(3) + rng.uniform(-0.2, 0.2, (3, 3)))
    D, dD, A = geometry.D[0, 0], geometry.dD[0, 0], geometry.A[0, 0]
    noise = lambda *shape: rng.uniform(-0.2, 0.2, shape)  # noqa: E731
    micro = (turn * Rotation.from_rotvec(2.0 * noise(3))).as_quat(scalar_first=True)
    return pack(
        {
            "du": A @ (F - np.eye(3)).T,
            "dw": dD @ (F - np.eye(3)).T + noise(2, 3),
            "w": (F - np.eye(3)) @ D + 0.5 * noise(3),
            "enhanced": 0.5 * noise(3),
            "phi": noise() / d.model.shell.thickness,
            "q": rng.uniform(0.6, 1.1) * micro,
            "dq": 2.0 * noise(2, 4),
        }
    )


def the_point(d, B):
    """Point 0 of element 0 for the oracle, from the discretisation's own mid-surface."""
    geometry, shell = d.reference.geometry, d.model.shell
    section = point_oracle.two_levels(shell.thickness, d.reference.remanence[0, 0, 0], shell.material)
    weight = shell.element.rule.weights[0]
    return oracle.make_point(geometry.A[0, 0], geometry.D[0, 0], geometry.dD[0, 0], weight, section, np.array(B))


@each_pair
def test_gradient_and_hessian(material, coupling):
    d = free_body(SINGLES["curved"](), material, coupling)
    for seed in range(4):
        x, point = random_point(d, seed), the_point(d, FIELD)
        energies, g, H = energy_gradient_and_hessian(d, 0, 0, x, FIELD)
        f = unpack(jets.variables(x))
        energy, (magnetic, H_magnetic) = (
            point_oracle.strain_energy(f, point),
            point_oracle.magnetic_work(coupling, f, point),
        )
        errors = {
            "energy": abs(energies[0] / energy.value - 1.0),
            "internal gradient": scaled_error(g[:, 0], energy.gradient),
            "magnetic gradient": scaled_error(g[:, 1], magnetic),
            "Hessian": scaled_error(H, energy.hessian + H_magnetic),
        }
        assert max(errors.values()) < TOLERANCE, f"state {seed}: {errors}"
