"""The six examples of the paper: which problems they are made of, and how its figures show them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.output.bodies import Body, mirrored, shifted, step_at, turned
from magshell.output.copies import Copy

if TYPE_CHECKING:
    from magshell.mesh import Mesh
    from magshell.solver.path import Path
    from magshell.solver.step import Step

MM = 1e-3
BETWEEN_STRIPS = 10.0 * MM


@dataclass(frozen=True)
class Example:
    """One section of the paper.

    Attributes
    ----------
    name, title : str
    about : str
        What is loaded, how it is held, which part is modelled.
    problems : tuple of str
        Built-in problems; those of one example stand side by side in its pictures.
    fields : tuple of float
        Of the paper's deformed shapes, mT.
    component : int
        Of the displacement that colours them.
    curves : tuple of (str, int)
        Probes and components of the load–displacement curves.
    copies : tuple of Copy
        The whole body made of the modelled part.
    view : (float, float)
        Azimuth and elevation of the eye, degrees.
    arrows : callable
        From the mesh to the places (k, 3), m, at which the remanence is drawn.
    arrow_length : float
        m.
    size : bool
        Whether the shapes show the component's size (where images by symmetry change its sign).
    """

    name: str
    title: str
    about: str
    problems: tuple[str, ...]
    fields: tuple[float, ...]
    component: int
    curves: tuple[tuple[str, int], ...]
    copies: tuple[Copy, ...]
    view: tuple[float, float]
    arrows: Callable[[Mesh], FloatArray]
    arrow_length: float
    size: bool = False

    @property
    def quantity(self) -> str:
        """What colours the shapes, as mathematics."""
        return f"|u_{self.component}|" if self.size else f"u_{self.component}"

    def bodies(self, paths: Mapping[str, Path], choose: Callable[[Path], Step]) -> list[Body]:
        """The bodies of one picture, at the step that `choose` takes from each path."""
        bodies = []
        for number, name in enumerate(self.problems):
            copies = self.copies if len(self.problems) == 1 else shifted(x2=number * BETWEEN_STRIPS)
            bodies.append(Body(paths[name], choose(paths[name]), copies, f"u{self.component}"))
        return bodies

    def bodies_at(self, paths: Mapping[str, Path], field: float) -> list[Body]:
        """The bodies at a field, mT."""
        return self.bodies(paths, lambda path: step_at(path, 1e-3 * field))


def find(names: Sequence[str]) -> list[Example]:
    """The examples of these names, in the paper's order; all of them without names.

    Raises
    ------
    InputError
        An unknown name; names the nearest.
    """
    known = {example.name: example for example in EXAMPLES}
    for name in names:
        if name not in known:
            raise InputError(f"There is no example '{name}' of the paper. {suggest(name, known)}")
    return [example for example in EXAMPLES if not names or example.name in names]


def _along_strip(mesh: Mesh) -> FloatArray:
    length, width, _ = mesh.points.max(axis=0)
    return np.array([[share * length, 0.5 * width, 0.0] for share in (0.2, 0.5, 0.8)])


def _flat(*places: tuple[float, float]) -> Callable[[Mesh], FloatArray]:
    points = MM * np.array([[x1, x2, 0.0] for x1, x2 in places])
    return lambda mesh: points


def _around_tube(mesh: Mesh) -> FloatArray:
    radius, length = float(mesh.points[:, 0].max()), float(mesh.points[:, 1].max())
    angles = np.radians([-75.0, -45.0, -15.0, 15.0, 45.0, 75.0])
    return np.array(
        [[radius * np.cos(a), x2, radius * np.sin(a)] for a in angles for x2 in np.array([0.22, 0.55, 0.88]) * length]
    )


def _along_meridian(mesh: Mesh) -> FloatArray:
    radius = float(np.linalg.norm(mesh.points[0]))
    polar = np.radians([33.0, 55.0, 77.0, 103.0, 125.0, 147.0])
    return radius * np.stack([np.sin(polar), 0.0 * polar, np.cos(polar)], axis=1)


EXAMPLES = (
    Example(
        name="strips",
        title="Bending of beam-like strips",
        about=(
            "Four cantilever strips, clamped at X1 = 0 and magnetised along their length, bend in a field across "
            "them. The paper shows their deflections as curves only, beside experiments of Zhao et al. (2019)."
        ),
        problems=("strip-10", "strip-17", "strip-20", "strip-41"),
        fields=(2.0, 5.0, 15.0, 50.0),
        component=3,
        curves=(("tip", 3),),
        copies=shifted(),
        view=(-33.0, 24.0),
        arrows=_along_strip,
        arrow_length=2.6 * MM,
    ),
    Example(
        name="hollow-cross",
        title="Hollow cross",
        about=(
            "Twenty-four trapezoids, magnetised along the outline, fold up in a field against X3. One quarter is "
            "modelled; heights are measured from A and G, the middles of the outer bars."
        ),
        problems=("hollow-cross",),
        fields=(10.0, 50.0, 100.0, 200.0),
        component=3,
        curves=(("C", 3), ("E", 3)),
        copies=mirrored(0, 1),
        view=(-60.0, 28.0),
        arrows=_flat((24.0, 4.0), (20.5, 8.0), (10.75, 8.0), (8.0, 10.75), (8.0, 20.5), (4.0, 24.0)),
        arrow_length=6.0 * MM,
    ),
    Example(
        name="thin-cross",
        title="Thin cross",
        about=(
            "Nine welded blocks of 6 mm; one pair of arms rises, the other stands. One quarter is modelled; heights "
            "are measured from D, the tip of a standing arm."
        ),
        problems=("thin-cross",),
        fields=(2.0, 5.0, 10.0, 40.0),
        component=3,
        curves=(("A", 3), ("C", 3)),
        copies=mirrored(0, 1),
        view=(-60.0, 24.0),
        arrows=_flat((6.0, 0.0), (12.0, 0.0), (0.0, 6.0), (0.0, 12.0)),
        arrow_length=4.2 * MM,
    ),
    Example(
        name="h-shape",
        title="H-shaped structure",
        about=(
            "Fifteen welded blocks of 6 mm: a bar between two legs that stand up from their ends. One quarter is "
            "modelled; heights are measured from D, the end of a leg."
        ),
        problems=("h-shape",),
        fields=(2.0, 5.0, 15.0, 50.0),
        component=3,
        curves=(("A", 3), ("C", 3)),
        copies=mirrored(0, 1),
        view=(-60.0, 24.0),
        arrows=_flat((6.0, 0.0), (12.0, 0.0), (18.0, 6.0), (18.0, 12.0)),
        arrow_length=4.2 * MM,
    ),
    Example(
        name="pump",
        title="Magnetic pump",
        about=(
            "A tube clamped at both ends and magnetised around its axis, upwards on both sides, is squeezed in the "
            "middle by a field across it. One quarter is modelled."
        ),
        problems=("pump",),
        fields=(20.0, 50.0, 100.0, 150.0),
        component=1,
        curves=(("B", 1), ("C", 1), ("A", 3), ("C", 3)),
        copies=mirrored(0, 1),
        view=(-50.0, 24.0),
        arrows=_around_tube,
        arrow_length=8.0 * MM,
        size=True,
    ),
    Example(
        name="gripper",
        title="Magnetic gripper",
        about=(
            "Twelve arms cover a sphere, clamped near its pole and magnetised along the meridians, away from the "
            "clamp above the equator and towards it below; they open in a field along the axis. One arm is modelled."
        ),
        problems=("gripper",),
        fields=(1.0, 2.0, 4.0, 6.8),
        component=3,
        curves=(("B", 1), ("B", 3), ("C", 1), ("C", 3)),
        copies=turned(12),
        view=(0.0, 20.0),
        arrows=_along_meridian,
        arrow_length=6.5 * MM,
    ),
)
