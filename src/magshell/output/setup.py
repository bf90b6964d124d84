"""The picture before any solve: the undeformed part with its remanence, field, supports, loads and probes.

The marks in space are made in `marks.py`; here they are rendered, labelled and explained in a legend.
"""

from __future__ import annotations

import os
import re
from itertools import chain
from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.magnetics.remanence import placed as in_the_template
from magshell.mesh.edges import SIDES
from magshell.model.words import name_of, thickness_of
from magshell.output.joints import joints_of
from magshell.output.lettering import write_letters
from magshell.output.marks import (
    Mark,
    body_marks,
    field_marks,
    hinge_marks,
    load_marks,
    probe_marks,
    remanence_marks,
    repeated_marks,
    spring_marks,
    support_marks,
)
from magshell.output.scene import (
    OVERSAMPLING,
    SURFACE,
    Camera,
    fit,
    photograph,
    polylines,
    viewing_axes,
)
from magshell.output.shape import triad
from magshell.output.skin import MOST_ELEMENTS_WITH_EDGES, Hull
from magshell.output.sources import COPPER, NORTH, SOUTH, Piece, pieces
from magshell.output.sources import extent as sources_extent
from magshell.output.sources import place as place_sources
from magshell.output.style import DPI, GREY, INK, PALE, TEXT, deliver
from magshell.output.tessellation import Tessellation, own_nodes
from magshell.output.turns import field_turns, source_turns, turn_marks

if TYPE_CHECKING:
    from PIL.Image import Image

    from magshell.model.model import Model
    from magshell.model.shell import Shell

INCHES = (10.0, 7.0)
SCENE = (0.0, 0.015, 0.71, 0.875)
"""Left, bottom, width and height of the scene as fractions of the picture."""
PLAIN = "#dde3ea"
TINTS = ("#cfdff3", "#f7dfc3", "#d3ecd0", "#e8daf2", "#f9d9dc", "#cdecec", "#f2ecc4", "#e0e0e0")
LIGHT = {"ambient": 0.72, "diffuse": 0.52, "specular": 0.0}
"""Pale tints stay what they are in the legend."""
ELEVATION = 36.0
AZIMUTHS = (-60.0, -45.0, -75.0, -30.0, -120.0, -135.0)
MOST_NAMES = 8
OPACITY = (1.0, 0.25)
"""Of magnets and coils: before the first stage, and where they are at the ends of stages."""
LETTERS_IN_A_LINE = 20


def draw_setup(
    model: Model, file: str | os.PathLike[str] | None = None, title: str = "", template: bool = False
) -> Image | None:
    """Draw what will be solved.

    Parameters
    ----------
    model : Model
    file : path, optional
        PNG file to write; None to get the picture instead.
    title : str
        Above the picture.
    template : bool
        The part in the shape in which it was magnetised, with the remanence that it carries there, over the outline of
        the undeformed part.

    Returns
    -------
    PIL.Image.Image or None
        The picture, if no file was named.

    Raises
    ------
    InputError
        A template where the remanence has none.
    RenderingUnavailable
        This machine cannot draw without a screen; the message says what to install.
    OSError
        The disk refuses; the message names the file.
    """
    from matplotlib.figure import Figure

    pixels = (round(DPI * INCHES[0] * SCENE[2]), round(DPI * INCHES[1] * SCENE[3]))
    scene = setup_scene(model, pixels, template)
    figure = Figure(figsize=INCHES, dpi=DPI, facecolor="white")
    axes = figure.add_axes(SCENE)
    axes.set_axis_off()
    axes.imshow(scene.picture, aspect="auto", interpolation="none", extent=(0, 1, 0, 1))
    scene = scene._replace(marks=write_letters(axes, scene.marks, scene.camera))
    corner = figure.add_axes((SCENE[2], 0.0, 1.0 - SCENE[2], 0.2))
    corner.set_axis_off()
    triad(corner, scene.camera.axes)
    _scale_bar(figure, scene.camera)
    figure.text(0.035, 0.94, title, va="center", **(TEXT | {"fontsize": 20}))
    _legend(figure, model.shell, scene, template)
    return deliver(figure, file)


class SetupScene(NamedTuple):
    """The part of the picture that lies in space.

    Attributes
    ----------
    picture : AnyArray, shape (height, width, 4)
        Red, green, blue, opacity.
    camera : Camera
    marks : list of Mark
        What is drawn on the part.
    sources : set of str
        Colours of magnets and coils.
    """

    picture: AnyArray
    camera: Camera
    marks: list[Mark]
    sources: set[str]


