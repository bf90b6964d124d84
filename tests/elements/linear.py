"""Small loads: one linear solve about the undeformed state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import make_solver, nested_dissection

MU, SMALL = 1.0, 1e-6


def rubber(nu: float, thickness: float) -> ms.MicropolarNeoHookean:
    """Shear modulus one, Poisson's ratio nu; coupling and length scale as in the source."""
    return ms.MicropolarNeoHookean(MU, 2.0 * MU * nu / (1.0 - 2.0 * nu), 0.1 * MU, 0.1 * thickness)


class Response(NamedTuple):
    """Change of the nodal values (nodes, 11) per unit load factor at the start, and the work of the loads on it, J."""

    discretisation: Discretisation
    increment: np.ndarray
    work: float


def respond(model: ms.Model) -> Response:
    """The response of a model whose load at load factor 1 is small: its own stiffness is left out."""
    d = Discretisation(model, nested_dissection)
    start = d.undeformed()
    right_side = d.assemble(Instant(start, d.model.loading(1.0))).right_side
    matrix = d.assemble(Instant(start, d.model.loading(0.0))).matrix
    assert matrix is not None
    solution = make_solver("superlu").factorise(matrix).solve(right_side)
    return Response(d, d.direction(solution).nodal, 0.5 * float(right_side @ solution))
