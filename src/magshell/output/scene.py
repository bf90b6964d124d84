"""The three-dimensional part of a picture: camera, light, surface, edges, undeformed outline and field arrow.

The camera looks in parallel projection: a place on the picture is a linear function of the position in space, so
lettering can be set afterwards, and what moves along the line of sight (lines, to be in front of or behind the
body) stays where it is on the picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray, three_finite
from magshell.errors import InputError
from magshell.output.copies import with_copies
from magshell.output.joints import joints_of
from magshell.output.rendering import require_rendering
from magshell.output.skin import MOST_ELEMENTS_WITH_EDGES, Placed
from magshell.output.sources import Piece
from magshell.output.sources import extent as sources_extent
from magshell.output.sources import place as place_sources
from magshell.output.style import ACCENT, FAINT, GREY, INK, PALE
from magshell.output.tessellation import Tessellation, element_edges

if TYPE_CHECKING:
    from magshell.model.shell import Shell

OVERSAMPLING = 2
MARGIN = 1.06
SURFACE = {"smooth_shading": True, "specular": 0.12, "specular_power": 20, "ambient": 0.58}
"""How surfaces take the light."""


@dataclass(frozen=True)
class Camera:
    """A parallel projection that shows all of a set of points.

    Attributes
    ----------
    centre : FloatArray, shape (3,)
    axes : FloatArray, shape (3, 3)
        Rows: to the right, up, and towards the eye.
    half_width, half_height : float
        Of the part of space seen, m.
    """

    centre: FloatArray
    axes: FloatArray
    half_width: float
    half_height: float

    def on_picture(self, points: FloatArray) -> FloatArray:
        """Position on the picture in fractions of width and height from the lower left, shape (..., 2)."""
        seen = (points - self.centre) @ self.axes[:2].T
        return np.asarray(0.5 + 0.5 * seen / [self.half_width, self.half_height])


def viewing_axes(azimuth: float, elevation: float) -> FloatArray:
    """Rows right, up, towards the eye for an eye at these angles (degrees), X3 upright."""
    a, e = np.radians([azimuth, elevation])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def axes_from(camera: ArrayLike) -> FloatArray:
    """The view from a direction, with X3 upwards, or X2 where it is along X3: rows right, up, towards the camera.

    Raises
    ------
    InputError
        Not three finite numbers, or all of them 0.
    """
    towards = three_finite(camera)
    if towards is None or not towards.any():
        raise InputError(f"camera is {camera!r}; it must be three numbers, the direction from the body to the camera")
    towards = towards / np.linalg.norm(towards)
    steep = abs(towards[2]) > 1.0 - 1e-9
    right = np.cross([0.0, 1.0, 0.0] if steep else [0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def best_axes(points: FloatArray) -> FloatArray:
    """The view from the front and above, of a few candidates, in which these points fill most of the picture."""

    def spread(axes: FloatArray) -> float:
        return float(np.linalg.det(np.cov((points @ axes[:2].T).T)))

    views = [viewing_axes(azimuth, 24.0) for azimuth in (-60.0, -45.0, -75.0, -30.0, -120.0, -135.0)]
    spreads = [spread(axes) for axes in views]
    good = [axes for axes, value in zip(views, spreads, strict=True) if value >= 0.8 * max(spreads)]
    return good[0]


def fit(points: FloatArray, axes: FloatArray, aspect: float) -> Camera:
    """The smallest camera of this width over height that sees all the points, shape (n, 3)."""
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    half = MARGIN * np.maximum((high - low)[:2] / 2, 1e-30)
    half_height = max(half[1], half[0] / aspect)
    return Camera(((low + high) / 2) @ axes, axes, aspect * half_height, half_height)


def draw(
    shell: Shell,
    placed: Placed,
    colours: AnyArray,
    field: FloatArray,
    sources: Sequence[Piece],
    shape: tuple[int, int],
    view: ArrayLike | None = None,
) -> tuple[AnyArray, Camera, FloatArray | None]:
    """Draw the deformed shell over its undeformed outline.

    Parameters
    ----------
    shell : Shell
    placed : Placed
        What is drawn of the shell, where it is.
    colours : AnyArray, shape (points of the surface, 3)
        Red, green, blue, 0 to 255.
    field : FloatArray, shape (3,)
        External flux density; only its direction is drawn, nothing if it is zero.
    sources : sequence of Piece
        Magnets and coils.
    shape : (int, int)
        Width and height of the picture, pixels.
    view : (3,) array_like, optional
        Direction from the body to the camera; by default the best of a few.

    Returns
    -------
    AnyArray, shape (height, width, 4)
        Red, green, blue, opacity.
    Camera
    FloatArray or None, shape (2, 3)
        Tail and head of the field arrow.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    seen = with_copies(placed.surface.points, placed.copies)
    extent = np.vstack([seen, Tessellation(shell.mesh.elements).at_points(shell.mesh.points)])
    axes = best_axes(extent) if view is None else axes_from(view)
    extent = np.vstack([extent, sources_extent(sources, extent)])
    arrow = field_arrow(field, extent, axes)
    kept = extent if arrow is None else np.vstack([extent, lettered(arrow, axes)])
    camera = fit(kept, axes, shape[0] / shape[1])
    return photograph(deformed(shell, placed, colours, arrow, sources, camera), camera, shape), camera, arrow