def setup_scene(model: Model, pixels: tuple[int, int], template: bool = False, bare: bool = False) -> SetupScene:
    """Draw the part and what is set on it.

    Parameters
    ----------
    model : Model
    pixels : (int, int)
        Width and height.
    template : bool
        As in `draw_setup`.
    bare : bool
        The remanence only.

    Raises
    ------
    InputError, RenderingUnavailable
        As `draw_setup`.
    """
    mesh = model.shell.mesh
    at_nodes = mesh.points[mesh.elements]
    shown = _in_template(model, at_nodes) if template else at_nodes
    extent = np.concatenate([shown.reshape(-1, 3), mesh.points])
    if not (template or model.shell.plain):
        extent = np.concatenate([extent, _hull(model)[1].reshape(-1, 3)])
    axes = _view(extent)
    size = float(np.linalg.norm(np.ptp(extent, axis=0)))
    marks = remanence_marks(model, shown, axes, template)
    if not (template or bare):
        fields = field_marks(model, extent, axes)
        marks += [*fields, *field_turns(model, fields, size), *load_marks(model, size, axes)]
        marks += [*support_marks(model, size, axes), *spring_marks(model, size, axes)]
        marks += [
            *hinge_marks(model, size, axes),
            *repeated_marks(model, size, axes),
            *body_marks(model, size, axes),
            *turn_marks(model, size),
            *source_turns(model, extent, size),
            *probe_marks(model, size, axes),
        ]
    stages = [] if template or bare else [pieces(model.field, now) for now in model.field.ends(len(model.stages))]
    around = [sources_extent(sources, extent) for sources in stages]
    kept = np.concatenate([extent, *around, *(mark.extent for mark in marks)])
    camera = fit(kept, axes, pixels[0] / pixels[1])

    def place(plotter: Any) -> None:
        if template or model.shell.plain:
            _place_body(plotter, model.shell, shown, camera, size, template)
        else:
            _place_hull(plotter, model, camera, size)
        for mark in marks:
            mark.place(plotter)
        for number, sources in enumerate(stages):
            place_sources(
                plotter, sources if number == 0 else _elsewhere(sources, stages[:number]), OPACITY[number > 0]
            )

    return SetupScene(photograph(place, camera, pixels), camera, marks, {one.colour for one in chain(*stages)})


def _elsewhere(sources: list[Piece], before: list[list[Piece]]) -> list[Piece]:
    """Those of a stage's end that are not where they were before."""
    return [
        piece
        for number, piece in enumerate(sources)
        if not any(np.allclose(piece.surface.points, there[number].surface.points, atol=1e-9) for there in before)
    ]


def _in_template(model: Model, at_nodes: FloatArray) -> FloatArray:
    there = in_the_template(model.shell.overall_remanence, model.shell.mesh, at_nodes)
    if there is None:
        raise InputError("remanence: no part of it has a template: nothing was magnetised in another shape")
    return there


def _view(points: FloatArray) -> FloatArray:
    """From the front and above, turned so that the points spread over most of the picture."""

    def spread(axes: FloatArray) -> float:
        return float(np.linalg.det(np.cov((points @ axes[:2].T).T)))

    views = [viewing_axes(azimuth, ELEVATION) for azimuth in AZIMUTHS]
    largest = max(map(spread, views))
    return next(axes for axes in views if spread(axes) >= 0.85 * largest)


def _hull(model: Model) -> tuple[Hull, FloatArray]:
    """The undeformed body, and positions (2, elements, 8, 3) of its bottom and its top face."""
    hull = Hull(model.shell, model.shell.part_of)
    return hull, hull.faces_at_rest(model.rows.normals[model.rows.elements])


def tints(shell: Shell) -> AnyArray:
    """Red, green, blue (elements, 3), 0 to 255: a tint for each region or else element group; the plain one without."""
    from matplotlib.colors import to_rgb

    colours = np.tile(np.array(to_rgb(PLAIN)), (len(shell.mesh.elements), 1))
    for members, tint in _tinted(shell).values():
        colours[members] = to_rgb(tint)
    return np.asarray((255 * colours).round().astype(np.uint8))


def _tinted(shell: Shell) -> dict[str, tuple[AnyArray, str]]:
    """The elements in the tint of a region or group, and the tint; of several groups the last one shows."""
    mesh, parts = shell.mesh, shell.parts
    if len(parts) > 1:
        return {
            f"{name_of(part)}, {thickness_of(part)}": (part.elements, TINTS[k % len(TINTS)])
            for k, part in enumerate(parts)
        }
    if len(mesh.element_groups) < 2:
        return {}
    last = np.full(len(mesh.elements), -1)
    for number, members in enumerate(mesh.element_groups.values()):
        last[members] = number
    names = list(mesh.element_groups)
    seen = enumerate(np.unique(last[last >= 0]))
    return {names[number]: (np.flatnonzero(last == number), TINTS[k % len(TINTS)]) for k, number in seen}


