"""Pictures of many steps of a path, by one camera and in one scale of colours; and the path as an animation.

Every frame of an animation is a converged step, unless frames between them are asked for: these interpolate linearly
between two steps. Time runs evenly along the path (in arc length), so a step is shown until the path would be at the
next one; the last is held.
"""

from __future__ import annotations

import io
import os
import pathlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import find
from magshell.files import write_atomically
from magshell.mesh.geometry import unit
from magshell.output.copies import between
from magshell.output.field_plane import FieldArrows, FieldPlane
from magshell.output.film_files import RATE, require_writer
from magshell.output.labels import bar_title
from magshell.output.scene import Camera, axes_from, best_axes, darkroom, deformed, field_arrow, fit, lettered
from magshell.output.shape import INCHES, SCENE, colour_bar, colour_scale, field_title, shown_values, triad
from magshell.output.skin import Placed, Skin, skin_of
from magshell.output.sources import Plane, pieces
from magshell.output.sources import extent as sources_extent
from magshell.output.style import ACCENT, DPI, INK, said
from magshell.output.tessellation import Surface

if TYPE_CHECKING:
    from PIL.Image import Image

    from magshell.solver.path import Path
    from magshell.solver.step import Step

FILM_DPI = 100
SECONDS, HELD = 4.0, 1.5
"""Of the path from its first to its last step, and of the last step."""
SHORTEST = 0.04
"""Of a step, s: steps nearer than this to the one before are left out of an animation."""
LONGEST = 120.0
"""Of a film, s."""
UPPER, LOWER = (0.52, 0.33), (0.06, 0.33)
"""Bottom and height of two colour bars, fractions of the picture."""


class Frame(NamedTuple):
    """A picture of an animation: of a step, or of a share of the way from it to a later one; how long it is seen, s."""

    step: Step
    seconds: float
    later: Step | None = None
    share: float = 0.0


def frames(path: Path, duration: float = SECONDS, smooth: bool = False) -> list[Frame]:
    """The pictures of an animation, with times in proportion to the length of the path to the next one.

    Parameters
    ----------
    path : Path
    duration : float
        From the first to the last step, s.
    smooth : bool
        Whether there are pictures between the steps, `RATE` in a second.
    """
    if smooth and path.steps[-1].arc_length > path.steps[0].arc_length:
        return _between(path, duration)
    places = np.array([step.arc_length for step in path.steps])
    if places[-1] <= places[0]:
        return [Frame(step, HELD) for step in path.steps[-1:]]
    times = duration * (places - places[0]) / (places[-1] - places[0])
    kept = [0]
    for number in range(1, len(times) - 1):
        if times[number] - times[kept[-1]] >= SHORTEST and times[-1] - times[number] >= SHORTEST:
            kept.append(number)
    kept.append(len(times) - 1)
    seconds = [*np.diff(times[kept]).tolist(), HELD]
    return [Frame(path.steps[number], each) for number, each in zip(kept, seconds, strict=True)]


def _between(path: Path, duration: float) -> list[Frame]:
    """Pictures at an even rate, each on the way from one step to the next."""
    places = np.array([step.arc_length for step in path.steps])
    count = max(round(RATE * duration), 1)
    found = []
    for place in np.linspace(places[0], places[-1], count, endpoint=False):
        number = int(np.searchsorted(places, place, side="right")) - 1
        share = float((place - places[number]) / (places[number + 1] - places[number]))
        found.append(Frame(path.steps[number], duration / count, path.steps[number + 1], share))
    return [*found, Frame(path.steps[-1], HELD)]