def deformed(
    shell: Shell,
    placed: Placed,
    colours: AnyArray,
    arrow: FloatArray | None,
    sources: Sequence[Piece],
    camera: Camera,
) -> Callable[[Any], None]:
    """What adds deformed shell, undeformed outline, field arrow (tail and head), magnets and coils to a plotter.

    Copies of a repeated part are grey: outputs have the axes of the part.
    """
    import pyvista

    surface, mesh, outline = placed.surface, shell.mesh, joints_of(shell).outline
    cells = Tessellation(mesh.elements)
    size, axes = 2 * camera.half_height, camera.axes
    nearer = 2e-3 * size * axes[2]
    behind = -4 * size * axes[2]
    edges = element_edges(mesh.elements) if len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES else outline
    body = pyvista.PolyData.from_regular_faces(surface.points, surface.triangles)
    body.point_data["colours"] = colours
    body.point_data.active_normals = surface.normals

    def lines(positions: FloatArray, triples: AnyArray) -> Any:
        return polylines(cells.edges(positions, triples))

    def place(plotter: Any) -> None:
        plotter.add_mesh(body, scalars="colours", rgb=True, **SURFACE)
        for copy in placed.copies:
            image = pyvista.PolyData.from_regular_faces(copy.of(surface.points), surface.triangles)
            image.point_data.active_normals = surface.normals @ copy.matrix.T
            plotter.add_mesh(image, color=FAINT, **SURFACE)
        thin = {"lighting": False, "line_width": 1.0 * OVERSAMPLING}
        thick = {"lighting": False, "line_width": 1.9 * OVERSAMPLING}
        plotter.add_mesh(polylines(placed.inner + nearer), color=INK, opacity=0.28, **thin)
        plotter.add_mesh(polylines(placed.outer + nearer), color=INK, **thick)
        for copy in placed.copies:
            plotter.add_mesh(polylines(copy.of(placed.outer) + nearer), color=GREY, **thin)
        plotter.add_mesh(lines(mesh.points + behind, edges), color=PALE, opacity=0.5, **thin)
        plotter.add_mesh(lines(mesh.points, outline), color=PALE, **thick)
        if arrow is not None:
            plotter.add_mesh(arrow_body(arrow), color=ACCENT, smooth_shading=True, ambient=0.6)
        place_sources(plotter, sources)

    return place


