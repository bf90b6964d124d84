"""Pictures of whole bodies: the modelled part with its true thickness, and its copies by symmetry."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import find
from magshell.output.copies import Copy
from magshell.output.scene import (
    MARGIN,
    OVERSAMPLING,
    SURFACE,
    Camera,
    arrow_body,
    photograph,
    polylines,
    viewing_axes,
)
from magshell.output.shape import spread
from magshell.output.skin import Hull
from magshell.output.style import INK

if TYPE_CHECKING:
    from magshell.mesh import Mesh
    from magshell.solver.path import Path
    from magshell.solver.step import Step

PIECES = 6


def shifted(x1: float = 0.0, x2: float = 0.0, x3: float = 0.0) -> tuple[Copy, ...]:
    """The body alone, moved by this, m."""
    return (Copy(np.eye(3), (x1, x2, x3)),)


def mirrored(*axes: int) -> tuple[Copy, ...]:
    """All images under reflections in the planes normal to these axes (0, 1, 2), the body itself first."""
    copies = [Copy(np.eye(3))]
    for axis in axes:
        reflection = np.eye(3)
        reflection[axis, axis] = -1.0
        copies += [Copy(reflection @ copy.matrix) for copy in copies]
    return tuple(copies)


def turned(count: int) -> tuple[Copy, ...]:
    """Images under rotations about X3 that share out the full circle."""
    angles = 2.0 * np.pi * np.arange(count) / count
    return tuple(
        Copy(np.array([[np.cos(a), -np.sin(a), 0.0], [np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]])) for a in angles
    )


class Body(NamedTuple):
    """A step of a path, shown with copies, coloured by an output (its component, or its length) in SI."""

    path: Path
    step: Step
    copies: Sequence[Copy]
    output: str = "u"


class Solid(NamedTuple):
    """Faces of the modelled part and the curves on them.

    Attributes
    ----------
    points, normals : FloatArray, shape (n, 3)
    triangles : IntArray, shape (m, 3)
    values : FloatArray, shape (n,)
        What colours it, SI.
    outline, grid : FloatArray, shape (k, pieces + 1, 3)
        Outer edges and borders of element groups; edges of all elements; on both faces.
    """

    points: FloatArray
    normals: FloatArray
    triangles: IntArray
    values: FloatArray
    outline: FloatArray
    grid: FloatArray


def faces(path: Path, step: Step, heights: Sequence[float] = (-0.5, 0.5)) -> list[FloatArray]:
    """Deformed positions (nodes, 3) at fractions of the thickness over the mid-surface: x = X + u + z (1 + z φ) d.

    The shell has one thickness and no joints.
    """
    reached, thickness = converged(path.discretisation, step), path.model.shell.greatest_thickness
    middle = reached.mesh.points + reached.displacement
    director, phi = reached.director()[: len(middle)], reached.phi()[: len(middle), None]
    return [middle + z * (1.0 + z * phi) * director for z in (fraction * thickness for fraction in heights)]


def step_at(path: Path, flux_density: float) -> Step:
    """The step at this magnitude of the field, T.

    Raises
    ------
    ValueError
        The field is not a stop of the path.
    """
    sizes = [float(np.linalg.norm(step.flux_density)) for step in path.steps]
    step, size = min(zip(path.steps, sizes, strict=True), key=lambda pair: abs(pair[1] - flux_density))
    if abs(size - flux_density) > 1e-9 * max(sizes):
        raise ValueError(f"{flux_density} T is not a stop; the nearest step is at {size} T")
    return step


def solid(body: Body) -> Solid:
    """Upper and lower faces and the walls between them, m."""
    path, d = body.path, body.path.discretisation
    reached = converged(d, body.step)
    hull = _hull(path, body.copies)
    output, component = find(body.output)
    values = spread(hull, path.model.shell, output, np.asarray(output.evaluate(reached), dtype=float))
    if values.ndim == 2:
        values = values[:, component - 1] if component else np.linalg.norm(values, axis=1)
    placed = hull.placed(reached)
    return Solid(*placed.surface, values, placed.outer, placed.inner)


def _hull(path: Path, copies: Sequence[Copy]) -> Hull:
    """The closed body, without walls on the mirror planes between the copies."""
    mesh, shell = path.discretisation.mesh, path.model.shell
    group = np.zeros(len(mesh.elements), dtype=np.int64)
    for number, members in enumerate(mesh.element_groups.values(), start=1):
        group[members] = number
    made = group * len(shell.parts) + shell.part_of
    return Hull(shell, made, PIECES, _on_mirror_planes(mesh, copies))


def _on_mirror_planes(mesh: Mesh, copies: Sequence[Copy]) -> IntArray:
    """Middle nodes of the boundary edges on a mirror plane between two copies."""
    edges = mesh.boundary_edges
    ends = mesh.points[edges]
    inside = np.zeros(len(edges), dtype=bool)
    for copy in copies[1:]:
        inside |= np.abs(copy.of(ends) - ends).max(axis=(1, 2)) < 1e-6 * mesh.size
    return edges[inside, 2]


def cameras_for(
    groups: Sequence[Sequence[Body]], azimuth: float, elevation: float, level: bool = False
) -> list[Camera]:
    """One camera per group of bodies, all in one scale.

    Each is as wide as its bodies; as high as the highest group, or, if they are to look level, as all of them together.
    """
    axes = viewing_axes(azimuth, elevation)
    seen = [_extent(bodies) @ axes.T for bodies in groups]
    lows, highs = np.array([x.min(axis=0) for x in seen]), np.array([x.max(axis=0) for x in seen])
    if level:
        lows[:, 1:], highs[:, 1:] = lows[:, 1:].min(axis=0), highs[:, 1:].max(axis=0)
    half_height = 0.5 * MARGIN * float((highs - lows)[:, 1].max())
    half_widths = 0.5 * (highs - lows)[:, 0] + (MARGIN - 1.0) * half_height
    centres = 0.5 * (lows + highs) @ axes
    return [
        Camera(centre, axes, float(half_width), half_height)
        for centre, half_width in zip(centres, half_widths, strict=True)
    ]


def _extent(bodies: Sequence[Body]) -> FloatArray:
    """Positions of all nodes of both faces of all copies."""
    places = []
    for body in bodies:
        x = _hull(body.path, body.copies).extent(converged(body.path.discretisation, body.step))
        places += [copy.of(x) for copy in body.copies]
    return np.concatenate(places)


def render(
    bodies: Sequence[Body],
    camera: Camera,
    colour: Callable[[FloatArray], AnyArray],
    pixels: tuple[int, int],
    arrows: Sequence[FloatArray] = (),
    arrow_colour: str = INK,
) -> AnyArray:
    """Draw bodies.

    Parameters
    ----------
    bodies : sequence of Body
    camera : Camera
    colour : callable
        From values (n,) in SI to red, green, blue (n, 3), 0 to 255.
    pixels : (int, int)
        Width and height.
    arrows : sequence of FloatArray, shape (2, 3)
        Tail and head of solid arrows.
    arrow_colour : str

    Returns
    -------
    AnyArray, shape (height, width, 4)
        Red, green, blue, opacity.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    import pyvista

    nearer = 1.5e-3 * 2.0 * camera.half_height * camera.axes[2]
    edge, inner = ({"lighting": False, "line_width": OVERSAMPLING * width} for width in (0.9, 0.6))

    def place(plotter: Any) -> None:
        for body in bodies:
            part = solid(body)
            shades = colour(part.values)
            for copy in body.copies:
                proper = np.linalg.det(copy.matrix) > 0.0
                triangles = part.triangles if proper else part.triangles[:, ::-1]
                surface = pyvista.PolyData.from_regular_faces(copy.of(part.points), triangles)
                surface.point_data["colours"] = shades
                surface.point_data.active_normals = part.normals @ copy.matrix.T
                plotter.add_mesh(surface, scalars="colours", rgb=True, **SURFACE)
                plotter.add_mesh(polylines(copy.of(part.outline) + nearer), color=INK, **edge)
                plotter.add_mesh(polylines(copy.of(part.grid) + 0.5 * nearer), color=INK, opacity=0.16, **inner)
        for ends in arrows:
            plotter.add_mesh(arrow_body(ends), color=arrow_colour, smooth_shading=True, ambient=0.6)

    return photograph(place, camera, pixels)
