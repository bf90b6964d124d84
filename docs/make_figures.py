"""Solve the built-in problems, draw `docs/images/*.png`, and write the accuracy tables of README.md and accuracy.md.

    python docs/make_figures.py            about three minutes after the kernels are compiled

Every number in the tables is computed here; what they are compared with is quoted from its source below.
"""

from __future__ import annotations

import io
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from bodies import Body, Copy, cameras_for, mirrored, render, step_at, turned
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from PIL import Image
from scipy.interpolate import PchipInterpolator

import magshell as ms
from magshell import problem
from magshell.output.files import write_atomically
from magshell.output.style import ACCENT, COLOURS, TEXT, TICKS

DOCS = pathlib.Path(__file__).parent
IMAGES = DOCS / "images"
DPI = 120
Paths = Mapping[str, ms.Path]
PALETTE = ListedColormap(colormaps["viridis"](np.linspace(0.16, 1.0, 512)))
"""Without the darkest end, so that edges are seen everywhere."""

STRIPS = {"strip-10": 10, "strip-17": 17.5, "strip-20": 20.5, "strip-41": 41}
"""Length over thickness."""

MEASURED = [
    (1.856, 0.3161), (2.785, 0.4151), (3.753, 0.5142), (4.641, 0.5922), (5.650, 0.6182), (6.578, 0.6782),
    (9.443, 0.7553), (14.12, 0.8334), (18.85, 0.8535), (23.57, 0.8816), (37.77, 0.8858), (47.18, 0.8990),
]  # fmt: skip
"""Strip of aspect ratio 20.5: field (mT), tip deflection over length; Zhao et al., J. Mech. Phys. Solids 124, 2019."""


class Quoted(NamedTuple):
    """A displacement that the paper quotes: where, and how large (mm)."""

    problem: str
    what: str
    probe: str
    component: int
    field: float
    value: float


QUOTED = [
    Quoted("thin-cross", "$u_3$ at A, tip of an arm, 40 mT", "A", 3, 40.0, 22.78),
    Quoted("h-shape", "$u_3$ at A, middle of the bar, 50 mT", "A", 3, 50.0, 24.65),
    Quoted("h-shape", "the same at the bar's edge", "A'", 3, 50.0, 24.65),
    Quoted("hollow-cross", "$u_3$ at C, outer corner, 200 mT", "C", 3, 200.0, 10.39),
    Quoted("pump", "$\\lvert u_1\\rvert$ at B, side of the tube, 150 mT", "B", 1, 150.0, 16.75),
    Quoted("gripper", "$u_3$ at B, equator of the arm, 6.8 mT", "B", 3, 6.8, 41.6),
    Quoted("gripper", "the same, 10 mT", "B", 3, 10.0, 43.9),
]


def main() -> None:
    """Solve, draw, write."""
    IMAGES.mkdir(exist_ok=True)
    paths = {name: solved(name) for name in problem.names()}
    tables = {
        "accuracy": accuracy_table(paths),
        "strips": strip_table(paths),
        "effort": effort_table(paths),
        "meshes": mesh_table(paths["gripper"]),
    }
    print("\n\n".join(tables.values()))
    write_tables(DOCS.parent / "README.md", {"accuracy": tables["accuracy"]})
    write_tables(DOCS / "accuracy.md", tables)
    draw_gripper(paths["gripper"])
    across = {"azimuth": -60.0, "elevation": 24.0}
    draw_problem(paths["thin-cross"], "thin-cross", mirrored(0, 1), (2, 5, 10, 40), ("A", "C"), 3, **across)
    draw_problem(paths["h-shape"], "h-shape", mirrored(0, 1), (2, 5, 15, 50), ("A", "C"), 3, **across)
    draw_problem(paths["hollow-cross"], "hollow-cross", mirrored(0, 1), (10, 50, 100, 200), ("C", "E"), 3, **across)
    draw_problem(paths["pump"], "pump", mirrored(0, 1), (20, 50, 100, 150), ("B", "C"), 1, -50.0, 28.0)
    draw_strips(paths)


def solved(name: str) -> ms.Path:
    """The whole load path of a built-in problem."""
    loaded = problem.load(name)
    print(f"{name} ...", flush=True)
    return ms.solve(loaded.model, loaded.settings)


# -- tables ----------------------------------------------------------------------------------------------------------


