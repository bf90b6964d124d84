r"""Plane stress: the thickness stretch φ eliminated at a point.

With φ a variable of the point instead of a field, its equation is local: Σ_k volume 2 z d · t^3 = 0, that is, P33 has
no moment across the thickness (that it has no mean is the equation of w along the director). With g and H the point's
gradient and Hessian, a Newton step is Δφ = -g_φ / H_φφ; at the solution φ leaves H by its Schur complement.
"""

from __future__ import annotations

from magshell.compiled import inline
from magshell.shell.point import PHI, SIZE, Record

# Strains at the outermost level: round-off, and the most that one step may change.
ROUND_OFF, LARGEST = 1e-13, 0.3


@inline
def eliminate_stretch(w: Record, z: float) -> bool:
    """Either move w.x[PHI] by a Newton step, or, where that is round-off, take φ out of w.g and w.H.

    z is the outermost level, where a step changes the stretch most. A point of weight zero has nothing to eliminate.
    """
    x, g, H = w.x, w.g, w.H
    stiffness = H[PHI, PHI]
    if stiffness == 0.0:
        return True
    step = -(g[PHI, 0] + g[PHI, 1]) / stiffness
    if abs(step) * z > ROUND_OFF:
        x[PHI] += min(max(step, -LARGEST / z), LARGEST / z)
        return False
    g[PHI, 0], g[PHI, 1] = 0.0, 0.0
    for i in range(SIZE):
        if i != PHI:
            share = H[i, PHI] / stiffness
            for j in range(SIZE):
                H[i, j] -= share * H[PHI, j]
    for i in range(SIZE):
        H[i, PHI], H[PHI, i] = 0.0, 0.0
    return True
