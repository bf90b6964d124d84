"""What a point sees, x (31,), and the scratch arrays of one thread."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import allocate

SIZE = 31
U1, W1, W, ENHANCED, PHI, Q, Q1 = 0, 6, 12, 15, 18, 19, 23


class Workspace(NamedTuple):
    """Scratch arrays of one thread."""

    R: FloatArray
    V: FloatArray
    g: FloatArray
    U: FloatArray
    P: FloatArray
    C: FloatArray
    C_half: FloatArray
    t: FloatArray
    t_mixed: FloatArray
    vectors: FloatArray
    K_m: FloatArray
    K_ω: FloatArray
    K_g: FloatArray
    K_gω: FloatArray
    H_gω: FloatArray
    H_ωg: FloatArray
    H_ωω: FloatArray
    L: FloatArray
    M: FloatArray
    M_c: FloatArray
    m_L: FloatArray
    m_M: FloatArray
    kappa: FloatArray
    stress: FloatArray
    couples: FloatArray


@allocate
def workspace() -> Workspace:
    """Allocate the scratch arrays."""
    return Workspace(
        np.zeros((3, 3)),
        np.zeros((3, 4)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3, 3, 3)),
        np.zeros((3, 3, 3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((6, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3, 3, 3)),
        np.zeros((3, 3, 3)),
        np.zeros((Q, 3)),
        np.zeros((3, Q)),
        np.zeros((3, 3)),
        np.zeros((3, 4)),
        np.zeros((2, 3, 4)),
        np.zeros((2, 3, 4)),
        np.zeros((2, 4)),
        np.zeros(4),
        np.zeros((2, 3)),
        np.zeros((2, 3)),
        np.zeros((3, 3)),
    )