def displacement(path: ms.Path, probe: str, component: int, field: float) -> float:
    """Component (1, 2, 3) of a probe's displacement at a field in mT, mm."""
    return 1e3 * float(step_at(path, 1e-3 * field).state.u[path.model.probe_nodes[probe], component - 1])


def length_of(strip: ms.Path) -> float:
    """Extent along X1, m."""
    return float(np.ptp(strip.model.shell.mesh.points[:, 0]))


def accuracy_table(paths: Paths) -> str:
    """What the paper quotes, and what comes out here."""
    rows = ["| Problem | Displacement | Paper (mm) | magshell (mm) | Difference |", "|---|---|---:|---:|---:|"]
    for entry in QUOTED:
        ours = abs(displacement(paths[entry.problem], entry.probe, entry.component, entry.field))
        difference = 100.0 * (ours / entry.value - 1.0)
        rows.append(f"| `{entry.problem}` | {entry.what} | {entry.value:g} | {ours:.2f} | {difference:+.1f} % |")
    return "\n".join(rows)


def strip_table(paths: Paths) -> str:
    """Tip deflection over length of the four strips, and the experiment where it was made."""
    fields = (2.0, 5.0, 10.0, 20.0, 50.0)
    rows = [f"| Strip | {' | '.join(f'{field:g} mT' for field in fields)} |", "|---|" + "---:|" * len(fields)]
    for name, ratio in STRIPS.items():
        length = length_of(paths[name])
        values = (1e-3 * displacement(paths[name], "tip", 3, field) / length for field in fields)
        rows.append(f"| `{name}`, aspect ratio {ratio:g} | {' | '.join(f'{value:.4f}' for value in values)} |")
    tip, (at, measured) = paths["strip-20"].probe("tip"), np.transpose(MEASURED)
    curve = PchipInterpolator(1e3 * tip.flux_density[:, 2], tip.u3 / length_of(paths["strip-20"]))
    off = 100.0 * (curve(at) / measured - 1.0)
    rows += ["", f"From the measured points the computed curve is off by {off.min():+.1f} to {off.max():+.1f} %."]
    return "\n".join(rows)


