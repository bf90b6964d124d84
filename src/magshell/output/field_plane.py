"""A field as arrows on a plane through a picture, coloured by its magnitude."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.output.sources import Plane, arrows, outside
from magshell.units import LENGTH, parse

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

COLOUR_MAP = "plasma"
POINTS = 32
"""Along the longer side."""
BEYOND = 0.15
"""How far the plane goes beyond what is drawn, over the longer side of that."""
STRONGEST = 90.0
"""Percentile of the magnitudes at which the scale of colours ends, as the field is without bound at edges."""
_WRITTEN = re.compile(r"\s*x([123])\s*=\s*(.*\S)\s*", re.IGNORECASE)


@dataclass(frozen=True)
class FieldPlane:
    """A plane normal to an axis.

    Attributes
    ----------
    axis : int
        0, 1 or 2.
    coordinate : float
        m.
    """

    axis: int
    coordinate: float

    def over(self, points: FloatArray) -> Plane:
        """The rectangle of the plane that goes a little beyond points (n, 3)."""
        low, high = points.min(axis=0), points.max(axis=0)
        margin = BEYOND * float((high - low).max())
        low, high = low - margin, high + margin
        low[self.axis] = high[self.axis] = self.coordinate
        first, second = np.delete(np.diag(high - low), self.axis, axis=0)
        return Plane(low, first, second, POINTS)


def field_plane(text: str) -> FieldPlane:
    """The plane that is written as "x2=0" or "x3=5 mm".

    Raises
    ------
    InputError
        Not an axis and a coordinate, or a coordinate without a unit of length.
    """
    found = _WRITTEN.fullmatch(text)
    if found is None:
        raise InputError(f"'{text}' is not a plane; write an axis and a coordinate, such as x2=0 or 'x3=5 mm'")
    return FieldPlane(int(found[1]) - 1, parse(found[2], LENGTH))


class FieldArrows:
    """The field of steps on a plane, in one scale of colours.

    Parameters
    ----------
    path : Path
    steps : sequence of Step
        That give the scale.
    plane : Plane

    Raises
    ------
    InputError
        The field is zero or not known everywhere on the plane at all of these steps.
    """

    def __init__(self, path: Path, steps: Sequence[Step], plane: Plane) -> None:
        from matplotlib import colormaps
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        self._field, self.plane = path.model.field, plane
        B = np.concatenate([outside(self._field, step.drives, plane.grid()) for step in steps])
        sizes = np.linalg.norm(B, axis=1)
        sizes = sizes[sizes > 0.0]
        if not len(sizes):
            raise InputError("the field is zero or not known on the whole plane, so there is nothing to draw on it")
        top = float(np.percentile(sizes, STRONGEST))
        self.more = bool(top < sizes.max())
        self.colours = ScalarMappable(Normalize(0.0, 1e3 * top), colormaps[COLOUR_MAP])

    def at(self, amounts: FloatArray) -> Callable[[Any], None]:
        """What adds the arrows for given amounts to a plotter; none where the field is zero or not known."""
        drawn = arrows(self._field, amounts, self.plane)

        def place(plotter: Any) -> None:
            if drawn.n_points:
                drawn["colours"] = self.colours.to_rgba(1e3 * np.asarray(drawn["B"]), bytes=True)[:, :3]
                plotter.add_mesh(drawn, scalars="colours", rgb=True, ambient=0.6)

        return place
