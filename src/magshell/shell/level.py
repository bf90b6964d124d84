r"""One level of a section: its laws evaluated at the stretch that it sees.

The strain of transverse shear is not constant across layers of different stiffness. A level sees that of the director
times 1 + ρ, with ρ (`warping`) from the shear stress of cylindrical bending (`shear_profile.py`; zero where there are
no layers):

    Û = U + ρ Π U,    Π U = s ⊗ D + D ⊗ s,    s = (I - D ⊗ D) ½ (U + Uᵀ) D.

Π is a symmetric projection, so that with P̂ and Ĉ of the law P = P̂ + ρ Π P̂ and C = (I + ρ Π) Ĉ (I + ρ Π).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import call, inline
from magshell.magnetics.law import WORK
from magshell.shell.point import Record


class Laws(NamedTuple):
    """The laws of a body: addresses (n,) for kernels, and parameters (n, most), of materials and of couplings."""

    materials: IntArray
    material_parameters: FloatArray
    couplings: IntArray
    coupling_parameters: FloatArray


@inline
def stress(w: Record, D: FloatArray, level: Record, laws: Laws, across: FloatArray | None) -> float:
    """Fill P and C of w.U; returns the strain energy per volume. A law that raises an error leaves NaN.

    `across` is None where no section has layers.
    """
    w.memory_after[0] = np.nan
    parameters, address = laws.material_parameters[level.material], laws.materials[level.material]
    for i in range(3):
        for j in range(3):
            w.U_law[i, j] = w.U[i, j]
    if across is not None:
        if level.warping != 0.0:
            _warp(w.U_law.reshape(9), 0, 3, 1, D, level.warping, w.shear)
    energy: float = call(address, parameters, w.U_law, w.memory, 0.0, 0.0, w.P, w.C, w.memory_after)
    if across is not None:
        if level.warping != 0.0:
            _warp(w.P.reshape(9), 0, 3, 1, D, level.warping, w.shear)
            for fixed in range(9):
                _warp(w.C, fixed, 27, 9, D, level.warping, w.shear)
            for fixed in range(9):
                _warp(w.C, 9 * fixed, 3, 1, D, level.warping, w.shear)
    w.P[0, 0] += w.memory_after[0]
    return energy + w.memory_after[0]


@inline
def _warp(A: FloatArray, first: int, row: int, column: int, D: FloatArray, warping: float, s: FloatArray) -> None:
    """A += ρ Π A for the 3 × 3 numbers of A from `first` on, with these strides; s (3,) is scratch."""
    along = 0.0
    for i in range(3):
        s[i] = 0.0
        for j in range(3):
            s[i] += 0.5 * (A[first + row * i + column * j] + A[first + row * j + column * i]) * D[j]
        along += s[i] * D[i]
    for i in range(3):
        s[i] = warping * (s[i] - along * D[i])
    for i in range(3):
        for j in range(3):
            A[first + row * i + column * j] += s[i] * D[j] + D[i] * s[j]


@inline
def carry(w: Record, G: FloatArray, remanence: FloatArray) -> None:
    """Fill b^a = G^a · B̃, m = F B̃ and n = R̃ B̃ from the base vectors."""
    for a in range(3):
        w.b[a] = G[a, 0] * remanence[0] + G[a, 1] * remanence[1] + G[a, 2] * remanence[2]
    for i in range(3):
        w.m[i] = w.b[0] * w.base[0, i] + w.b[1] * w.base[1, i] + w.b[2] * w.base[2, i]
        w.n[i] = w.R[i, 0] * remanence[0] + w.R[i, 1] * remanence[1] + w.R[i, 2] * remanence[2]


@inline
def work(w: Record, laws: Laws, coupling: int, B: FloatArray) -> float:
    """Fill the coupling's forces and tangent; returns its energy per volume. A law that raises an error leaves NaN."""
    forces, tangent = w.forces, w.work_tangent
    forces[WORK] = np.nan
    for i in range(WORK):
        forces[i] = 0.0
        for j in range(WORK):
            tangent[i, j] = 0.0
    parameters, address = laws.coupling_parameters[coupling], laws.couplings[coupling]
    energy: float = call(address, parameters, w.m, w.n, B, w.gradients, forces, tangent)
    for i in range(WORK):
        forces[i] += forces[WORK]
    return energy + forces[WORK]