def effort_table(paths: Paths) -> str:
    """Size and effort of every problem."""
    rows = [
        "| Problem | Elements | Unknowns | Steps | Linear solves | Cuts | CPU (s) | Force balance | Moment balance |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, path in paths.items():
        s = path.summary
        rows.append(
            f"| `{name}` | {s['elements']} | {s['dofs']} | {s['steps']} | {s['iterations']} | {s['cuts']} "
            f"| {s['cpu_seconds']:.1f} | {s['force_imbalance']:.0e} | {s['moment_imbalance']:.0e} |"
        )
    return "\n".join(rows)


def mesh_table(gripper: ms.Path) -> str:
    """The gripper's equator point on a coarser and a finer mesh."""
    fields = (0.02, 1.0, 10.0)
    shell, radius = gripper.model.shell, float(np.linalg.norm(gripper.model.shell.mesh.points[0]))
    field = ms.UniformField(gripper.model.field.vector, stops=[1e-3 * each for each in fields])
    rows = ["| Mesh | Unknowns | 0.02 mT | 1 mT | 10 mT |", "|---|---:|---:|---:|---:|"]
    for along, around in ((15, 4), (30, 6), (60, 12)):
        mesh = ms.mesh.sphere_patch(radius, (15, 165), (-15, 15), (along, around))
        arm = ms.Shell(mesh, shell.thickness, shell.material, shell.remanence)
        path = ms.solve(ms.Model(arm, [ms.Clamp("top")], field, probes={"B": (radius, 0, 0)}))
        values = (f"{displacement(path, 'B', 3, each):#.4g}" for each in fields)
        rows.append(f"| {along} × {around} | {path.discretisation.dofs} | {' | '.join(values)} |")
    return "\n".join(rows)


def write_tables(file: pathlib.Path, tables: Mapping[str, str]) -> None:
    """Put every table between its marks."""
    text = file.read_text(encoding="utf-8")
    for name, table in tables.items():
        begin, end = f"<!-- {name}: docs/make_figures.py -->", f"<!-- end of {name} -->"
        before, rest = text.split(begin)
        text = f"{before}{begin}\n{table}\n{end}{rest.split(end)[1]}"
    write_atomically(file, text.encode())


# -- pictures --------------------------------------------------------------------------------------------------------


def save(figure: Figure, name: str) -> None:
    """Write a PNG without the opacity channel, which nobody needs and which makes it larger."""
    content = io.BytesIO()
    figure.savefig(content, format="png", facecolor="white")
    picture = Image.open(content).convert("RGB")
    content = io.BytesIO()
    picture.save(content, format="png", optimize=True)
    write_atomically(IMAGES / f"{name}.png", content.getvalue())
    print(f"{name}.png: {len(content.getvalue()) // 1000} kB", flush=True)


def colours(bodies: Sequence[Body], component: int) -> ScalarMappable:
    """One scale, mm, for the size of the displacement component of all bodies (copies may flip its sign)."""
    largest = max(float(np.abs(body.step.state.u[:, component - 1]).max()) for body in bodies)
    return ScalarMappable(Normalize(0.0, 1e3 * largest), PALETTE)


def shade(scale: ScalarMappable) -> Callable[[np.ndarray], np.ndarray]:
    """From displacements in m to red, green, blue."""
    return lambda values: scale.to_rgba(1e3 * np.abs(values), bytes=True)[:, :3]


def colour_bar(figure: Figure, place: tuple[float, float, float, float], scale: ScalarMappable, title: str) -> None:
    """A bar without a frame, its quantity above."""
    bar = figure.colorbar(scale, cax=figure.add_axes(place))
    bar.outline.set_visible(False)
    bar.ax.tick_params(**TICKS)
    bar.ax.set_title(title, loc="left", pad=12, **TEXT)


def panel(figure: Figure, place: tuple[float, float, float, float], picture: np.ndarray, title: str) -> None:
    """A rendered picture with its title below."""
    axes = figure.add_axes(place)
    axes.set_axis_off()
    axes.imshow(picture, aspect="auto", interpolation="none", extent=(0, 1, 0, 1))
    axes.text(0.5, -0.03, title, ha="center", va="top", transform=axes.transAxes, **TEXT)


def field_arrow(figure: Figure, x: float, y: float, direction: np.ndarray, points: float = 56.0) -> None:
    """Arrow of the external field about (x, y), fractions of the figure; direction (2,) on the picture."""
    middle = np.array([x, y]) * figure.get_size_inches() * 72.0
    tail, head = middle - 0.5 * points * direction, middle + 0.5 * points * direction
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    arrow = {"arrowstyle": "-|>,head_width=0.28,head_length=0.55", "color": ACCENT, "linewidth": 2.6}
    arrow |= {"shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, "figure points", "figure points", arrowprops=arrow)
    beyond = head + 15.0 * direction
    axes.annotate(
        r"$B^\mathrm{ext}$", beyond, xycoords="figure points", ha="center", va="center", color=ACCENT, fontsize=16
    )


def draw_gripper(path: ms.Path) -> None:
    """The whole gripper, twelve arms, as the field grows."""
    fields = (0.0, 1.0, 2.0, 4.0, 6.8)
    bodies = [Body(path, step_at(path, 1e-3 * field), turned(12), "u3") for field in fields]
    scale = colours(bodies, 3)
    cameras = cameras_for([[body] for body in bodies], -90.0, 20.0)
    left, right, below, above, width = 0.06, 0.9, 0.12, 0.98, 12.0
    spread = sum(camera.half_width for camera in cameras)
    height = (right - left) * width * cameras[0].half_height / spread / (above - below)
    figure = Figure(figsize=(width, height), dpi=160)
    at = left
    for body, camera, field in zip(bodies, cameras, fields, strict=True):
        share = (right - left) * camera.half_width / spread
        pixels = (round(share * width * figure.dpi), round((above - below) * height * figure.dpi))
        title = f"{field:g} mT" if field else "no field"
        panel(figure, (at, below, share, above - below), render([body], camera, shade(scale), pixels), title)
        at += share
    field_arrow(figure, 0.03, 0.5, np.array([0.0, 1.0]))
    colour_bar(figure, (0.912, 0.2, 0.012, 0.55), scale, "$|u_3|$ (mm)")
    save(figure, "gripper")


def draw_problem(
    path: ms.Path,
    name: str,
    copies: Sequence[Copy],
    fields: Sequence[float],
    probes: Sequence[str],
    component: int,
    azimuth: float,
    elevation: float,
) -> None:
    """Curves of some probes on the left, four shapes of the whole body on the right."""
    groups = [[Body(path, step_at(path, 1e-3 * field), copies, f"u{component}")] for field in fields]
    figure, axes = four_shapes(groups, [f"{field:g} mT" for field in fields], component, azimuth, elevation)
    sign = np.sign(path.probe(probes[0]).u[-1, component - 1])
    for number, probe in enumerate(probes):
        u = path.probe(probe)
        field = 1e3 * np.linalg.norm(u.flux_density, axis=1)
        axes.plot(field, sign * 1e3 * u.u[:, component - 1], label=probe, color=COLOURS[number], **LINE)
    for entry in QUOTED:
        if entry.problem == name and entry.probe in probes:
            axes.plot(entry.field, entry.value, **MARK, label=f"{entry.probe}, paper")
    axes.set_ylabel(f"${'-' if sign < 0.0 else ''}u_{component}$ (mm)", **TEXT)
    axes.legend(frameon=False, fontsize=14)
    save(figure, name)


LINE = {"linewidth": 2.0, "marker": "o", "markersize": 4.5, "markeredgecolor": "white", "markeredgewidth": 0.5}
MARK = {"linestyle": "none", "marker": "D", "markersize": 8, "color": "none", "markeredgecolor": "#1a1f26"}


def draw_strips(paths: Paths) -> None:
    """The four strips side by side, and their tip deflection with the experiment."""
    fields = (2.0, 5.0, 15.0, 50.0)
    groups = [
        [
            Body(paths[name], step_at(paths[name], 1e-3 * field), [Copy(np.eye(3), (0.0, 8e-3 * number, 0.0))], "u3")
            for number, name in enumerate(STRIPS)
        ]
        for field in fields
    ]
    figure, axes = four_shapes(groups, [f"{field:g} mT" for field in fields], 3, -35.0, 22.0)
    for number, (name, ratio) in enumerate(STRIPS.items()):
        tip = paths[name].probe("tip")
        x, y = 1e3 * tip.flux_density[:, 2], tip.u3 / length_of(paths[name])
        axes.plot(x, y, label=f"{ratio:g}", color=COLOURS[number], **LINE)
    axes.plot(*np.transpose(MEASURED), label="20.5, measured", **MARK)
    axes.set_ylabel("$u_3/L$ at the tip", **TEXT)
    axes.legend(frameon=False, fontsize=13, title="length / thickness", title_fontsize=13)
    save(figure, "strips")


def four_shapes(
    groups: Sequence[Sequence[Body]], titles: Sequence[str], component: int, azimuth: float, elevation: float
) -> tuple[Figure, object]:
    """A figure with room for curves on the left, and four shapes in one scale on the right."""
    figure = Figure(figsize=(15.0, 6.6), dpi=DPI)
    axes = figure.add_axes((0.06, 0.13, 0.3, 0.82))
    axes.set_xlabel(r"$|B^\mathrm{ext}|$ (mT)", **TEXT)
    axes.grid(color="#e5e7eb", linewidth=0.8)
    axes.spines[["right", "top"]].set_visible(False)
    axes.tick_params(**TICKS)
    axes.margins(x=0.02)
    scale = colours([body for group in groups for body in group], component)
    cameras = cameras_for(groups, azimuth, elevation)
    share, tall = 0.25, 0.41
    wide = max(
        max(camera.half_width for camera in cameras),
        cameras[0].half_height * share * 15.0 / (tall * 6.6),
    )
    for number, (group, camera, title) in enumerate(zip(groups, cameras, titles, strict=True)):
        x, y = 0.41 + share * (number % 2), 0.57 - 0.5 * (number // 2)
        pixels = (round(share * 15.0 * DPI), round(tall * 6.6 * DPI))
        shown = type(camera)(camera.centre, camera.axes, wide, wide * pixels[1] / pixels[0])
        panel(figure, (x, y, share, tall), render(group, shown, shade(scale), pixels), title)
    field = groups[0][0].path.model.field.vector
    direction = cameras[0].axes[:2] @ (field / np.linalg.norm(field))
    field_arrow(figure, 0.395, 0.5, direction)
    colour_bar(figure, (0.925, 0.2, 0.011, 0.6), scale, f"$|u_{component}|$ (mm)")
    return figure, axes


if __name__ == "__main__":
    main()
