"""How meshes, models, paths and buckling modes show themselves in a notebook: a picture and a small table, as HTML.

Pictures are drawn by `magshell.output.sketch`, in a fraction of a second and without a graphics library. Where
matplotlib cannot be had, the table stands alone.
"""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import UniformField
from magshell.model.parts import Part
from magshell.model.words import name_of, offset_of, thickness_of
from magshell.output.abscissa import abscissa
from magshell.output.curve import curves, dress
from magshell.output.scene import best_axes
from magshell.output.sketch import Lines, paint, tessellate, triad
from magshell.output.sources import Piece, pieces
from magshell.output.sources import extent as sources_extent
from magshell.output.style import ACCENT, COLOURS, GREY, INK, compact_png
from magshell.units import FLUX_DENSITY, LENGTH, STRESS, show

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from magshell.mesh import Mesh
    from magshell.model.model import Model
    from magshell.solver.buckling import Buckling, BucklingMode
    from magshell.solver.path import Path

Rows = Sequence[tuple[str, str]]

DPI = 110
MODULI = ("shear_modulus", "lame_lambda", "coupling_modulus")
PLAIN = "#d3dbe6"
MOST_NAMES = 12
MOST_ARROWS = 90
MOST_MODES = 4
MODE_SIZE = 0.2
"""Largest displacement of a mode in its picture, in sizes of the body."""


NOTHING = 1e-9
"""Displacement, in sizes of the body, that is round-off."""


def mesh_html(mesh: Mesh) -> str:
    """The undeformed mesh with its groups in colours; elements, nodes, extent and groups."""
    return _page("Mesh", _picture(lambda: _mesh_figure(mesh)), _mesh_rows(mesh))


def model_html(model: Model, title: str = "Model", doubts: Sequence[str] | None = None) -> str:
    """The mesh with its groups, the remanence as arrows and the field; what it is made of, and its doubts."""
    said = model.doubts() if doubts is None else doubts
    return _page(title, _picture(lambda: _mesh_figure(model.shell.mesh, model)), _model_rows(model), said)


def path_html(path: Path) -> str:
    """The last shape beside the curves of the probes; whether the path converged, and what it reached."""
    picture = _picture(lambda: _path_figure(path)) if path.steps else ""
    return _page("Path", picture, _path_rows(path))


def buckling_html(buckling: Buckling) -> str:
    """The first modes; load factor and field of each, and doubts about them."""
    picture = _picture(lambda: _modes_figure(buckling)) if buckling.modes else ""
    rows = [(f"mode {mode.number}", _multiplier(mode)) for mode in buckling.modes]
    return _page("Buckling", picture, rows, buckling.doubts)


def _page(title: str, picture: str, rows: Rows, doubts: Sequence[str] = ()) -> str:
    cell = 'style="text-align: left; vertical-align: top; padding: 1px 14px 1px 0"'
    lines = [
        f'<tr><td {cell}><span style="opacity: 0.65">{html.escape(label)}</span></td>'
        f"<td {cell}>{html.escape(text)}</td></tr>"
        for label, text in rows
    ]
    notes = "".join(f'<div style="color: {ACCENT}">{html.escape(doubt)}</div>' for doubt in doubts)
    heading = f'<div style="font-weight: 600; margin-bottom: 2px">{html.escape(title)}</div>'
    table = f'<table style="border: none; font-size: 90%; margin: 4px 0">{"".join(lines)}</table>'
    return f'<div class="magshell">{heading}{picture}{table}{notes}</div>'


def _picture(draw: Callable[[], Figure]) -> str:
    """The figure as an element of a page; nothing where matplotlib is missing or cannot work."""
    try:
        content = compact_png(draw())
    except (ImportError, OSError):
        return ""
    source = base64.b64encode(content).decode("ascii")
    style = "max-width: 100%; background: white; border-radius: 6px; display: block"
    return f'<img alt="" style="{style}" src="data:image/png;base64,{source}">'


