"""A converged step of a load path."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.evaluation.balance import Balance
from magshell.shell.state import State

NO_DRIVES = np.zeros(0)


class Step(NamedTuple):
    """A converged step.

    Attributes
    ----------
    number : int
        0 is the undeformed state.
    load_factor : float
    state : State
    iterations : int
        Newton iterations, each one factorisation and solve.
    residual : float
        Relative, of the worst kind of unknown.
    balance : Balance or None
        Global equilibrium; None for the undeformed state.
    arc_length : float
        Length of the path up to here (`magshell.solver.constraints`).
    stage : int
        From 0.
    flux_density : ndarray, shape (3,)
        T.
    loads : ndarray, shape (loads,)
        Multipliers of the model's loads.
    negative_pivots : int or None
        Of the tangent: 0 for a stable state (`magshell.solver.critical` says of which shells); None where the linear
        solver cannot tell.
    drives : ndarray, shape (drives,)
        Amounts of the field; empty in steps of magshell 0.1.0.
    """

    number: int
    load_factor: float
    state: State
    iterations: int
    residual: float
    balance: Balance | None
    arc_length: float
    stage: int
    flux_density: FloatArray
    loads: FloatArray
    negative_pivots: int | None
    drives: FloatArray = NO_DRIVES

    def __repr__(self) -> str:
        return f"Step({self.number}: load factor {self.load_factor:.6g} of stage {self.stage + 1})"
