"""A coupling law that is not linear in m and n: all four blocks of its tangent are full."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from magshell.magnetics.law import OMEGA, M


class Nonlinear(NamedTuple):
    """Energy -s/mu0 + α s²/2 + β (m·n) r of s = m·B and r = n·B: all four blocks of the tangent are full."""

    vacuum_permeability: float = 0.8
    alpha: float = 0.7
    beta: float = -0.9


def energy(law, m, n, B):
    return -(m @ B) / law.vacuum_permeability + 0.5 * law.alpha * (m @ B) ** 2 + law.beta * (m @ n) * (n @ B)


@numba.extending.register_jitable
def _cross(a):
    """[a]×."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def law(coupling, m, n, B, gradients, forces, tangent):
    s, r, t = np.dot(m, B), np.dot(n, B), np.dot(m, n)
    p = coupling.beta * (r * m + t * B)
    forces[M : M + 3] += (coupling.alpha * s - 1.0 / coupling.vacuum_permeability) * B + coupling.beta * r * n
    forces[OMEGA : OMEGA + 3] += np.cross(n, p)
    turn, p_n = _cross(n), np.dot(p, n)
    K_mω = -coupling.beta * (np.outer(n, B) + r * np.eye(3)) @ turn
    K_nn = coupling.beta * (np.outer(m, B) + np.outer(B, m))
    tangent[M : M + 3, M : M + 3] += coupling.alpha * np.outer(B, B)
    tangent[M : M + 3, OMEGA : OMEGA + 3] += K_mω
    tangent[OMEGA : OMEGA + 3, M : M + 3] += K_mω.T
    tangent[OMEGA : OMEGA + 3, OMEGA : OMEGA + 3] += (
        turn.T @ K_nn @ turn + 0.5 * (np.outer(p, n) + np.outer(n, p)) - p_n * np.eye(3)
    )
    return 0.5 * coupling.alpha * s**2 - s / coupling.vacuum_permeability + coupling.beta * t * r
