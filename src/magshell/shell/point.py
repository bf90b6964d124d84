"""What a point sees, x (31,), and the scratch arrays of one thread."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from magshell.arrays import AnyArray
from magshell.compiled import allocate

SIZE = 31
U1, W1, W, ENHANCED, PHI, Q, Q1 = 0, 6, 12, 15, 18, 19, 23


#: Scratch arrays of one thread: a record, so that they are passed as one pointer and their shapes are known.
WORKSPACE = np.dtype(
    [
        ("R", float, (3, 3)),
        ("V", float, (3, 4)),
        ("g", float, (3, 3)),
        ("U", float, (3, 3)),
        ("P", float, (3, 3)),
        ("U_inverse_transpose", float, (3, 3)),
        ("S", float, (3, 3)),
        ("C", float, (3, 3, 3, 3)),
        ("C_half", float, (3, 3, 3, 3)),
        ("t", float, (3, 3)),
        ("t_mixed", float, (3, 3)),
        ("vectors", float, (6, 3)),
        ("K_m", float, (3, 3)),
        ("K_ω", float, (3, 3)),
        ("K_g", float, (3, 3, 3, 3)),
        ("K_gω", float, (3, 3, 3)),
        ("H_gω", float, (Q, 3)),
        ("H_ωg", float, (3, Q)),
        ("H_ωω", float, (3, 3)),
        ("L", float, (3, 4)),
        ("M", float, (2, 3, 4)),
        ("M_c", float, (2, 3, 4)),
        ("m_L", float, (2, 4)),
        ("m_M", float, (4,)),
        ("kappa", float, (2, 3)),
        ("stress", float, (2, 3)),
        ("couples", float, (3, 3)),
    ]
)
Workspace: TypeAlias = Any


@allocate
def workspace() -> AnyArray:
    """One cleared record, in an array: that is what must be passed on, a record alone does not keep its memory."""
    return np.zeros(1, dtype=WORKSPACE)