def _mesh_rows(mesh: Mesh) -> list[tuple[str, str]]:
    extent = " × ".join(show(float(length), LENGTH) for length in np.ptp(mesh.points, axis=0))
    rows = [("elements, nodes", f"{len(mesh.elements)}, {len(mesh.points)}"), ("extent", extent)]
    if len(mesh.parts) > 1:
        rows.append(("separate parts", str(len(mesh.parts))))
    kinds = (("elements", mesh.element_groups), ("edges", mesh.edge_groups), ("nodes", mesh.node_groups))
    for kind, groups in kinds:
        if groups:
            named = [f"{name} ({len(members)})" for name, members in groups.items()]
            rows.append((f"groups of {kind}", _listed(named)))
    return rows


def _model_rows(model: Model) -> list[tuple[str, str]]:
    shell, mesh = model.shell, model.shell.mesh
    stretch = "" if shell.thickness_stretch == "linear" else f", thickness stretch {shell.thickness_stretch}"
    rows = [
        ("elements, nodes", f"{len(mesh.elements)}, {len(mesh.points)}"),
        *_make_rows(shell.parts, f"element {shell.element.name}{stretch}"),
    ]
    strength = np.linalg.norm(_remanence(model), axis=1)
    if strength.any():
        rows.append(("remanence", _range(strength)))
    if model.field_magnitude:
        field = "varies in space"
        if isinstance(model.field, UniformField):
            components = (show(float(value), FLUX_DENSITY) if value else "0" for value in model.field.vector)
            field = f"({', '.join(components)})"
        rows.append(("field", f"{field}, {type(model.coupling).__name__}"))
    if model.loads:
        rows.append(("loads", _listed([f"{load.kind} on {load.group or 'whole shell'}" for load in model.loads])))
    if model.supports:
        rows.append(("supports", _listed([f"{type(one).__name__} on {one.group}" for one in model.supports])))
    if model.springs:
        rows.append(("springs", _listed([f"{one.legend} on {one.group}" for one in model.springs])))
    if model.shell.rigid:
        rows.append(("rigid bodies", _listed([one.name for one in model.shell.rigid])))
    if model.shell.hinges:
        rows.append(("hinges", _listed([one.group for one in model.shell.hinges])))
    if len(model.stages) > 1:
        rows.append(("stages", ", ".join(stage.name or stage.control for stage in model.stages)))
    if model.probes:
        rows.append(("probes", _listed(list(model.probes))))
    return rows


def _make_rows(parts: Sequence[Part], element: str) -> list[tuple[str, str]]:
    """Thickness and material; of several parts and layers those of each."""
    if len(parts) == 1 and not parts[0].layered:
        part = parts[0]
        return [
            ("shell", f"thickness {thickness_of(part)}{offset_of(part)}, {element}"),
            ("material", _material(part.layers[0].material)),
        ]
    rows = [("shell", f"{element}{offset_of(parts[0]) if len(parts) == 1 else ''}")]
    for part in parts[:MOST_NAMES]:
        layers = [f"{thickness_of(part, k)} of {_material(layer.material)}" for k, layer in enumerate(part.layers)]
        elements = f"{len(part.elements)} elements{offset_of(part)}: " if len(parts) > 1 else ""
        rows.append((name_of(part) if len(parts) > 1 else "layers", elements + "; ".join(layers)))
    if len(parts) > MOST_NAMES:
        rows.append(("and", f"{len(parts) - MOST_NAMES} more regions"))
    return rows


def _material(material: Any) -> str:
    parameters = ", ".join(f"{name} {_parameter(name, value)}" for name, value in material._asdict().items())
    return f"{type(material).__name__}, {parameters}"


def _parameter(name: str, value: float) -> str:
    dimension = LENGTH if name == "length_scale" else STRESS if name in MODULI else None
    return show(value, dimension) if dimension and value else f"{value:g}"


