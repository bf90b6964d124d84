"""Records of a point: what it knows of the undeformed shell, what it sees, x (31,), and the scratch of one thread.

Records are passed to compiled functions as one pointer, with shapes known to the compiler.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from magshell.arrays import AnyArray
from magshell.compiled import allocate
from magshell.magnetics.law import GRADIENTS, WORK

SIZE = 31
U1, W1, W, ENHANCED, PHI, Q, Q1 = 0, 6, 12, 15, 18, 19, 23
# Columns of rows as long as a point's, in whole vector registers of four numbers.
PADDED = 32
NODES = 8
# Columns of the gradient g: internal, magnetic, and what the geometric part of the tangent is made with.
INTERNAL, MAGNETIC, MIXED = 0, 1, 2

#: A point of the mid-surface: base A_α (m), director D and D,α, metric c^αβ of the couple stress (N m), functions of
#: the element's nodes (see `Interpolation`; those of fewer nodes come first; of the position: `loaded.py`), how many
#: levels it has, and whether each has a stretch of its own (`level_stretch.py`).
POINT = np.dtype(
    [
        ("A", float, (2, 3)),
        ("D", float, (3,)),
        ("dD", float, (2, 3)),
        ("couple_metric", float, (2, 2)),
        ("u", float, (2, NODES)),
        ("position", float, (NODES,)),
        ("director", float, (3, NODES)),
        ("phi", float, (NODES,)),
        ("rotation", float, (3, NODES)),
        ("levels", np.int64),
        ("by_level", np.int64),
    ]
)
#: A level z (m) of a point: its height (m), dual base G^i (1/m), volume (m³), remanence (T), which laws hold there, and
#: by how much its transverse shear exceeds the director's, as a share of it.
LEVEL = np.dtype(
    [
        ("z", float),
        ("height", float),
        ("volume", float),
        ("G", float, (3, 3)),
        ("remanence", float, (3,)),
        ("material", np.int64),
        ("coupling", np.int64),
        ("warping", float),
    ]
)
#: Scratch arrays of one thread. Tensors of fourth order are (81,): index [p, j, q, l] at 27 p + 9 j + 3 q + l.
WORKSPACE = np.dtype(
    [
        ("x", float, (SIZE,)),
        ("dx", float, (SIZE,)),
        ("g", float, (SIZE, 3)),
        ("H", float, (SIZE, PADDED)),
        ("R", float, (3, 3)),
        ("V", float, (3, 4)),
        ("base", float, (3, 3)),
        ("U", float, (3, 3)),
        ("P", float, (3, 3)),
        ("U_law", float, (3, 3)),
        ("U_inverse_transpose", float, (3, 3)),
        ("S", float, (3, 3)),
        ("C", float, (81,)),
        ("C_half", float, (81,)),
        ("dU", float, (3, 3)),
        ("dP", float, (3, 3)),
        ("dg", float, (3, 3)),
        ("t", float, (3, 3)),
        ("t_mixed", float, (3, 3)),
        ("m", float, (3,)),
        ("n", float, (3,)),
        ("b", float, (3,)),
        ("dg3", float, (3,)),
        ("t3", float, (3,)),
        ("spin", float, (3,)),
        ("leg", float, (9,)),
        ("shear", float, (3,)),
        ("row", float, (Q + 3,)),
        ("column", float, (Q + 3,)),
        ("gradients", float, (GRADIENTS,)),
        ("forces", float, (WORK + 1,)),
        ("work_tangent", float, (WORK, WORK)),
        ("memory", float, (1,)),
        ("memory_after", float, (1,)),
        ("K_g", float, (81,)),
        ("K_gω", float, (3, 3, 3)),
        ("H_gω", float, (Q, 3)),
        ("H_ωg", float, (3, Q)),
        ("H_ωω", float, (3, 3)),
        ("L", float, (3, 4)),
        ("M", float, (3, 4)),
        ("D", float, (2, 3, 12)),
        ("D_m", float, (12,)),
        ("kappa", float, (2, 3)),
        ("stress", float, (2, 3)),
        ("couples", float, (3, 3)),
        ("g_x", float, (3,)),
        ("e", float, (3,)),
        ("H_x", float, (3, SIZE)),
        ("H_rx", float, (SIZE, 3)),
        ("H_xx", float, (3, 3)),
        ("H_xω", float, (3, 3)),
        ("H_ωx", float, (3, 3)),
        ("energy", float, (2,)),
    ]
)
Record: TypeAlias = Any


@allocate
def workspace() -> AnyArray:
    """One cleared record, in an array: that is what must be passed on, a record alone does not keep its memory."""
    return np.zeros(1, dtype=WORKSPACE)