def _place_hull(plotter: Any, model: Model, camera: Camera, size: float) -> None:
    """The body with its true thickness, its edges, steps and borders of regions."""
    import pyvista

    shell = model.shell
    hull, faces = _hull(model)
    placed = hull.between(*faces)
    body = pyvista.PolyData.from_regular_faces(placed.surface.points, placed.surface.triangles)
    body.point_data["colours"] = hull.on_elements(tints(shell))
    body.point_data.active_normals = placed.surface.normals
    plotter.add_mesh(body, scalars="colours", rgb=True, **(SURFACE | LIGHT))
    nearer = 1.5e-3 * size * camera.axes[2]
    thin, thick = ({"lighting": False, "line_width": OVERSAMPLING * width} for width in (0.8, 1.8))
    if len(shell.mesh.elements) <= MOST_ELEMENTS_WITH_EDGES:
        plotter.add_mesh(polylines(placed.inner + nearer), color=INK, opacity=0.22, **thin)
    plotter.add_mesh(polylines(placed.outer + nearer), color=INK, **thick)


def _place_body(plotter: Any, shell: Shell, shown: FloatArray, camera: Camera, size: float, template: bool) -> None:
    """The surface and its element edges; every element has its own nodes, since a template may tear groups apart."""
    import pyvista

    mesh = shell.mesh
    own = own_nodes(mesh.elements)
    cells = Tessellation(own)
    positions = shown.reshape(-1, 3)
    surface = cells.surface(positions)
    body = pyvista.PolyData.from_regular_faces(surface.points, surface.triangles)
    body.point_data["colours"] = cells.on_elements(tints(shell))
    body.point_data.active_normals = surface.normals
    plotter.add_mesh(body, scalars="colours", rgb=True, **(SURFACE | LIGHT))
    nearer = 1.5e-3 * size * camera.axes[2]
    thin, thick = ({"lighting": False, "line_width": OVERSAMPLING * width} for width in (0.8, 1.8))
    sides = own[:, SIDES].reshape(-1, 3)
    real = sides[:, 0] != sides[:, 1]
    outer = real & np.isin(mesh.elements[:, 4:].ravel(), joints_of(shell).outline[:, 2])
    if len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES:
        plotter.add_mesh(polylines(cells.edges(positions + nearer, sides[real])), color=INK, opacity=0.22, **thin)
    plotter.add_mesh(polylines(cells.edges(positions + nearer, sides[outer])), color=INK, **thick)
    if template:
        flat = Tessellation(mesh.elements).edges(mesh.points, joints_of(shell).outline)
        plotter.add_mesh(polylines(flat), color=PALE, **thick)


def _scale_bar(figure: Any, camera: Camera) -> None:
    """A bar of a round length, with it."""
    width = 2.0 * camera.half_width
    longest = 0.11 * width / SCENE[2]
    length = 10.0 ** np.floor(np.log10(longest))
    length *= max(step for step in (1, 2, 5) if step * length <= longest)
    share = SCENE[2] * length / width
    axes = figure.add_axes((0.965 - share, 0.045, share, 0.012))
    axes.set_axis_off()
    axes.plot([0, 1], [0.5, 0.5], color=GREY, linewidth=2.2, solid_capstyle="butt", clip_on=False)
    axes.text(0.5, 1.3, f"{1e3 * length:g} mm", ha="center", va="bottom", fontsize=12, color=GREY)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)


def _legend(figure: Any, shell: Shell, scene: SetupScene, template: bool) -> None:
    from matplotlib.lines import Line2D

    handles, names = [], []
    for mark in scene.marks:
        if mark.name:
            handles.append(
                Line2D(
                    [], [], color=mark.colour, marker=mark.solids.marker, linestyle="none", markersize=mark.solids.size
                )
            )
            names.append(mark.name)
    for name, colour in (("north half of a magnet", NORTH), ("south half", SOUTH), ("coil", COPPER)):
        if colour in scene.sources:
            handles.append(Line2D([], [], color=colour, marker="s", linestyle="none", markersize=11))
            names.append(name)
    groups = _tinted(shell)
    for group, (_, colour) in list(groups.items())[:MOST_NAMES]:
        handles.append(Line2D([], [], color=colour, marker="s", linestyle="none", markersize=11, markeredgecolor=PALE))
        names.append(group)
    if len(groups) > MOST_NAMES:
        handles.append(Line2D([], [], linestyle="none"))
        names.append(f"and {len(groups) - MOST_NAMES} more groups")
    if template:
        handles.append(Line2D([], [], color=PALE, linewidth=1.8))
        names.append("undeformed")
    figure.legend(
        handles,
        [fill(re.sub(r"(?<=\d) (?=[^\W\d])", "\u00a0", name), LETTERS_IN_A_LINE) for name in names],
        loc="center left",
        bbox_to_anchor=(SCENE[2] + 0.005, 0.56),
        frameon=False,
        fontsize=12.5,
        labelcolor=INK,
        labelspacing=0.75,
        handlelength=1.2,
    )