def _range(strength: FloatArray) -> str:
    least, greatest = float(strength.min()), float(strength.max())
    if greatest - least <= 1e-9 * greatest:
        return show(greatest, FLUX_DENSITY)
    return f"{show(least, FLUX_DENSITY)} to {show(greatest, FLUX_DENSITY)}"


def _path_rows(path: Path) -> list[tuple[str, str]]:
    rows = [("converged", "yes" if path.converged else f"no: {path.reason}")]
    if not path.steps:
        return rows
    last, solves = path.steps[-1], f"{path.solves} linear solves, {path.cuts} cuts, {path.cpu_seconds:.1f} s of CPU"
    rows.append(("steps", f"{len(path.steps) - 1}: {solves}"))
    reached = f"load factor {last.load_factor:.4g}"
    if len(path.model.stages) > 1:
        reached += f" of stage {last.stage + 1} of {len(path.model.stages)}"
    if path.model.field_magnitude:
        reached += f", |B| = {show(float(np.linalg.norm(last.flux_density)), FLUX_DENSITY)}"
    rows.append(("reached", reached + (", an unstable state" if last.negative_pivots else "")))
    if path.critical_points:
        points = [f"{point.kind} at load factor {point.load_factor:.4g}" for point in path.critical_points]
        rows.append(("critical points", _listed(points)))
    rows.append(("unknowns", f"{path.discretisation.dofs}, {path.solver_name}"))
    noise = NOTHING * path.model.shell.mesh.size
    for name, node in list(path.model.probe_nodes.items())[:MOST_NAMES]:
        u = ", ".join(f"{1e3 * value:.4g}" if abs(value) > noise else "0" for value in last.state.u[node])
        rows.append((f"u of {name}", f"({u}) mm"))
    return rows


def _multiplier(mode: BucklingMode) -> str:
    text = f"load factor {mode.load_factor:.5g}"
    size = float(np.linalg.norm(mode.flux_density))
    return f"{text}, |B| = {show(size, FLUX_DENSITY)}" if size else text


def _listed(names: Sequence[str]) -> str:
    more = f", and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def _remanence(model: Model) -> FloatArray:
    """At the middle of each element (elements, 3)."""
    mesh = model.shell.mesh
    return np.asarray(model.shell.overall_remanence(mesh, _middles(mesh)[:, None]))[:, 0]


def _middles(mesh: Mesh) -> FloatArray:
    x = mesh.points[mesh.elements]
    return np.asarray(0.5 * x[:, 4:].sum(axis=1) - 0.25 * x[:, :4].sum(axis=1))


def _mesh_figure(mesh: Mesh, model: Model | None = None) -> Figure:
    from matplotlib.colors import to_rgb

    tessellation = tessellate(mesh)
    colours = np.tile(to_rgb(PLAIN), (len(mesh.elements), 1))
    palette = iter(_palette())
    handles = []
    for name, elements in list(mesh.element_groups.items())[:MOST_NAMES]:
        colours[elements] = 0.42 * np.array(to_rgb(next(palette))) + 0.58
        handles.append(_handle(name, colours[elements[0]], "s"))
    lines = []
    for name, edges in list(mesh.edge_groups.items())[:MOST_NAMES]:
        lines.append(Lines(edges, next(palette), 2.6))
        handles.append(_handle(name, lines[-1].colour, "-"))
    nodes = [(name, members, next(palette)) for name, members in list(mesh.node_groups.items())[:MOST_NAMES]]
    handles += [_handle(name, colour, "o") for name, _, colour in nodes]

    sources = pieces(model.field, model.field.ends(len(model.stages))[0]) if model is not None else []
    still = np.zeros_like(mesh.points)
    figure, axes = _figure(mesh, sources, legend=bool(handles))
    view = paint(axes, mesh, tessellation, still, tessellation.on_elements(colours), lines, sources)
    for _, members, colour in nodes:
        dots = mesh.points[members] @ view[:2].T
        axes.plot(dots[:, 0], dots[:, 1], "o", color=colour, markersize=4.5, markeredgecolor="white", zorder=4)
    if model is not None:
        handles += _magnetism(axes, model, view)
    triad(axes, view)
    if handles:
        figure.legend(handles=handles, loc="outside right center", frameon=False, fontsize=8.5, labelcolor=INK)
    return figure