def photograph(place: Callable[[Any], None], camera: Camera, shape: tuple[int, int]) -> AnyArray:
    """A picture of what `place` adds to the plotter it is given, on nothing.

    Returns
    -------
    AnyArray, shape (height, width, 4)
        Red, green, blue, opacity.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    with darkroom(camera, shape) as expose:
        return expose(place)


@contextmanager
def darkroom(
    camera: Camera, shape: tuple[int, int], quick: bool = False
) -> Iterator[Callable[[Callable[[Any], None]], AnyArray]]:
    """One plotter for many pictures by one camera: yields what `photograph` does with it.

    Parameters
    ----------
    camera : Camera
    shape : (int, int)
        Width and height of the pictures, pixels.
    quick : bool
        Smooth edges by oversampling alone: less than half the time, and hardly to be seen.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    require_rendering()
    import pyvista

    size = 2 * camera.half_height
    with pyvista.vtk_verbosity("error"):
        plotter = pyvista.Plotter(
            off_screen=True,
            window_size=(OVERSAMPLING * shape[0], OVERSAMPLING * shape[1]),
            lighting="none",
            theme=pyvista.themes.DocumentTheme(),
        )
        try:
            if quick:
                plotter.render_window.SetMultiSamples(0)
            _light(plotter, camera.axes)
            view = plotter.camera
            view.parallel_projection = True
            view.focal_point = camera.centre
            view.position = camera.centre + 20 * size * camera.axes[2]
            view.up = camera.axes[1]
            view.parallel_scale = camera.half_height

            def expose(place: Callable[[Any], None]) -> AnyArray:
                plotter.suppress_rendering = True
                plotter.clear_actors()
                place(plotter)
                plotter.suppress_rendering = False
                plotter.renderer.reset_camera_clipping_range()
                plotter.render()
                picture = plotter.screenshot(None, return_img=True, transparent_background=True)
                return _reduce(np.asarray(picture))

            yield expose
        finally:
            plotter.close()


def polylines(curves: FloatArray) -> Any:
    """Curves (k, points, 3) as a `pyvista.PolyData`."""
    import pyvista

    numbers = np.arange(curves[..., 0].size).reshape(curves.shape[:2])
    return pyvista.PolyData(curves.reshape(-1, 3), lines=np.insert(numbers, 0, curves.shape[1], axis=1).ravel())


def arrow_body(ends: FloatArray) -> Any:
    """A solid arrow from tail to head (2, 3)."""
    import pyvista

    return pyvista.Arrow(
        start=ends[0],
        direction=ends[1] - ends[0],
        scale=float(np.linalg.norm(ends[1] - ends[0])),
        tip_length=0.3,
        tip_radius=0.085,
        shaft_radius=0.03,
        tip_resolution=48,
        shaft_resolution=48,
    )


def field_arrow(field: FloatArray, extent: FloatArray, axes: FloatArray) -> FloatArray | None:
    """Tail and head of the field arrow, to the left of everything on the picture."""
    strength = np.linalg.norm(field)
    if not strength > 0:  # NaN: not known
        return None
    seen = extent @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = float(np.linalg.norm(high - low))
    vector = 0.22 * size * field / strength
    across = abs(vector @ axes[0]) / 2
    middle = np.array([low[0] - 0.07 * size - across, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2]) @ axes
    return np.stack([middle - vector / 2, middle + vector / 2])


def lettered(arrow: FloatArray, axes: FloatArray) -> FloatArray:
    """Points around the arrow that leave room for its name beyond its head."""
    vector = arrow[1] - arrow[0]
    aside = 0.3 * np.linalg.norm(vector) * axes[:2]
    ends = np.stack([arrow[0], arrow[1] + 0.2 * vector])
    return np.concatenate([ends + aside[0], ends - aside[0], ends + aside[1], ends - aside[1]])


def _light(plotter: Any, axes: FloatArray) -> None:
    """A key light over the left shoulder, one from the eye and a weak one from the right.

    With the body's ambient part they add up to about one, so that colours stay those of the colour bar.
    """
    import pyvista

    for direction, intensity in (((-0.5, 0.8, 1.0), 0.28), ((0.0, 0.0, 1.0), 0.22), ((0.9, 0.1, 0.6), 0.1)):
        light = pyvista.Light(position=np.array(direction) @ axes, focal_point=(0, 0, 0), intensity=intensity)
        light.positional = False
        plotter.add_light(light)


def _reduce(picture: AnyArray) -> AnyArray:
    """Average the oversampled pixels, weighting colours with their opacity."""
    from PIL import Image

    return np.asarray(Image.fromarray(picture).convert("RGBa").reduce(OVERSAMPLING).convert("RGBA"))
