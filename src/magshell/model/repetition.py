r"""What breaks the repetitions of a model: a field or a weight that the neighbours would see another way.

A part stands for many alike if the field and the loads of a neighbour are the images of its own. Remanence and loads
are: they belong to the part. A uniform field and the weight are the same everywhere, so that they must be their own
images, Q B = B: about an axis they lie along it. A field that varies must be B(x') = Q B(x) at the image x' of each x;
that is looked at on the sides of the part.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import Field, FieldUnknown, UniformField
from magshell.model.course import Course
from magshell.model.loads import Gravity, Load
from magshell.model.reflection import TYPED
from magshell.model.repeated import Repeated
from magshell.model.shell import Shell
from magshell.model.stages import Stage

WHOLE = "Model the whole"


class Repeating(Protocol):
    """What is asked of a model here."""

    @property
    def shell(self) -> Shell: ...
    @property
    def field(self) -> Field: ...
    @property
    def loads(self) -> Sequence[Load]: ...
    @property
    def stages(self) -> Sequence[Stage]: ...
    def course(self, stage: int) -> Course: ...


def broken(model: Repeating) -> list[str]:
    """What breaks the repetitions of a model, in sentences: the repetition, what breaks it and what would be right."""
    found = []
    for one in model.shell.repeated:
        found += [f"{one.label}: {fault}" for fault in (*_of_field(model, one), *_of_weight(model, one))]
    return found


def _of_field(model: Repeating, one: Repeated) -> Iterator[str]:
    """A field that the neighbour would see another way, in the first stage where it does."""
    shell = model.shell
    if not shell.magnetised and not any(np.any(body.moment) for body in shell.rigid):
        return
    Q, (nodes, images) = one.rotation(shell.mesh), one.nodes(shell.mesh)
    for number, here, there in flux_densities(model, shell.mesh.points[nodes], shell.mesh.points[images]):
        off = np.linalg.norm(there - here @ Q.T, axis=1)
        if off.max() > 2.0 * TYPED * np.linalg.norm(here, axis=1).max():
            where = f" in stage {number + 1}" if len(model.stages) > 1 else ""
            uniform = isinstance(model.field, UniformField)
            right = "a uniform field must lie along the axis" if uniform else "it must be repeated as the shell is"
            yield f"the neighbour, {one.words}, would see another field{where}: {right}. {WHOLE}"
            return


def flux_densities(
    model: Repeating, points: FloatArray, images: FloatArray
) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    """Stage, and the flux density (n, 3) at points and their images at its start, middle and end.

    States whose field is unknown there are left out.
    """
    for number in range(len(model.stages)):
        for load_factor in (0.0, 0.5, 1.0):
            drives = model.course(number).amounts(load_factor).drives
            try:
                here, there = (model.field.at(drives, x, second=False).flux_density for x in (points, images))
            except FieldUnknown:
                continue
            yield number, np.broadcast_to(here, points.shape), np.broadcast_to(there, points.shape)


def _of_weight(model: Repeating, one: Repeated) -> Iterator[str]:
    """A weight that is not along the axis."""
    Q = one.rotation(model.shell.mesh)
    for load in model.loads:
        if isinstance(load, Gravity) and load.vector is not None:
            g = np.asarray(load.vector, dtype=float)
            if np.linalg.norm(Q @ g - g) > 2.0 * TYPED * np.linalg.norm(g):
                yield f"{load.kind} is not along the axis: the neighbour would weigh another way. {WHOLE}"