def _palette() -> Iterable[str]:
    while True:
        yield from (COLOURS[0], *COLOURS[2:7])


def _handle(name: str, colour: Any, mark: str) -> Any:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    name = name.replace("$", r"\$")
    if mark == "s":
        return Patch(facecolor=colour, edgecolor=GREY, linewidth=0.5, label=name)
    if mark == "-":
        return Line2D([], [], color=colour, linewidth=2.6, label=name)
    return Line2D([], [], color=colour, marker=mark, linestyle="none", markersize=5, label=name)


def _magnetism(axes: Axes, model: Model, view: FloatArray) -> list[Any]:
    """Arrows of the remanence on the body and of the field above it; their entries in the legend."""
    mesh, handles = model.shell.mesh, []
    remanence, middles = _remanence(model), _middles(mesh)
    strongest = float(np.linalg.norm(remanence, axis=1).max())
    arrow: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "units": "dots", "pivot": "mid"}
    arrow |= {"headwidth": 3.6, "headlength": 4.2, "headaxislength": 3.8, "zorder": 5}
    if strongest > 0:
        carrying = np.flatnonzero(remanence.any(axis=1))
        chosen = carrying[np.unique(np.linspace(0, len(carrying) - 1, MOST_ARROWS).astype(int))]
        x = mesh.points[mesh.elements]
        elements = np.sqrt(np.linalg.norm(np.cross(x[:, 5] - x[:, 7], x[:, 6] - x[:, 4]), axis=1))
        length = 0.72 * float(np.median(elements)) * (len(carrying) / len(chosen)) ** 0.5
        feet, parts = middles[chosen] @ view[:2].T, length * (remanence[chosen] / strongest) @ view[:2].T
        axes.quiver(*feet.T, *parts.T, color=INK, width=1.5, **arrow)
        handles.append(_handle("remanence", INK, r"$\rightarrow$"))
    if isinstance(model.field, UniformField) and model.field_magnitude > 0:
        direction = model.field.vector / model.field_magnitude @ view[:2].T
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        length = 0.14 * max(right - left, high - low)
        if np.linalg.norm(direction) > 0.05:
            foot = np.array([left - 0.35 * length - 0.5 * abs(length * direction[0]), 0.5 * (low + high)])
            axes.quiver(*foot, *(length * direction), color=ACCENT, width=3.0, **arrow)
            axes.set_xlim(foot[0] - 0.5 * length * abs(direction[0]) - 0.25 * length, right)
            reach = 0.55 * length * abs(direction[1])
            axes.set_ylim(min(low, foot[1] - reach), max(high, foot[1] + reach))
        handles.append(_handle("field", ACCENT, r"$\rightarrow$"))
    return handles


def _figure(mesh: Mesh, sources: Sequence[Piece], legend: bool) -> tuple[Figure, Axes]:
    """A figure for one body, as high as its view asks for."""
    from matplotlib.figure import Figure

    figure = Figure(
        figsize=(7.0 if legend else 5.6, _height(mesh, np.zeros_like(mesh.points), 5.2, sources)),
        dpi=DPI,
        facecolor="white",
    )
    figure.set_layout_engine("constrained")
    return figure, figure.subplots()


def _height(mesh: Mesh, displacement: FloatArray, width: float, sources: Sequence[Piece] = ()) -> float:
    """Inches for a picture of this width, within what fits a page."""
    extent = np.vstack([mesh.points, mesh.points + displacement])
    spread = np.ptp(np.vstack([extent, sources_extent(sources, extent)]) @ best_axes(extent)[:2].T, axis=0)
    return float(np.clip(width * spread[1] / max(spread[0], 1e-30) + 0.35, 1.9, 4.2))


