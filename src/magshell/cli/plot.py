"""`magshell plot`."""

from __future__ import annotations

import argparse
import pathlib
from typing import TYPE_CHECKING

from magshell.cli.console import complain, console, say
from magshell.cli.folders import made
from magshell.cli.status import NOT_SOLVED, SOLVED
from magshell.cli.work import bar
from magshell.errors import InputError

if TYPE_CHECKING:
    from magshell.output.field_plane import FieldPlane
    from magshell.solver.path import Path
    from magshell.solver.step import Step

ABOUT = "draw a results folder: curves, shapes, an animation"
EXAMPLES = """
examples:
  magshell plot results                              curve.png and shape-NNNN.png of four steps, into results
  magshell plot results --color energy --steps 0,5,-1
  magshell plot results --steps all --out pictures
  magshell plot results --curves foot.R3,foot.R1     these columns of history.csv in curve.png
  magshell plot results --over field.angle           curves over the angle of a field that turns
  magshell plot results --animate shape.gif          also the path as an animation
  magshell plot results --animate shape.gif --seconds 8 --smooth --camera 1,-1,0.5
  magshell plot results --field-plane x2=0           also the field on this plane, as arrows coloured by |B|
  magshell plot results --animate shape.mp4          as a video: pip install 'magshell[video]'

Without --steps the shapes are spread evenly along the path. All of them are seen by one camera, in one scale of colours
and true to scale. OUTPUT is a name or symbol of the results: u3, u, energy, rotation, thickness_ratio, remanence, ...
NAME is field (|B|, mT), load_factor, or an amount of the field that varies: field.angle, magnet.angle, magnet.d3, ...
Without --over it is |B| of a uniform field, the angle of what turns, or else the load factor.
Every frame of an animation is a converged step, seen for as long as the path is to the next one; the last is held.
--field-plane has an axis and a coordinate with its unit: x2=0, 'x3=5 mm'. It is for the pictures of steps. The field is
that of field, magnets and coils; points where it is zero or not known, as inside magnets, have no arrow.
--smooth interpolates linearly between the steps.
A run that was interrupted, or that is still going on, is drawn as far as it got."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("directory", metavar="DIR", help="a folder that magshell run has written")
    parser.add_argument("--color", metavar="OUTPUT", default="u3", help="what colours the shapes (default: u3)")
    parser.add_argument("--steps", metavar="N,N,...", help="numbers of steps, negative from the end; or: all")
    parser.add_argument("--curves", metavar="NAME,NAME,...", help="columns of history.csv to draw, all of one unit")
    parser.add_argument("--over", metavar="NAME", help="what curves are drawn over: field, load_factor, field.angle, …")
    parser.add_argument("--animate", metavar="FILE", help="also write an animation: .gif, or .mp4 with an extra")
    parser.add_argument("--seconds", metavar="S", type=float, default=4.0, help="length of the animation (default: 4)")
    parser.add_argument("--smooth", action="store_true", help="also frames between the steps, linearly interpolated")
    parser.add_argument("--camera", metavar="X,Y,Z", help="direction from the body to the camera, such as 0,-1,0")
    parser.add_argument("--field-plane", metavar="PLANE", help="draw the field on a plane: x2=0, 'x3=5 mm', …")
    parser.add_argument("--out", metavar="DIR", help="folder of the pictures (default: the results folder)")


def run(given: argparse.Namespace) -> int:
    """Draw."""
    from magshell.evaluation.outputs import find
    from magshell.files import refuse_to_replace
    from magshell.output.abscissa import abscissa
    from magshell.output.animation import animate, draw_steps
    from magshell.output.curve import draw_curve
    from magshell.output.film_files import require_writer
    from magshell.output.rendering import RenderingUnavailable
    from magshell.output.series import chosen
    from magshell.output.style import is_ours
    from magshell.results import is_one, read

    find(given.color)
    camera = _camera(given.camera)
    plane = _plane(given.field_plane)
    if given.animate:
        require_writer(given.animate)
    path = read(given.directory).path
    steps = _steps(path, given.steps)
    columns = [name.strip() for name in given.curves.split(",")] if given.curves is not None else []
    if columns:
        chosen(path, columns)
    abscissa(path, given.over)
    directory = made(pathlib.Path(given.out or given.directory))
    if not is_one(directory):
        names = ["curve.png", *(f"shape-{step.number:04d}.png" for step in steps)]
        own = [name for name in names if (directory / name).is_file() and not is_ours(directory / name)]
        refuse_to_replace(directory, own)
    out = console()
    draw_curve(path, directory / "curve.png", columns, given.over)
    say(out, f"picture: {directory / 'curve.png'}")
    try:
        with bar(out, "drawing shapes") as advance:
            files = draw_steps(path, steps, directory, given.color, advance, camera, plane)
        for file in files:
            say(out, f"picture: {file}")
        if given.animate:
            with bar(out, "drawing the frames of the animation") as advance:
                file = animate(path, given.animate, given.color, advance, given.seconds, camera, given.smooth)
            say(out, f"animation: {file} ({file.stat().st_size / 1e6:.2g} MB)")
    except RenderingUnavailable as unavailable:
        complain(str(unavailable))
        return NOT_SOLVED
    return SOLVED


def _camera(text: str | None) -> list[float] | None:
    """The direction that a user asks for."""
    from magshell.output.scene import axes_from

    if text is None:
        return None
    try:
        direction = [float(part) for part in text.split(",")]
        axes_from(direction)
    except ValueError:
        raise InputError(f"--camera {text}: write three numbers, not all 0, such as 1,-1,0.5") from None
    return direction


def _plane(text: str | None) -> FieldPlane | None:
    """The plane that a user asks for."""
    from magshell.output.field_plane import field_plane

    if text is None:
        return None
    try:
        return field_plane(text)
    except InputError as error:
        raise InputError(f"--field-plane: {error}") from None


def _steps(path: Path, text: str | None) -> list[Step]:
    """The steps that a user asks for."""
    from magshell.output.animation import spread

    if text is None:
        return spread(path)
    if text == "all":
        return path.steps
    count = len(path.steps)
    numbers = []
    for part in text.split(","):
        try:
            number = int(part)
        except ValueError:
            raise InputError(f"--steps {text}: '{part}' is not a number of a step; write 0,5,-1 or all") from None
        if not -count <= number < count:
            raise InputError(f"--steps {text}: there is no step {number}; the path has steps 0 to {count - 1}")
        numbers.append(number % count)
    return [path.steps[number] for number in dict.fromkeys(numbers)]
