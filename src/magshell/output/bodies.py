"""Pictures of whole bodies: the modelled part with its true thickness, and its copies by symmetry."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import find
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
from magshell.output.style import INK
from magshell.output.tessellation import Tessellation, element_edges

if TYPE_CHECKING:
    from magshell.mesh import Mesh
    from magshell.solver.path import Path
    from magshell.solver.step import Step

PIECES = 6


class Copy(NamedTuple):
    """x to matrix x + shift, shift in m."""

    matrix: FloatArray
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def of(self, points: FloatArray) -> FloatArray:
        """Images of points (..., 3)."""
        return points @ self.matrix.T + np.array(self.shift)


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

    The shell has one thickness.
    """
    reached, thickness = converged(path.discretisation, step), path.model.shell.greatest_thickness
    middle, director, phi = reached.mesh.points + reached.displacement, reached.director(), reached.phi()[:, None]
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
    cells = Tessellation(d.mesh.elements, PIECES)
    sides = faces(path, body.step)
    output, component = find(body.output)
    nodal = np.asarray(output.evaluate(converged(d, body.step)), dtype=float)
    if nodal.ndim == 2:
        nodal = nodal[:, component - 1] if component else np.linalg.norm(nodal, axis=1)

    parts = []
    for face in sides:
        surface = cells.surface(face)
        parts.append((surface.points, surface.normals, surface.triangles, cells.at_points(nodal)))
    outer = _outer_edges(d.mesh, body.copies)
    below, above = (cells.edges(face, outer) for face in sides)
    outward = np.cross(np.gradient(0.5 * (below + above), axis=1), above - below)
    outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
    on_edge = cells.edges(np.repeat(nodal[:, None], 3, axis=1), outer)[..., 0]
    lower = np.arange(below[..., 0].size).reshape(below.shape[:2])
    upper = lower + lower.size
    quads = np.stack([lower[:, :-1], lower[:, 1:], upper[:, 1:], upper[:, :-1]], axis=-1).reshape(-1, 4)
    parts.append(
        (
            np.concatenate([below, above]).reshape(-1, 3),
            np.tile(outward.reshape(-1, 3), (2, 1)),
            np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
            np.tile(on_edge.ravel(), 2),
        )
    )
    points, normals, triangles, values = zip(*parts, strict=True)
    first = np.cumsum([0, *map(len, points)])
    inner, borders = element_edges(d.mesh.elements), _group_borders(d.mesh)
    return Solid(
        np.concatenate(points),
        np.concatenate(normals),
        np.concatenate([part + start for part, start in zip(triangles, first[:-1], strict=True)]),
        np.concatenate(values),
        np.concatenate([below, above, *(cells.edges(face, borders) for face in sides)]),
        np.concatenate([cells.edges(face, inner) for face in sides]),
    )


def _outer_edges(mesh: Mesh, copies: Sequence[Copy]) -> IntArray:
    """Boundary edges that are not on a mirror plane between two copies."""
    edges = mesh.boundary_edges
    ends = mesh.points[edges]
    inside = np.zeros(len(edges), dtype=bool)
    for copy in copies[1:]:
        inside |= np.abs(copy.of(ends) - ends).max(axis=(1, 2)) < 1e-6 * mesh.size
    return edges[~inside]


def _group_borders(mesh: Mesh) -> IntArray:
    """Edges (k, 3) between elements of different groups."""
    group = np.zeros(len(mesh.elements), dtype=np.int64)
    for number, members in enumerate(mesh.element_groups.values(), start=1):
        group[members] = number
    sides = np.repeat(group, 4)
    middles = mesh.elements[:, 4:].ravel()
    least, most = np.full(len(mesh.points), len(group)), np.full(len(mesh.points), -1)
    np.minimum.at(least, middles, sides)
    np.maximum.at(most, middles, sides)
    edges = element_edges(mesh.elements)
    return edges[least[edges[:, 2]] < most[edges[:, 2]]]


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
    return np.concatenate(
        [copy.of(face) for body in bodies for face in faces(body.path, body.step) for copy in body.copies]
    )


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
