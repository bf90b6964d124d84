"""Reference values of the built-in problems, and where each comes from."""

from __future__ import annotations

from typing import NamedTuple

PROTOTYPE = "an independent prototype of the same formulation on the same mesh"
MICROPOLAR_SOLID = "three-dimensional micropolar finite elements, no shell assumption"
ZHAO_SOLID = "three-dimensional finite elements with the energy of Zhao et al. (2019), no micro-rotation"


class Reference(NamedTuple):
    """Displacement of a probe at a field of `field` mT, in the unit given: mm or the strip's length."""

    problem: str
    probe: str
    component: str
    field: float
    value: float
    unit: str
    source: str

    @property
    def label(self) -> str:
        """Short, for the names of tests."""
        return f"{self.problem}-{self.probe}-{self.field:g}mT"


STRIP_LENGTHS = {"strip-10": 11e-3, "strip-17": 19.2e-3, "strip-20": 17.2e-3, "strip-41": 17.2e-3}
STRIP_FIELDS = (2.0, 10.0, 50.0)

# Tip deflection u3 over length at 2, 10 and 50 mT.
STRIPS = {
    PROTOTYPE: {
        "strip-10": (0.0894, 0.3790, 0.7542),
        "strip-17": (0.2615, 0.6746, 0.8644),
        "strip-20": (0.3398, 0.7299, 0.8849),
        "strip-41": (0.6782, 0.8658, 0.9407),
    },
    MICROPOLAR_SOLID: {
        "strip-10": (0.0886, 0.3769, 0.7543),
        "strip-17": (0.2594, 0.6728, 0.8652),
        "strip-20": (0.3342, 0.7265, 0.8833),
        "strip-41": (0.6783, 0.8659, 0.9394),
    },
    ZHAO_SOLID: {
        "strip-10": (0.0930, 0.3913, 0.7687),
        "strip-17": (0.2703, 0.6833, 0.8753),
        "strip-20": (0.3464, 0.7348, 0.8927),
        "strip-41": (0.6861, 0.8698, 0.9474),
    },
}

# Height of the tip A over the tip D, mm, at each field, mT.
CROSS_OPENING = {2.0: 9.301, 5.0: 15.383, 10.0: 19.046, 20.0: 21.356, 30.0: 22.234, 40.0: 22.720}


def _strips(source: str) -> list[Reference]:
    return [
        Reference(name, "tip", "u3", field, value, "L", source)
        for name, values in STRIPS[source].items()
        for field, value in zip(STRIP_FIELDS, values, strict=True)
    ]


# On the meshes of the problem files.
SAME_MESH = [
    *_strips(PROTOTYPE),
    Reference("thin-cross", "A", "u3", 40.0, 22.66, "mm", PROTOTYPE),
    Reference("h-shape", "A'", "u3", 50.0, 24.58, "mm", PROTOTYPE),
    Reference("h-shape", "A", "u3", 50.0, 24.33, "mm", PROTOTYPE),
    Reference("hollow-cross", "C", "u3", 200.0, 10.13, "mm", PROTOTYPE),
    Reference("pump", "B", "u1", 150.0, -16.81, "mm", PROTOTYPE),
    Reference("gripper", "B", "u3", 6.8, 41.52, "mm", PROTOTYPE),
    Reference("gripper", "B", "u3", 10.0, 43.74, "mm", PROTOTYPE),
]

# To be reached as the mesh gets finer.
FINE_MESH = [
    *_strips(MICROPOLAR_SOLID),
    *(
        Reference("thin-cross", "A", "u3", field, value, "mm", MICROPOLAR_SOLID)
        for field, value in CROSS_OPENING.items()
    ),
]