@contextmanager
def film(
    path: Path,
    steps: Sequence[Step],
    color: str,
    dpi: int = DPI,
    camera: ArrayLike | None = None,
    plane: FieldPlane | None = None,
) -> Iterator[Callable[[Frame], Image]]:
    """Draw steps by one camera, which sees all of them, with one plotter.

    Parameters
    ----------
    path : Path
    steps : sequence of Step
        All that will be drawn; the scale of colours is that of them together.
    color : str
        Output that colours the shape, as in `magshell.evaluation.outputs.find`.
    dpi : int
        Size of the pictures: `magshell.output.shape.INCHES` times this, even numbers.
    camera : (3,) array_like, optional
        Direction from the body to the camera; by default the best of a few.
    plane : FieldPlane, optional
        On which the field of sources and grids is drawn as arrows.

    Yields
    ------
    callable
        From a frame of these steps to its picture.

    Raises
    ------
    InputError
        No such output, a camera that is no direction, or no field on the plane.
    RenderingUnavailable
        This machine cannot draw without a screen; the message says what to install.
    """
    from matplotlib.cm import ScalarMappable
    from PIL import Image as images

    output, component = find(color)
    skin = skin_of(path.model.shell)
    shown = shown_values(path, steps, output, component, skin)
    values = {step.number: each for step, each in zip(steps, shown, strict=True)}
    colours = ScalarMappable(*colour_scale(np.array([f(v) for v in values.values() for f in (np.min, np.max)])))
    shape = round(dpi * INCHES[0] * SCENE[2]), round(dpi * INCHES[1] * SCENE[3])
    seen, arrow_of, sheet = _look(path, steps, skin, shape, camera, plane)
    on_plane = FieldArrows(path, steps, sheet) if sheet is not None else None
    front = _front(seen, colours, bar_title(output, component), dpi, on_plane)

    @lru_cache(maxsize=2)
    def placed(number: int) -> Placed:
        return skin.placed(converged(path.discretisation, path.steps[number]))

    with darkroom(seen, shape, quick=True) as expose:

        def picture(frame: Frame) -> Image:
            number, field, drives = frame.step.number, path.flux_density(frame.step), frame.step.drives
            body, shown = placed(number), values[number]
            if frame.later is not None:
                after = frame.later.number
                body = _mixed(body, placed(after), frame.share)
                shown, field, drives = (
                    one + frame.share * (other - one)
                    for one, other in (
                        (shown, values[after]),
                        (field, path.flux_density(frame.later)),
                        (drives, frame.later.drives),
                    )
                )
            arrow = arrow_of(field)
            rgb = colours.to_rgba(shown, bytes=True)[:, :3]
            sources = pieces(path.model.field, drives)
            places = [deformed(path.model.shell, body, rgb, arrow, sources, seen)]
            if on_plane is not None:
                places.append(on_plane.at(drives))

            def place(plotter: Any) -> None:
                for each in places:
                    each(plotter)

            scene = expose(place)
            whole = images.new("RGBA", front.size, "white")
            whole.alpha_composite(images.fromarray(scene), (0, front.height - shape[1]))
            whole.alpha_composite(front)
            head = None if arrow is None else _beyond(seen.on_picture(arrow), shape, front.height)
            _letter(whole, f"step {number}", field, head, dpi)
            return whole.convert("RGB")

        yield picture


def spread(path: Path, count: int = 4) -> list[Step]:
    """Up to so many steps, evenly along the path (in arc length), the last among them and not the undeformed one."""
    places = np.array([step.arc_length for step in path.steps])
    wanted = places[-1] * np.arange(1, count + 1) / count
    numbers = {int(np.abs(places - place).argmin()) for place in wanted} - {0}
    return [path.steps[number] for number in sorted(numbers | {len(path.steps) - 1})]


def draw_steps(
    path: Path,
    steps: Sequence[Step],
    directory: str | os.PathLike[str],
    color: str = "u3",
    advance: Callable[[float], None] = lambda share: None,
    camera: ArrayLike | None = None,
    plane: FieldPlane | None = None,
) -> list[pathlib.Path]:
    """Draw `shape-NNNN.png` for steps of a path, all by one camera, in one scale of colours.

    Raises
    ------
    InputError, RenderingUnavailable
        As of `film`.
    OSError
        The disk refuses; the message names the file.
    """
    files = []
    with film(path, steps, color, camera=camera, plane=plane) as picture:
        for number, step in enumerate(steps, start=1):
            content = io.BytesIO()
            picture(Frame(step, 0.0)).save(content, format="png", optimize=True, pnginfo=said())
            files.append(pathlib.Path(directory) / f"shape-{step.number:04d}.png")
            write_atomically(files[-1], content.getvalue())
            advance(number / len(steps))
    return files


def animate(
    path: Path,
    file: str | os.PathLike[str],
    color: str = "u3",
    advance: Callable[[float], None] = lambda share: None,
    seconds: float = SECONDS,
    camera: ArrayLike | None = None,
    smooth: bool = False,
) -> pathlib.Path:
    """Write the path as an animation.

    Parameters
    ----------
    path : Path
        With at least one step.
    file : path
        `.gif`, or `.mp4`, `.mov`, `.m4v` (H.264; needs the extra `magshell[video]`).
    color : str
        Output that colours the shape, as in `magshell.evaluation.outputs.find`; one scale for all frames.
    advance : callable
        Told the share of the work that is done.
    seconds : float
        From the first to the last step, s; the last one is held for `HELD`.
    camera : (3,) array_like, optional
        Direction from the body to the camera, such as (0, -1, 0) for a view along X2; by default the best of a few.
    smooth : bool
        Whether shapes, colours and field between the steps are drawn as well, linearly interpolated.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        No such output, a suffix that is none of these, or a video without the extra; a time that is not positive; a
        camera that is no direction.
    RenderingUnavailable
        This machine cannot draw without a screen; the message says what to install.
    OSError
        The disk refuses; the message names the file.
    """
    target = pathlib.Path(file)
    write = require_writer(target)
    if not 0.0 < seconds <= LONGEST:
        raise InputError(f"seconds is {seconds!r}; a film takes more than 0 and at most {LONGEST:g} s")
    shown = frames(path, seconds, smooth)
    pictures, numbers = [], {each.number for frame in shown for each in (frame.step, frame.later) if each is not None}
    with film(path, [path.steps[number] for number in sorted(numbers)], color, FILM_DPI, camera) as picture:
        for number, frame in enumerate(shown, start=1):
            pictures.append(picture(frame))
            advance(number / len(shown))
    write_atomically(target, write(pictures, [frame.seconds for frame in shown]))
    return target


