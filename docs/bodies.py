"""Pictures of whole bodies: the modelled part with its true thickness, and its copies by symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pyvista

from magshell.output.registry import find
from magshell.output.rendering import require_rendering
from magshell.output.scene import Camera, viewing_axes
from magshell.output.tessellation import Tessellation
from magshell.solver import Path, Step

PIECES = 6
OVERSAMPLING = 2
MARGIN = 1.06
INK = "#1a1f26"
LIGHTS = (((-0.5, 0.8, 1.0), 0.30), ((0.0, 0.0, 1.0), 0.20), ((0.9, 0.1, 0.6), 0.12))
"""Direction right, up, towards the eye, and intensity; with the ambient part they add up to about one."""


class Copy(NamedTuple):
    """x to matrix x + shift, shift in m."""

    matrix: np.ndarray
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)


def mirrored(*axes: int) -> list[Copy]:
    """All images under reflections in the planes normal to these axes (0, 1, 2), the body itself first."""
    copies = [Copy(np.eye(3))]
    for axis in axes:
        reflection = np.eye(3)
        reflection[axis, axis] = -1.0
        copies += [Copy(reflection @ copy.matrix) for copy in copies]
    return copies


def turned(count: int) -> list[Copy]:
    """Images under rotations about X3 that share out the full circle."""
    angles = 2.0 * np.pi * np.arange(count) / count
    return [Copy(np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])) for a in angles]


class Body(NamedTuple):
    """A step of a path, shown with copies, coloured by the size of an output (its component, its magnitude)."""

    path: Path
    step: Step
    copies: Sequence[Copy]
    output: str


class Solid(NamedTuple):
    """Faces of the modelled part: points, normals (n, 3), triangles, colour values (n,), edge curves (k, m, 3)."""

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    values: np.ndarray
    edges: list[np.ndarray]


def step_at(path: Path, flux_density: float) -> Step:
    """The step at this magnitude of the field, T; it must be a stop of the path."""
    wanted = flux_density / path.model.field.magnitude
    step = min(path.steps, key=lambda step: abs(step.load_factor - wanted))
    if abs(step.load_factor - wanted) > 1e-9:
        raise ValueError(f"{flux_density} T is not a stop; the nearest step is at load factor {step.load_factor}")
    return step


def solid(body: Body) -> Solid:
    """Upper and lower faces and the walls between them, in m."""
    path, state, d = body.path, body.step.state, body.path.discretisation
    mesh, half = d.mesh, 0.5 * path.model.shell.thickness
    cells = Tessellation(mesh.elements, PIECES)
    middle, director, phi = mesh.points + state.u, d.nodal_director(state), d.nodal_phi(state)[:, None]
    faces = [middle + z * (1.0 + z * phi) * director for z in (-half, half)]
    output, component = find(body.output)
    nodal = np.asarray(output.evaluate(d, state), dtype=float)
    nodal = nodal if nodal.ndim == 1 else nodal[:, component - 1] if component else np.linalg.norm(nodal, axis=1)

    points, normals, triangles, values = [], [], [], []
    for face in faces:
        surface = cells.surface(face)
        triangles.append(surface.triangles + sum(map(len, points)))
        points.append(surface.points)
        normals.append(surface.normals)
        values.append(cells.at_points(nodal))
    outer = _outer_edges(mesh, body.copies)
    below, above = (cells.edges(face, outer) for face in faces)
    along = np.gradient(0.5 * (below + above), axis=1)
    outward = np.cross(along, above - below)
    outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
    on_edge = cells.edges(np.repeat(nodal[:, None], 3, axis=1), outer)[..., 0]
    start = sum(map(len, points))
    number = np.arange(below[..., 0].size).reshape(below.shape[:2])
    lower, upper = number + start, number + start + number.size
    quads = np.stack([lower[:, :-1], lower[:, 1:], upper[:, 1:], upper[:, :-1]], axis=-1).reshape(-1, 4)
    triangles += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    points += [below.reshape(-1, 3), above.reshape(-1, 3)]
    normals += [outward.reshape(-1, 3)] * 2
    values += [on_edge.ravel()] * 2
    return Solid(*map(np.concatenate, (points, normals, triangles, values)), [below, above])


def _outer_edges(mesh, copies: Sequence[Copy]) -> np.ndarray:
    """Boundary edges that are not on a mirror plane between two copies."""
    edges = mesh.boundary_edges
    ends = mesh.points[edges]
    inside = np.zeros(len(edges), dtype=bool)
    for copy in copies[1:]:
        image = ends @ copy.matrix.T + np.array(copy.shift)
        inside |= np.abs(image - ends).max(axis=(1, 2)) < 1e-6 * mesh.size
    return edges[~inside]


def cameras_for(groups: Sequence[Sequence[Body]], azimuth: float, elevation: float) -> list[Camera]:
    """One camera per group of bodies: all in one scale and at one height, each as wide as its bodies."""
    axes = viewing_axes(azimuth, elevation)
    seen = [_extent(bodies) @ axes.T for bodies in groups]
    low, high = np.min([x.min(axis=0) for x in seen], axis=0), np.max([x.max(axis=0) for x in seen], axis=0)
    half_height = 0.5 * MARGIN * (high[1] - low[1])
    gap = (MARGIN - 1.0) * half_height
    cameras = []
    for x in seen:
        left, right = x[:, 0].min(), x[:, 0].max()
        centre = np.array([0.5 * (left + right), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])])
        cameras.append(Camera(centre @ axes, axes, 0.5 * (right - left) + gap, half_height))
    return cameras


def _extent(bodies: Sequence[Body]) -> np.ndarray:
    """Positions of all nodes of all copies."""
    positions = []
    for body in bodies:
        x = body.path.discretisation.mesh.points + body.step.state.u
        positions += [x @ copy.matrix.T + np.array(copy.shift) for copy in body.copies]
    return np.concatenate(positions)


def render(bodies: Sequence[Body], camera: Camera, colour, pixels: tuple[int, int]) -> np.ndarray:
    """Picture (height, width, 3) of 0 to 255 on white; `colour` maps values in SI to red, green, blue."""
    require_rendering()
    size = 2.0 * camera.half_height
    nearer = 1.5e-3 * size * camera.axes[2]
    plotter = pyvista.Plotter(
        off_screen=True, window_size=tuple(OVERSAMPLING * side for side in pixels), lighting="none",
        theme=pyvista.themes.DocumentTheme(),
    )  # fmt: skip
    for direction, intensity in LIGHTS:
        light = pyvista.Light(position=np.array(direction) @ camera.axes, focal_point=(0, 0, 0), intensity=intensity)
        light.positional = False
        plotter.add_light(light)
    for body in bodies:
        part = solid(body)
        shades = colour(part.values)
        for copy in body.copies:
            matrix, shift = copy.matrix, np.array(copy.shift)
            triangles = part.triangles if np.linalg.det(matrix) > 0.0 else part.triangles[:, ::-1]
            surface = pyvista.PolyData.from_regular_faces(part.points @ matrix.T + shift, triangles)
            surface.point_data["colours"] = shades
            surface.point_data.active_normals = part.normals @ matrix.T
            plotter.add_mesh(
                surface, scalars="colours", rgb=True, smooth_shading=True, ambient=0.5, specular=0.15, specular_power=25
            )
            for curves in part.edges:
                plotter.add_mesh(
                    _lines(curves @ matrix.T + shift + nearer), color=INK, lighting=False, line_width=OVERSAMPLING * 0.9
                )
    view = plotter.camera
    view.parallel_projection = True
    view.focal_point = camera.centre
    view.position = camera.centre + 20 * size * camera.axes[2]
    view.up = camera.axes[1]
    view.parallel_scale = camera.half_height
    plotter.renderer.reset_camera_clipping_range()
    picture = np.asarray(plotter.screenshot(None, return_img=True), dtype=float)
    plotter.close()
    blocks = picture.reshape(pixels[1], OVERSAMPLING, pixels[0], OVERSAMPLING, 3)
    return blocks.mean(axis=(1, 3)).round().astype(np.uint8)


def _lines(curves: np.ndarray) -> pyvista.PolyData:
    number = np.arange(curves[..., 0].size).reshape(curves.shape[:2])
    return pyvista.PolyData(curves.reshape(-1, 3), lines=np.insert(number, 0, curves.shape[1], axis=1).ravel())
