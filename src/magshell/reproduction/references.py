"""Values that the examples are compared with, and where each comes from.

"The paper" is F. Dadgar-Rad and M. Hossain, *A micropolar shell model for hard-magnetic soft materials*.
"""

from __future__ import annotations

from typing import NamedTuple


class Quoted(NamedTuple):
    """A displacement that the paper quotes in its text.

    Attributes
    ----------
    example : str
    what : str
        The quantity in words.
    probe : str
    component : int
    field : float
        mT.
    value : float
        mm.
    """

    example: str
    what: str
    probe: str
    component: int
    field: float
    value: float


QUOTED = (
    Quoted("thin-cross", "u3 at A, tip of an arm, 40 mT", "A", 3, 40.0, 22.78),
    Quoted("h-shape", "u3 at A, middle of the bar, 50 mT", "A", 3, 50.0, 24.65),
    Quoted("hollow-cross", "u3 at C, outer corner, 200 mT", "C", 3, 200.0, 10.39),
    Quoted("pump", "|u1| at B, side of the tube, 150 mT", "B", 1, 150.0, 16.75),
    Quoted("gripper", "u3 at B, equator of the arm, 6.8 mT", "B", 3, 6.8, 41.6),
    Quoted("gripper", "u3 at B, equator of the arm, 10 mT", "B", 3, 10.0, 43.9),
)

TOUCHING = 6.8
"""Field, mT, that the paper gives as the largest without intersection of the gripper's arms."""

ASPECT_RATIOS = {"strip-10": 10.0, "strip-17": 17.5, "strip-20": 20.5, "strip-41": 41.0}
"""Length over thickness of the strips, as the paper rounds them."""

MEASURED_ON = "strip-20"
MEASURED = (
    (1.856, 0.3161), (2.785, 0.4151), (3.753, 0.5142), (4.641, 0.5922), (5.650, 0.6182), (6.578, 0.6782),
    (9.443, 0.7553), (14.12, 0.8334), (18.85, 0.8535), (23.57, 0.8816), (37.77, 0.8858), (47.18, 0.8990),
)  # fmt: skip
"""Field (mT) and tip deflection over length of a real strip; Zhao et al., J. Mech. Phys. Solids 124, 2019."""

SOLID_FIELDS = (2.0, 10.0, 50.0)
SOLID = {
    "strip-10": (0.0886, 0.3769, 0.7543),
    "strip-17": (0.2594, 0.6728, 0.8652),
    "strip-20": (0.3342, 0.7265, 0.8833),
    "strip-41": (0.6783, 0.8659, 0.9394),
}
"""Tip deflection over length at `SOLID_FIELDS` (mT) by three-dimensional micropolar finite elements, no shell."""
