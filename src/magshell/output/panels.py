"""Parts of a figure made of rendered pictures: the pictures, one colour bar for all, the arrow of the field."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.output.bodies import Body, cameras_for, render
from magshell.output.scene import Camera
from magshell.output.style import ACCENT, TEXT, TICKS

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

Place: TypeAlias = tuple[float, float, float, float]
"""Left, bottom, width and height as fractions of the figure."""


def colour_scale(bodies: Sequence[Body], component: int, size: bool = False) -> ScalarMappable:
    """One scale, mm, for a displacement component of all bodies, or for its size."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    values = np.concatenate([body.step.state.u[:, component - 1] for body in bodies])
    values = np.abs(values) if size else values
    without_the_darkest = ListedColormap(colormaps["viridis"](np.linspace(0.16, 1.0, 512)))
    return ScalarMappable(Normalize(1e3 * float(values.min()), 1e3 * float(values.max())), without_the_darkest)


def draw_sequence(
    figure: Figure,
    groups: Sequence[Sequence[Body]],
    titles: Sequence[str],
    places: Sequence[Place],
    scale: ScalarMappable,
    view: tuple[float, float],
    size: bool = False,
    level: bool = False,
) -> Camera:
    """Render each group of bodies in its place, all in one scale, with its title below.

    Parameters
    ----------
    figure : Figure
    groups : sequence of sequences of Body
    titles : sequence of str
    places : sequence of Place
    scale : ScalarMappable
        Of millimetres.
    view : (float, float)
        Azimuth and elevation of the eye, degrees.
    size : bool
        Colour by the size of the values.
    level : bool
        All pictures at one height; without it each body is in the middle of its own.

    Returns
    -------
    Camera
        Of the first picture.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """

    def shade(values: FloatArray) -> AnyArray:
        return np.asarray(scale.to_rgba(1e3 * (np.abs(values) if size else values), bytes=True))[:, :3]

    shown = fitted(cameras_for(groups, *view, level=level), [aspect(figure, place) for place in places])
    for group, title, place, camera in zip(groups, titles, places, shown, strict=True):
        put(figure, place, render(group, camera, shade, pixels(figure, place)), title)
    return shown[0]


def fitted(cameras: Sequence[Camera], aspects: Sequence[float]) -> list[Camera]:
    """The cameras widened or heightened to these ratios of width to height, still in one scale."""
    half_height = max(
        max(camera.half_height, camera.half_width / aspect) for camera, aspect in zip(cameras, aspects, strict=True)
    )
    return [
        Camera(camera.centre, camera.axes, aspect * half_height, half_height)
        for camera, aspect in zip(cameras, aspects, strict=True)
    ]


def aspect(figure: Figure, place: Place) -> float:
    """Width over height of a place."""
    width, height = pixels(figure, place)
    return width / height


def pixels(figure: Figure, place: Place) -> tuple[int, int]:
    """Width and height of a place."""
    width, height = figure.get_size_inches() * figure.dpi
    return round(place[2] * width), round(place[3] * height)


def put(figure: Figure, place: Place, picture: AnyArray, title: str = "") -> Any:
    """Axes without a frame that hold a rendered picture, its title below."""
    axes = figure.add_axes(place)
    axes.set_axis_off()
    axes.imshow(picture, aspect="auto", interpolation="none", extent=(0, 1, 0, 1))
    axes.text(0.5, -0.03, title, ha="center", va="top", transform=axes.transAxes, **TEXT)
    return axes


def colour_bar(figure: Figure, place: Place, scale: ScalarMappable, title: str) -> None:
    """A bar without a frame, its quantity above."""
    bar = figure.colorbar(scale, cax=figure.add_axes(place))
    bar.outline.set_visible(False)
    bar.ax.tick_params(**TICKS)
    bar.ax.set_title(title, loc="left", pad=12, **TEXT)


def field_arrow(figure: Figure, x: float, y: float, direction: FloatArray, points: float = 56.0) -> None:
    """Arrow of the external field about (x, y), fractions of the figure; direction (2,) on the picture."""
    middle = np.array([x, y]) * figure.get_size_inches() * 72.0
    tail, head = middle - 0.5 * points * direction, middle + 0.5 * points * direction
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    arrow: dict[str, Any] = {"arrowstyle": "-|>,head_width=0.28,head_length=0.55", "color": ACCENT, "linewidth": 2.6}
    arrow |= {"shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, "figure points", "figure points", arrowprops=arrow)
    beyond = head + 15.0 * direction
    place: dict[str, Any] = {"xycoords": "figure points", "ha": "center", "va": "center"}
    axes.annotate(r"$B^\mathrm{ext}$", beyond, color=ACCENT, fontsize=16, **place)
