"""Force and torque on a rigid magnetised plate over a cylinder magnet, in two ways against tabulated values.

By surface charges σ = J·n / μ0: F = ∫ σ B dA, T = ∫ (x − c) × σ B dA, from B alone. By volume: f = (J·∇B) / μ0 (that
is, J_i ∂B_i/∂x_j) and the couple J × B / μ0, from B and its gradient.
"""

from __future__ import annotations

import csv
import pathlib

import numpy as np
import pytest

from magshell.magnetics.fields import Cylinder, MagnetField, Source

MU0 = 4e-7 * np.pi
HALF = np.array([5e-3, 5e-3, 0.25e-3])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
PLANE = np.meshgrid(NODES, NODES)
MAGNET = MagnetField([Source(Cylinder(0.02, 0.02, (0.0, 0.0, 1.3)), (0.0, 0.0, -0.01))])

with (pathlib.Path(__file__).parent / "plate_over_magnet.csv").open() as file:
    TABLE = list(csv.DictReader(file))


def by_charges(J, centre):
    force, torque = np.zeros(3), np.zeros(3)
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        for side in (-1.0, 1.0):
            away = np.zeros((len(NODES), len(NODES), 3))
            away[..., axis] = side * HALF[axis]
            away[..., others[0]], away[..., others[1]] = (HALF[k] * x for k, x in zip(others, PLANE, strict=True))
            areas = np.outer(WEIGHTS, WEIGHTS).ravel() * HALF[others[0]] * HALF[others[1]]
            away = away.reshape(-1, 3)
            load = (side * J[axis] / MU0 * areas)[:, None] * MAGNET.direct(away + centre, False).flux_density
            force += load.sum(axis=0)
            torque += np.cross(away, load).sum(axis=0)
    return force, torque


def by_volume(J, centre):
    away = HALF * np.stack(np.meshgrid(NODES, NODES, NODES, indexing="ij"), axis=-1).reshape(-1, 3)
    volumes = np.einsum("i,j,k->ijk", WEIGHTS, WEIGHTS, WEIGHTS).ravel() * HALF.prod()
    values = MAGNET.direct(away + centre, False)
    load = volumes[:, None] / MU0 * np.einsum("i,pij->pj", J, values.gradient)
    couple = volumes[:, None] / MU0 * np.cross(J, values.flux_density)
    return load.sum(axis=0), (np.cross(away, load) + couple).sum(axis=0)


@pytest.mark.parametrize("row", TABLE, ids=[f"{row['remanence']} at {row['z_mm']}" for row in TABLE])
def test_force_and_torque_on_a_rigid_plate(row):
    J = 0.1 * np.eye(3)["xyz".index(row["remanence"])]
    centre = 1e-3 * np.array([float(row[f"{axis}_mm"]) for axis in "xyz"])
    force = 1e-3 * np.array([float(row[f"F{axis}_mN"]) for axis in "xyz"])
    torque = 1e-6 * np.array([float(row[f"T{axis}_uNm"]) for axis in "xyz"])
    found = by_charges(J, centre), by_volume(J, centre)
    for F, T in found:
        assert np.abs(F - force).max() < 1e-5 * np.linalg.norm(force)
        assert np.abs(T - torque).max() < 1e-5 * max(np.linalg.norm(torque), 1e-2 * np.linalg.norm(force))
    (F, T), (other_force, other_torque) = found
    assert np.abs(F - other_force).max() < 1e-9 * np.linalg.norm(force)
    assert np.abs(T - other_torque).max() < 1e-9 * max(np.linalg.norm(torque), 1e-2 * np.linalg.norm(force))