def _path_figure(path: Path) -> Figure:
    from matplotlib.figure import Figure

    mesh, last = path.model.shell.mesh, path.steps[-1]
    with_curve = len(path.steps) > 1
    moved, sources = last.state.displacement(len(mesh.points)), pieces(path.model.field, last.drives)
    height = max(_height(mesh, moved, 4.2, sources), 3.0)
    figure = Figure(figsize=(9.4 if with_curve else 5.6, height), dpi=DPI, facecolor="white")
    figure.set_layout_engine("constrained", wspace=0.06)
    if with_curve:
        body, chart = figure.subplots(1, 2, width_ratios=(1.1, 1.0))
        _chart(chart, path)
    else:
        body = figure.subplots()
    size = 1e3 * np.linalg.norm(moved, axis=1)
    tessellation = tessellate(mesh)
    scale, view = _paint_size(body, mesh, moved, tessellation.at_points(size), sources)
    triad(body, view)
    bar = figure.colorbar(
        scale,
        ax=body, location="bottom", shrink=0.62, aspect=28, pad=0.02,
    )  # fmt: skip
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=8, colors=GREY)
    bar.set_label("$|u|$ (mm)", fontsize=9, color=INK)
    return figure


def _paint_size(
    axes: Axes, mesh: Mesh, displacement: FloatArray, values: FloatArray, sources: Sequence[Piece] = ()
) -> tuple[Any, FloatArray]:
    """The deformed body coloured by values at the points of the tessellation; the scale of the colours and the view."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    largest = max(float(values.max()), NOTHING * 1e3 * mesh.size)
    scale = ScalarMappable(Normalize(0.0, largest), colormaps["viridis"])
    view = paint(axes, mesh, tessellate(mesh), displacement, np.asarray(scale.to_rgba(values))[:, :3], (), sources)
    return scale, view


def _chart(axes: Axes, path: Path) -> None:
    along = abscissa(path)
    x = along.of(path.steps)
    unstable = np.array([bool(step.negative_pivots) for step in path.steps])
    drawn = curves(path)[:MOST_NAMES]
    for label, values, style in drawn:
        small = {**style, "linewidth": 1.4}
        axes.plot(x, 1e3 * values, label=label, markersize=3.6, markeredgecolor="white", markeredgewidth=0.4, **small)
        hollow = {"linestyle": "none", "marker": style["marker"], "color": style["color"], "markersize": 3.6}
        axes.plot(x[unstable], 1e3 * values[unstable], markerfacecolor="white", **hollow)
    axes.axhline(0, color="#9aa3ad", linewidth=0.7, zorder=1)
    dress(axes)
    axes.tick_params(labelsize=8)
    axes.spines["top"].set_visible(False)
    axes.set_xlabel(along.label, fontsize=9, color=INK)
    axes.set_ylabel("displacement (mm)", fontsize=9, color=INK)
    axes.legend(frameon=False, fontsize=8, labelcolor=INK, ncols=2 if len(drawn) > 5 else 1)


def _modes_figure(buckling: Buckling) -> Figure:
    from matplotlib.figure import Figure

    mesh = buckling.path.model.shell.mesh
    modes = buckling.modes[:MOST_MODES]
    moved = [(mode.state.u + MODE_SIZE * mesh.size * mode.mode[:, :3])[: len(mesh.points)] for mode in modes]
    height = max(_height(mesh, displacement, 9.4 / max(len(modes), 2)) for displacement in moved)
    figure = Figure(figsize=(max(2.35 * len(modes), 4.7), height + 0.2), dpi=DPI, facecolor="white")
    figure.set_layout_engine("constrained")
    tessellation = tessellate(mesh)
    for axes, mode, displacement in zip(figure.subplots(1, len(modes), squeeze=False)[0], modes, moved, strict=True):
        size = np.linalg.norm(mode.mode[:, :3], axis=1)
        _paint_size(axes, mesh, displacement, tessellation.at_points(size))
        axes.set_title(f"mode {mode.number}", fontsize=9, color=INK)
    return figure
