"""The picture of the deformed shape: a three-dimensional scene with lettering set over it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import Output, find
from magshell.evaluation.patches import patches_of
from magshell.output.labels import bar_title, shown_unit
from magshell.output.rounding import without_round_off
from magshell.output.scene import draw
from magshell.output.skin import Skin, skin_of
from magshell.output.sources import pieces
from magshell.output.style import ACCENT, DPI, GREY, TEXT, TICKS, deliver

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from PIL.Image import Image

    from magshell.model.shell import Shell
    from magshell.solver.path import Path
    from magshell.solver.step import Step

INCHES = (10.0, 7.0)
SCENE = (0.0, 0.0, 0.865, 0.9)
"""Left, bottom, width and height of the scene as fractions of the picture."""


def draw_shape(
    path: Path,
    file: str | os.PathLike[str] | None = "shape.png",
    step: int = -1,
    color: str = "u3",
    camera: ArrayLike | None = None,
) -> Image | None:
    """Draw the deformed shape, true to scale, over the undeformed outline, with the field, magnets and coils.

    Parameters
    ----------
    path : Path
    file : path, optional
        PNG file to write; None to get the picture instead.
    step : int
        Which converged step; negative counts from the last.
    color : str
        Output that colours the shape: a name or symbol of `magshell.evaluation.outputs`, with the suffix of a component
        ("u3", "rotation", "thickness_ratio", "von_mises_top", "s11_top").
    camera : (3,) array_like, optional
        Direction from the body to the camera, such as (0, -1, 0) for a view along X2; by default the best of a few.

    Returns
    -------
    PIL.Image.Image or None
        The picture, if no file was named.

    Raises
    ------
    InputError
        No such step or output, or a camera that is no direction.
    RenderingUnavailable
        This machine cannot draw without a screen; the message says what to install.
    OSError
        The disk refuses; the message names the file.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

    output, component = find(color)
    shown = _step(path, step)
    skin = skin_of(path.model.shell)
    (values,) = shown_values(path, [shown], output, component, skin)
    colours = ScalarMappable(*colour_scale(values))
    rgb = colours.to_rgba(values, bytes=True)[:, :3]
    field, sources = path.flux_density(shown), pieces(path.model.field, shown.drives)
    pixels = (round(DPI * INCHES[0] * SCENE[2]), round(DPI * INCHES[1] * SCENE[3]))
    placed = skin.placed(converged(path.discretisation, shown))
    scene, seen, arrow = draw(path.model.shell, placed, rgb, field, sources, pixels, camera)

    figure = Figure(figsize=INCHES, dpi=DPI, facecolor="white")
    axes = figure.add_axes(SCENE)
    axes.set_axis_off()
    axes.imshow(scene, extent=(0, 1, 0, 1), aspect="auto", interpolation="none")
    colour_bar(figure, colours, bar_title(output, component))
    figure.text(0.035, 0.94, field_title(field, r"$|B^\mathrm{ext}|$"), va="center", **(TEXT | {"fontsize": 20}))
    if arrow is not None:
        _label_arrow(axes, seen.on_picture(arrow))
    triad(axes, seen.axes)
    return deliver(figure, file)


def _step(path: Path, number: int) -> Step:
    if not -len(path.steps) <= number < len(path.steps):
        raise InputError(f"There is no step {number}; the path has steps 0 to {len(path.steps) - 1}.")
    return path.steps[number]


def colour_bar(
    figure: Figure, colours: ScalarMappable, title: str, upright: tuple[float, float] = (0.16, 0.6), more: bool = False
) -> None:
    """A bar on the right of the scene, its quantity above; `upright`: lowest point and height, fractions."""
    bar = figure.colorbar(
        colours, extend="max" if more else "neither", cax=figure.add_axes((0.885, upright[0], 0.022, upright[1]))
    )
    bar.outline.set_visible(False)
    bar.ax.tick_params(**TICKS)
    bar.ax.set_title(title, pad=14, loc="left", **TEXT)


def shown_values(
    path: Path, steps: Sequence[Step], output: Output, component: int | None, skin: Skin
) -> Iterator[FloatArray]:
    """The scalar shown at each step, in the unit of pictures, at the points of the surface."""
    _, factor = shown_unit(output)
    for (values,) in without_round_off(path, [output], steps):
        shown = spread(skin, path.model.shell, output, values)
        if output.components > 1:
            shown = np.linalg.norm(shown, axis=1) if component is None else shown[:, component - 1]
        yield np.asarray(factor * shown)


def spread(skin: Skin, shell: Shell, output: Output, values: FloatArray) -> FloatArray:
    """Values of an output at the points of the surface."""
    if output.where == "point":
        return skin.at_points(values)
    return skin.on_elements(values) if output.where == "cell" else skin.at_corners(values[patches_of(shell).elements])


def colour_scale(values: AnyArray) -> tuple[Any, Any]:
    """Normalisation and colour map: diverging about zero where both signs matter."""
    from matplotlib import colormaps
    from matplotlib.colors import Normalize

    low, high = float(values.min()), float(values.max())
    largest = max(abs(low), abs(high))
    if high - low <= 1e-9 * largest:
        half = 0.5 * (largest or 1.0)
        return Normalize(low - half, high + half), colormaps["viridis"]
    if min(-low, high) > 0.1 * largest:
        return Normalize(-largest, largest), colormaps["coolwarm"]
    return Normalize(low, high), colormaps["viridis"]


def field_title(flux_density: FloatArray, symbol: str = "|B|") -> str:
    """The strength of the field above a picture; the flux density is NaN where it is not known."""
    size = 1e3 * float(np.linalg.norm(flux_density))
    if np.isnan(size):
        return "field not known at the centre"
    return f"{symbol} = {size:.4g} mT" if size > 0 else "no field"


def _label_arrow(axes: Any, ends: FloatArray) -> None:
    tail, head = ends
    beyond = 0.04 * (head - tail) / max(float(np.linalg.norm(head - tail)), 1e-9)
    place = {"ha": "center", "va": "center", "annotation_clip": False}
    axes.annotate(r"$B^\mathrm{ext}$", head + beyond, xycoords="axes fraction", color=ACCENT, fontsize=16, **place)


def triad(axes: Any, view: FloatArray) -> None:
    """The directions X1, X2, X3 in the lower left corner."""
    origin, length, beyond = np.array([62.0, 48.0]), 34.0, 11.0
    line = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.3, "shrinkA": 0, "shrinkB": 0}
    for i in range(3):
        tip = length * view[:2, i]
        axes.annotate("", origin + tip, origin, "axes points", "axes points", arrowprops=line)
        place = origin + tip * (1 + beyond / max(float(np.linalg.norm(tip)), 1e-9))
        axes.annotate(f"$X_{i + 1}$", place, None, "axes points", ha="center", va="center", fontsize=13, color=GREY)
