"""Magnetised while folded: the remanence that a uniform field leaves in a part of another shape.

A part is rolled, folded or bent into a template, saturated in a uniform field of direction b, and released. What the
released part remembers is carried back by the rotation R of the material from the undeformed part to the template:

    Brem = M Rᵀ b,

so that in the shape of the template the remanence R Brem = M b is uniform. R is the rotation of the mid-surface:
where the template stretches it, the rotation in the polar decomposition F = R U of

    F = a_α ⊗ A^α + n ⊗ N,

with the unit normals N and n of the undeformed part and of the template.

The remanence is constant through the thickness. A layer at the height z of a template bent to the radius r is stretched
by z/r as well: J F⁻¹ b there differs from Rᵀ b by terms of the order h/(2r), which this neglects. In the mean over
the thickness they cancel to the first order.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence
from magshell.magnetics.remanence.vectors import direction as unit
from magshell.magnetics.remanence.way import Way

if TYPE_CHECKING:
    from magshell.mesh import Mesh


class Placed(NamedTuple):
    """Material points in the shape of a template.

    Attributes
    ----------
    positions : FloatArray, shape (elements, points, 3)
        m.
    rotations : FloatArray, shape (elements, points, 3, 3)
        R, from the undeformed part to the template.
    """

    positions: FloatArray
    rotations: FloatArray


class Shape(Protocol):
    """A shape into which a part can be brought."""

    def place(self, mesh: Mesh, points: FloatArray) -> Placed:
        """Material points (elements, points, 3) of the undeformed part in this shape; NaN where they are NaN."""


class Template:
    """What `template` returns."""

    def __init__(self, shape: Shape, magnitude: float, direction: ArrayLike) -> None:
        self.shape = shape
        self._carried = magnitude * unit("direction", direction)

    def __call__(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """M Rᵀ b at points (elements, points, 3)."""
        return np.asarray(np.einsum("epij,i->epj", self.shape.place(mesh, points).rotations, self._carried))

    def placed(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """Where the template has the points."""
        return self.shape.place(mesh, points).positions

    def carried_at(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """M b at the points."""
        return np.broadcast_to(self._carried, points.shape).copy()


def template(shape: Shape, magnitude: float, direction: ArrayLike) -> Remanence:
    """Remanence of a part that was magnetised by a uniform field in another shape, and released.

    Parameters
    ----------
    shape : Shape
        For instance `folded`, `rolled` or `deformed`.
    magnitude : float
        M, T.
    direction : array_like, shape (3,)
        b, of the magnetising field.
    """
    return Template(shape, magnitude, direction)


def placed(remanence: Remanence, mesh: Mesh, points: FloatArray) -> FloatArray | None:
    """Where the template of a remanence has material points (elements, points, 3); None if it has no template."""
    there = getattr(remanence, "placed", None)
    return None if there is None else there(mesh, points)


def carried(remanence: Remanence, mesh: Mesh, points: FloatArray) -> FloatArray:
    """What the part carries in its template at points (elements, points, 3), T; the remanence itself without."""
    there = getattr(remanence, "carried_at", None)
    return remanence(mesh, points) if there is None else there(mesh, points)


def in_template(
    shape: Callable[..., Shape], keys: Mapping[str, Key], words: Callable[..., str], in_space: bool = False
) -> Way:
    """The way to magnetise in a shape, which is made of the values of its own keys in their order."""

    def make(magnitude: float, direction: ArrayLike, **own: Any) -> Remanence:
        return template(shape(*(own[key] for key in keys)), magnitude, direction)

    about = {
        "magnitude": Key("PositiveRemanence", "Magnitude that the part keeps."),
        "direction": Key("Direction", "Of the uniform magnetising field, with the part in the shape below."),
    }

    def said(magnitude: float, direction: Sequence[float], **own: Any) -> str:
        return f"magnetised along {wording.vector(direction)} while {words(**own)}"

    return Way(make, {**about, **keys}, said, in_space)
