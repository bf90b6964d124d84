"""A quick picture of a surface with matplotlib alone: no graphics library, no screen, no start-up time.

The surface is cut into small flat triangles, which are painted from the farthest to the nearest (painter's algorithm),
with the element edges among them, a little nearer than they are. Good enough for a notebook; `magshell.output.scene`
draws what goes into a paper.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.output.joints import outline_of
from magshell.output.scene import best_axes
from magshell.output.sources import Piece
from magshell.output.sources import extent as sources_extent
from magshell.output.style import GREY, INK, PALE
from magshell.output.tessellation import Tessellation, element_edges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from magshell.mesh import Mesh

MOST_TRIANGLES = 8000
MOST_ELEMENTS_WITH_EDGES = 2500
LIGHT = np.array([-0.45, 0.7, 0.75]) / np.linalg.norm([-0.45, 0.7, 0.75])
"""Direction to the lamp: right, up, towards the eye."""
TRIAD = 20.0
"""Length of an axis of the triad, points."""


class Lines(NamedTuple):
    """Edges (k, 3) of the mesh (end, end, middle), drawn on the surface."""

    edges: IntArray
    colour: str
    width: float


def tessellate(mesh: Mesh) -> Tessellation:
    """As fine as a small picture needs."""
    return Tessellation(mesh.elements, max(1, min(5, int((0.5 * MOST_TRIANGLES / len(mesh.elements)) ** 0.5))))


def paint(
    axes: Axes,
    mesh: Mesh,
    tessellation: Tessellation,
    displacement: FloatArray,
    colours: FloatArray,
    lines: Sequence[Lines] = (),
    sources: Sequence[Piece] = (),
) -> FloatArray:
    """Paint the deformed surface.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Its frame is taken away.
    mesh : Mesh
    tessellation : Tessellation
    displacement : FloatArray, shape (nodes, 3)
        m. Where it is not zero, the undeformed outline is drawn too.
    colours : FloatArray, shape (points of the tessellation, 3)
        Red, green, blue, 0 to 1.
    lines : sequence of Lines
    sources : sequence of Piece
        Magnets and coils.

    Returns
    -------
    FloatArray, shape (3, 3)
        The view. Rows: to the right, up, towards the eye.
    """
    surface = tessellation.surface(mesh.points + displacement)
    at_rest = tessellation.at_points(mesh.points)
    extent = np.vstack([surface.points, at_rest])
    view, outline = best_axes(extent), outline_of(mesh)
    edges = element_edges(mesh.elements) if len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES else outline
    drawn = [Lines(edges, INK, 0.35), Lines(outline, INK, 0.8), *lines]
    if np.any(displacement):
        _outline(axes, tessellation.edges(mesh.points, outline) @ view.T)
    points, triangles, colours = _with_sources(surface.points, surface.triangles, colours, sources)
    _polygons(axes, points @ view.T, triangles, colours, [
        (tessellation.edges(mesh.points + displacement, one.edges) @ view.T, one.colour, one.width) for one in drawn
    ])  # fmt: skip
    seen = np.vstack([extent, sources_extent(sources, extent)]) @ view[:2].T
    low, high = seen.min(axis=0), seen.max(axis=0)
    margin = 0.03 * float(np.linalg.norm(high - low))
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return view


def triad(axes: Axes, view: FloatArray) -> None:
    """The directions X1, X2, X3 in the lower left corner of the figure."""
    line = {"arrowstyle": "-|>,head_width=0.12,head_length=0.25", "color": GREY, "linewidth": 0.9}
    origin = np.array([16.0, 14.0])
    for i in range(3):
        tip = TRIAD * view[:2, i]
        place: dict[str, Any] = {"xycoords": "figure points", "textcoords": "figure points", "annotation_clip": False}
        axes.annotate("", tuple(origin + tip), tuple(origin), arrowprops={**line, "shrinkA": 0, "shrinkB": 0}, **place)
        beyond = tuple(origin + tip * (1 + 7.0 / max(float(np.linalg.norm(tip)), 7.0)))
        axes.annotate(f"$X_{i + 1}$", beyond, beyond, ha="center", va="center", fontsize=8, color=GREY, **place)


def _with_sources(
    points: FloatArray, triangles: IntArray, colours: FloatArray, sources: Sequence[Piece]
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Points, triangles and colours with those of magnets and coils behind them."""
    from matplotlib.colors import to_rgb

    for piece in sources:
        surface = piece.surface.triangulate()
        corners = np.asarray(surface.faces, dtype=triangles.dtype).reshape(-1, 4)[:, 1:]
        triangles = np.concatenate([triangles, corners + len(points)])
        points = np.concatenate([points, np.asarray(surface.points, dtype=float)])
        colours = np.concatenate([colours, np.tile(to_rgb(piece.colour), (surface.n_points, 1))])
    return points, triangles, colours


def _outline(axes: Axes, curves: FloatArray) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(LineCollection(list(curves[..., :2]), colors=PALE, linewidths=0.9, zorder=1))


def _polygons(
    axes: Axes,
    points: FloatArray,
    triangles: IntArray,
    colours: FloatArray,
    lines: Sequence[tuple[FloatArray, str, float]],
) -> None:
    """All triangles and pieces of lines in one collection, the farthest first; positions are right, up, near."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    shade = 0.74 + 0.26 * np.abs(normals @ LIGHT)
    faces = np.clip(colours[triangles].mean(axis=1) * shade[:, None], 0, 1)
    size = float(np.median(np.ptp(corners, axis=1).max(axis=1)))
    shapes, fills, strokes = [corners], [np.column_stack([faces, np.ones(len(faces))])], [faces]
    widths, nearness = [np.full(len(faces), 0.35)], [corners[..., 2].mean(axis=1)]
    for number, (curves, colour, width) in enumerate(lines, start=1):
        pieces = np.stack([curves[:, :-1], curves[:, 1:], curves[:, 1:]], axis=2).reshape(-1, 3, 3)
        shapes.append(pieces)
        fills.append(np.zeros((len(pieces), 4)))
        strokes.append(np.tile(to_rgb(colour), (len(pieces), 1)))
        widths.append(np.full(len(pieces), width))
        nearness.append(pieces[..., 2].mean(axis=1) + (1.0 + 0.05 * number) * size)
    order: AnyArray = np.argsort(np.concatenate(nearness), kind="stable")
    painted: Any = np.concatenate(shapes)[order][..., :2]
    axes.add_collection(
        PolyCollection(
            painted,
            facecolors=np.concatenate(fills)[order],
            edgecolors=np.concatenate(strokes)[order],
            linewidths=np.concatenate(widths)[order],
            joinstyle="round",
            zorder=2,
        )
    )
