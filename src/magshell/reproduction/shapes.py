"""The deformed shapes of an example at the paper's fields, and its undeformed body with the remanence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.model.model import Model
from magshell.output.bodies import Body, cameras_for, faces, render
from magshell.output.panels import (
    Place,
    aspect,
    colour_bar,
    colour_scale,
    draw_sequence,
    field_arrow,
    fitted,
    pixels,
    put,
)
from magshell.output.style import COLOURS, GREY, INK, TEXT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from magshell.output.scene import Camera
    from magshell.reproduction.catalogue import Example
    from magshell.solver.path import Path

DPI = 120
REMANENCE = COLOURS[0]
PALE_BODY = (226, 230, 236)
ABOVE = 0.06
"""Of an arrow's length, over the face."""
ROOM = 1.12
"""Around the undeformed body, for letters."""
HEIGHTS = (4.2, 5.6)
"""Of its figure, inches."""
LETTER = 17.0
"""From a point to its letter, printer's points."""


def shapes_figure(example: Example, paths: Mapping[str, Path]) -> Figure:
    """The whole body at the paper's four fields in one scale, coloured by the size of a displacement component.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    from matplotlib.figure import Figure

    groups = [example.bodies_at(paths, field) for field in example.fields]
    scale = colour_scale([body for group in groups for body in group], example.component, example.size)
    cameras = cameras_for(groups, *example.view)
    ratio = max(camera.half_width for camera in cameras) / cameras[0].half_height
    left, share, below, tall, gap = 0.085, 0.4, 0.075, 0.415, 0.085
    width = 11.0
    height = float(np.clip(share * width / ratio / tall, 5.0, 9.5))
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    places: list[Place] = [
        (left + share * column, below + (tall + gap) * (1 - row), share, tall) for row in (0, 1) for column in (0, 1)
    ]
    camera = draw_sequence(
        figure, groups, [f"{field:g} mT" for field in example.fields], places, scale, example.view, example.size
    )
    field_arrow(figure, 0.045, 0.5, _on_picture(camera, _field_of(groups[0][0].path.model)))
    colour_bar(figure, (0.9, 0.22, 0.015, 0.55), scale, f"${example.quantity}$ (mm)")
    return figure


def undeformed_figure(example: Example, paths: Mapping[str, Path]) -> Figure:
    """The undeformed whole body with arrows of the remanence, the directions of the field and the axes, and the probes.

    Raises
    ------
    RenderingUnavailable
        This machine cannot draw without a screen.
    """
    from matplotlib.figure import Figure

    bodies = example.bodies(paths, lambda path: path.steps[0])
    (camera,) = cameras_for([bodies], *example.view)
    width, room = 7.4, 0.87
    height = float(np.clip(ROOM * room * width * camera.half_height / camera.half_width, *HEIGHTS))
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    place: Place = (1.0 - room, 0.0, room, 1.0)
    (camera,) = fitted([camera], [aspect(figure, place)])
    camera = replace(camera, half_width=ROOM * camera.half_width, half_height=ROOM * camera.half_height)
    arrows = [arrow for body in bodies for arrow in _remanence(example, body)]
    axes = put(figure, place, render(bodies, camera, _pale, pixels(figure, place), arrows, REMANENCE))
    body = bodies[0]
    _probes(axes, body, camera, 72.0 / DPI * np.array(pixels(figure, place)))
    field_arrow(figure, 0.07, 0.5, _on_picture(camera, _field_of(body.path.model)))
    _key(figure)
    _triad(figure, camera)
    return figure


def _probes(axes: Axes, body: Body, camera: Camera, size: FloatArray) -> None:
    """Dots at the probes with their names, away from the body's middle where that is free; size in points."""
    from matplotlib.patheffects import withStroke

    (upper,) = faces(body.path, body.step, [0.5])
    seen = size * camera.on_picture(body.copies[0].of(upper))
    nodes = body.path.model.probe_nodes
    taken = [seen[node] for node in nodes.values()]
    for name, node in nodes.items():
        away = seen[node] - seen.mean(axis=0)
        angles = np.arctan2(away[1], away[0]) + np.radians([0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0, 180.0])
        places = seen[node] + LETTER * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        gaps = [min(float(np.linalg.norm(place - other)) for other in taken) for place in places]
        letter = next((place for place, gap in zip(places, gaps, strict=True) if gap > 0.9 * LETTER), places[0])
        taken.append(letter)
        axes.plot(*(seen[node] / size), "o", markersize=4.5, color=INK)
        text = axes.annotate(name, tuple(letter / size), ha="center", va="center", **TEXT)
        text.set_path_effects([withStroke(linewidth=3, foreground="white")])
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)


def _pale(values: FloatArray) -> AnyArray:
    return np.tile(np.array(PALE_BODY, dtype=np.uint8), (len(values), 1))


def _on_picture(camera: Camera, vector: FloatArray) -> FloatArray:
    """Direction of a vector on the picture, of length 1 if it lies in its plane."""
    return np.asarray(camera.axes[:2] @ (vector / np.linalg.norm(vector)))


def _remanence(example: Example, body: Body) -> list[FloatArray]:
    """Tail and head (2, 3) of the arrows on the upper face of all copies, where there is a remanence."""
    path, mesh = body.path, body.path.discretisation.mesh
    centres = mesh.points[mesh.elements].mean(axis=1)
    arrows: dict[tuple[float, ...], FloatArray] = {}
    for place in example.arrows(mesh):
        element = int(np.linalg.norm(centres - place, axis=1).argmin())
        everywhere = np.broadcast_to(place, (len(mesh.elements), 1, 3)).copy()
        vector = path.model.shell.remanence(mesh, everywhere)[element, 0]
        size = float(np.linalg.norm(vector))
        if size == 0.0:
            continue
        half = 0.5 * example.arrow_length * vector / size
        normal = path.discretisation.normals[mesh.elements[element]].mean(axis=0)
        middle = place + (0.5 * path.model.shell.greatest_thickness + ABOVE * example.arrow_length) * normal
        for copy in body.copies:
            ends = copy.of(np.stack([middle - half, middle + half]))
            arrows[tuple(np.round(ends.mean(axis=0), 7))] = ends
    return list(arrows.values())


def _key(figure: Figure) -> None:
    """What the arrows on the body are, in the upper left corner."""
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    height = 72.0 * figure.get_size_inches()[1]
    arrow = {"arrowstyle": "-|>", "color": REMANENCE, "linewidth": 2.6, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (48.0, height - 28.0), (16.0, height - 28.0), "figure points", "figure points", arrowprops=arrow)
    at = (56.0, height - 28.0)
    axes.annotate(r"$B^\mathrm{rem}$", at, xycoords="figure points", va="center", fontsize=16, color=REMANENCE)


def _triad(figure: Figure, camera: Camera) -> None:
    """The directions X1, X2, X3 in the lower left corner."""
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    origin, length, beyond = np.array([46.0, 40.0]), 30.0, 11.0
    for i in range(3):
        tip = length * camera.axes[:2, i]
        arrow = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.3, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", tuple(origin + tip), tuple(origin), "figure points", "figure points", arrowprops=arrow)
        at = tuple(origin + tip * (1 + beyond / max(float(np.linalg.norm(tip)), 1e-9)))
        axes.annotate(f"$X_{i + 1}$", at, xycoords="figure points", ha="center", va="center", fontsize=13, color=GREY)


def _field_of(model: Model) -> FloatArray:
    """The uniform field (3,) of an example, T."""
    return model.course(0).at(1.0).flux_density
