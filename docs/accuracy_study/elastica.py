r"""The inextensible elastica of a cantilever, magnetised along its length, in a field across it.

    θ'' + q cos θ = 0,  θ(0) = 0,  θ'(1) = 0,  q = 12 (L/h)² B̃ B / (μ0 E)

with the arc length in units of the length L. With δ = π/2 - θ and t the arc length from the free end it is a pendulum
that starts at rest: δ'' = q sin δ, δ(0) = δ_tip, δ(1) = π/2. As sin δ < δ, δ_tip exceeds that of the linear equation,
(π/2)/cosh √q; the first root above it is the one without loops.
"""

from __future__ import annotations

import math

import numpy as np

TABLE = {0.1: 0.03330, 0.5: 0.16214, 1.0: 0.30172, 2.0: 0.49346, 5.0: 0.71379, 10.0: 0.81061, 50.0: 0.91716}
"""Tip deflection over length by q, from an independent calculation."""


def tip_deflection(q: float) -> float:
    """Tip deflection over length."""
    from scipy.integrate import solve_ivp
    from scipy.optimize import brentq

    def slope(_: float, y: np.ndarray) -> tuple[float, float, float]:
        return y[1], q * math.sin(y[0]), math.cos(y[0])

    def end(at_tip: float) -> np.ndarray:
        return solve_ivp(slope, (0.0, 1.0), (at_tip, 0.0, 0.0), rtol=1e-12, atol=1e-14, method="DOP853").y[:, -1]

    quarter = 0.5 * math.pi
    lower = quarter / math.cosh(math.sqrt(q))
    upper = 1.1 * lower
    while end(upper)[0] < quarter:
        lower, upper = upper, 1.1 * upper
    at_tip = brentq(lambda angle: end(angle)[0] - quarter, lower, upper, xtol=1e-15)
    return float(end(at_tip)[2])
