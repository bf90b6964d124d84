"""The two problems that `peers.py` gives to every code, and what a code answers.

Sze, Liu and Lo, Finite Elem. Anal. Des. 40, 2004. Both shells are one patch, a map of the unit square.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field

import numpy as np

# Largest relative residual (or correction) at which a code stops to iterate, as each of them measures it.
TOLERANCE = 1e-6
# Numbers of equal load steps that are tried, and the iterations after which a step has failed.
LADDER = (1, 2, 3, 5, 8, 10, 12, 15, 20, 30, 50)
MOST_ITERATIONS = 30


def _hemisphere(s: np.ndarray, t: np.ndarray) -> np.ndarray:
    polar, azimuth = np.radians(18.0 + 72.0 * s), np.radians(90.0 * t)
    return 10.0 * np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1)


def _annulus(s: np.ndarray, t: np.ndarray) -> np.ndarray:
    radius, angle = 6.0 + 4.0 * s, 2.0 * np.pi * t
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * radius], axis=-1)


@dataclass(frozen=True)
class Problem:
    """A problem in the lengths and forces of its source.

    Attributes
    ----------
    elements : (int, int)
        Along s and t.
    position : callable
        From s and t, each from 0 to 1, to (..., 3).
    load : float
        On each of the hemisphere's two nodes; per length of the annulus' edge.
    table : dict
        Displacements at the full load, of the source's table: 16 × 16 and 6 × 30 four-node elements.
    limit : dict
        The same of the continuous shell with transverse shear, by `peers_limit.py`.
    """

    elements: tuple[int, int]
    position: Callable[[np.ndarray, np.ndarray], np.ndarray]
    youngs_modulus: float
    poissons_ratio: float
    thickness: float
    load: float
    table: dict[str, float]
    limit: dict[str, float]

    def grid(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes (n, 3), t fastest, and quadrilaterals (e, 4), counter-clockwise in (s, t)."""
        m, n = self.elements
        s, t = np.meshgrid(np.linspace(0, 1, m + 1), np.linspace(0, 1, n + 1), indexing="ij")
        first = (np.arange(m)[:, None] * (n + 1) + np.arange(n)).ravel()
        return self.position(s, t).reshape(-1, 3), first[:, None] + [0, n + 1, n + 2, 1]


PROBLEMS = {
    "hemisphere": Problem(
        (16, 16), _hemisphere, 6.825e7, 0.3, 0.04, 200.0,
        {"inwards": 8.178, "outwards": 4.067}, {"inwards": 8.154, "outwards": 4.076},
    ),
    "annulus": Problem(
        (6, 30), _annulus, 21e6, 0.0, 0.03, 0.8,
        {"w_A": 13.891, "w_B": 17.528}, {"w_A": 13.863, "w_B": 17.501},
    ),
}  # fmt: skip


@dataclass
class Answer:
    """What a code measured; without `values` it failed, and `reason` says why."""

    code: str
    element: str
    problem: str
    unknowns: int = 0
    steps: int = 0
    solves: int = 0
    seconds: float = 0.0
    values: dict[str, float] = field(default_factory=dict)
    reason: str = ""

    def error(self, reference: dict[str, float]) -> float:
        """Largest relative difference from reference values."""
        return max(abs(self.values[name] / value - 1.0) for name, value in reference.items())

    def print(self) -> None:
        """As one line, for `peers.py`."""
        print("ANSWER", json.dumps(asdict(self)), flush=True)


def fewest_steps(attempt: Callable[[int], Answer]) -> Answer:
    """Of attempts with equal load steps the one that reached the full load with the fewest solves.

    Of a code without step control of its own: what somebody reaches who knows the best number of steps.
    """
    best, last, worse = None, None, 0
    for steps in LADDER:
        last = attempt(steps)
        if last.values and (best is None or last.solves < best.solves):
            best, worse = last, 0
        elif best is not None:
            worse += 1
            if worse == 2:
                break
    assert last is not None
    return best or last
