"""Remanent flux density of the undeformed material, T, constant through the thickness.

A `Remanence` is a callable that takes the mesh and points of each of its elements, shape (elements, points, 3), and
gives the remanence there, same shape. Points that are not needed are NaN, and so may their remanence be.

* one vector: `constant`; directions of an axis: `meridional`, `circumferential`, `radial`;
* in the surface: `tangential`, `along_curve`; turning along a coordinate: `profile`;
* magnetised in another shape: `template`, with the shapes `folded`, `rolled` and `deformed`;
* given by numbers: `function`, `per_element`, `at_places`, `from_file`;
* several: `by_group`.
"""

from __future__ import annotations

from magshell.magnetics.remanence.about_axis import (
    CIRCUMFERENTIAL,
    MERIDIONAL,
    RADIAL,
    circumferential,
    meridional,
    radial,
)
from magshell.magnetics.remanence.constant import CONSTANT, constant
from magshell.magnetics.remanence.curve import ALONG_CURVE, along_curve
from magshell.magnetics.remanence.deformed import deformed
from magshell.magnetics.remanence.files import DEFORMED, FROM_FILE, displaced_from_file, from_file
from magshell.magnetics.remanence.folds import FOLDED, ROLLED, Fold, folded, rolled
from magshell.magnetics.remanence.groups import by_group
from magshell.magnetics.remanence.profile import PROFILE, profile
from magshell.magnetics.remanence.sampled import at_places, function, per_element
from magshell.magnetics.remanence.surface import TANGENTIAL, tangential
from magshell.magnetics.remanence.template import Shape, placed, template
from magshell.magnetics.remanence.vectors import Remanence
from magshell.magnetics.remanence.way import Way

REMANENCES: dict[str, Way] = {
    "constant": CONSTANT,
    "meridional": MERIDIONAL,
    "circumferential": CIRCUMFERENTIAL,
    "radial": RADIAL,
    "tangential": TANGENTIAL,
    "along-curve": ALONG_CURVE,
    "profile": PROFILE,
    "file": FROM_FILE,
    "rolled": ROLLED,
    "folded": FOLDED,
    "deformed": DEFORMED,
}
"""The ways to magnetise that problem files know, by their kind."""

__all__ = [
    "REMANENCES",
    "Fold",
    "Remanence",
    "Shape",
    "Way",
    "along_curve",
    "at_places",
    "by_group",
    "circumferential",
    "constant",
    "deformed",
    "displaced_from_file",
    "folded",
    "from_file",
    "function",
    "meridional",
    "per_element",
    "placed",
    "profile",
    "radial",
    "rolled",
    "tangential",
    "template",
]