def _look(
    path: Path,
    steps: Sequence[Step],
    skin: Skin,
    shape: tuple[int, int],
    view: ArrayLike | None,
    plane: FieldPlane | None,
) -> tuple[Camera, Callable[[FloatArray], FloatArray | None], Plane | None]:
    """The camera of all steps, the arrow of a field, as long as the field is strong, and the part of a plane drawn."""
    mesh = path.discretisation.mesh
    places = [skin.extent(converged(path.discretisation, step)) for step in steps]
    shell = np.concatenate([mesh.points, *places])
    around = (sources_extent(pieces(path.model.field, step.drives), shell) for step in steps)
    extent = np.concatenate([shell, *around])
    sheet = plane.over(extent) if plane is not None else None
    if sheet is not None:
        extent = np.concatenate([extent, sheet.grid()])
    ends = np.vstack([mesh.points, mesh.points + steps[-1].state.displacement(len(mesh.points))])
    axes = best_axes(ends) if view is None else axes_from(view)
    strongest = max(float(np.linalg.norm(step.flux_density)) for step in steps)

    def arrow_of(field: FloatArray) -> FloatArray | None:
        arrow = field_arrow(field, extent, axes)
        if arrow is None:
            return None
        share = 0.35 + 0.65 * float(np.linalg.norm(field)) / strongest
        return np.asarray(arrow.mean(axis=0) + share * (arrow - arrow.mean(axis=0)))

    arrows = [arrow for step in steps if (arrow := arrow_of(step.flux_density)) is not None]
    letters = [lettered(arrow, axes) for arrow in arrows]
    return fit(np.concatenate([extent, *letters]), axes, shape[0] / shape[1]), arrow_of, sheet


def _mixed(one: Placed, other: Placed, share: float) -> Placed:
    """A share of the way from one to another."""
    points, normals, inner, outer = (
        a + share * (b - a)
        for a, b in (
            (one.surface.points, other.surface.points),
            (one.surface.normals, other.surface.normals),
            (one.inner, other.inner),
            (one.outer, other.outer),
        )
    )
    copies = between(one.copies, other.copies, share)
    return Placed(Surface(points, unit(normals), one.surface.triangles), inner, outer, copies)


def _front(camera: Camera, colours: Any, title: str, dpi: int, on_plane: FieldArrows | None) -> Image:
    """What is the same in all pictures: colour bars and directions, on nothing."""
    from matplotlib.figure import Figure
    from PIL import Image as images

    figure = Figure(figsize=INCHES, dpi=dpi)
    axes = figure.add_axes(SCENE)
    axes.set_axis_off()
    if on_plane is None:
        colour_bar(figure, colours, title)
    else:
        colour_bar(figure, colours, title, UPPER)
        colour_bar(figure, on_plane.colours, "$|B|$ (mT)", LOWER, on_plane.more)
    triad(axes, camera.axes)
    content = io.BytesIO()
    figure.savefig(content, format="png", transparent=True)
    return images.open(content).convert("RGBA")


def _beyond(ends: FloatArray, shape: tuple[int, int], height: int) -> FloatArray:
    """Pixel beyond the head of an arrow, from its tail and head in fractions of the scene (from below)."""
    tail, head = (np.array([x * shape[0], height - y * shape[1]]) for x, y in ends)
    along = head - tail
    return np.asarray(head + 0.028 * height * along / max(float(np.linalg.norm(along)), 1e-9))


def _letter(picture: Image, name: str, field: FloatArray, head: FloatArray | None, dpi: int) -> None:
    """The strength of the field and a name above, and the field's letter beyond the arrow."""
    from matplotlib.font_manager import FontProperties, findfont
    from PIL import ImageDraw, ImageFont

    points = dpi / 72
    draw = ImageDraw.Draw(picture)
    plain = findfont(FontProperties(family="DejaVu Sans"))
    place = 0.035 * picture.width, 0.06 * picture.height
    draw.text(place, field_title(field), INK, ImageFont.truetype(plain, 20 * points), anchor="lm")
    right = 0.86 * picture.width, 0.06 * picture.height
    draw.text(right, name, "#6b7280", ImageFont.truetype(plain, 13 * points), anchor="rm")
    if head is not None:
        slanted = findfont(FontProperties(family="DejaVu Sans", style="oblique"))
        draw.text(tuple(head), "B", ACCENT, ImageFont.truetype(slanted, 16 * points), anchor="mm")
