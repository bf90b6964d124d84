"""Mesh the flower of `docs/meshes.md`, draw it, and put what was measured into the page. Needs the extra `gmsh`.

python docs/make_mesh_figure.py       ten seconds
"""

from __future__ import annotations

import io
import pathlib
import tempfile
import time
from collections.abc import Callable
from contextlib import redirect_stdout

import numpy as np
from blocks import write_blocks
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

import magshell as ms
from magshell.arrays import FloatArray, IntArray
from magshell.cli import main
from magshell.mesh import Mesh
from magshell.mesh.edges import SIDES
from magshell.mesh.files.cad import ATTEMPTS, Attempt, Candidate, meshed, open_geometry, set_size
from magshell.mesh.files.raising import raise_order
from magshell.mesh.files.session import session
from magshell.mesh.quality import worst
from magshell.output.style import ACCENT, COLOURS, DPI, GREY, INK, deliver

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_mesh_figure.py"
FLOWER = DOCS / "meshes" / "flower.geo"
SIZE = 0.8e-3
SHOWN = (ATTEMPTS[1], ATTEMPTS[2])
NAMES = {
    ATTEMPTS[0]: "frontal Delaunay (6), full-quad blossom (3)",
    ATTEMPTS[1]: "quasi-structured (11)",
    ATTEMPTS[2]: "frontal Delaunay (6), blossom (1)",
    ATTEMPTS[3]: "Delaunay (5), blossom (1)",
    ATTEMPTS[4]: "frontal Delaunay (6), triangles",
}


def run() -> None:
    """Mesh, measure, draw, write."""
    table, candidates = algorithms()
    figure = Figure(figsize=(13, 6.6), dpi=DPI)
    for column, attempt in enumerate(SHOWN):
        axes = figure.add_axes((0.5 * column, 0.0, 0.5, 0.9))
        draw(axes, candidates[attempt].mesh)
        corner = worst(candidates[attempt].mesh)["scaled_jacobian"].value
        title = f"{NAMES[attempt]}: worst corner {corner:.2f}"
        figure.text(0.25 + 0.5 * column, 0.94, title, ha="center", color=INK, fontsize=15)
    deliver(figure, DOCS / "images" / "meshes-flower.png")
    made = {"algorithms": table, "report": f"```text\n{report()}```", "raising": raising()}
    write_blocks(DOCS / "meshes.md", made, COMMAND)


def algorithms() -> tuple[str, dict[Attempt, Candidate]]:
    """Every way to mesh the flower: elements, worst corner, time; and the meshes of one size."""
    lines = [
        "| gmsh's algorithms | size | quadrilaterals | triangles | worst corner | CPU s |",
        "|---|---|---|---|---|---|",
    ]
    kept = {}
    for size in (0.4e-3, 0.8e-3, 1.2e-3):
        for attempt in ATTEMPTS:
            with session(FLOWER.name) as gmsh:
                open_geometry(gmsh, FLOWER, FLOWER.name)
                set_size(gmsh, 1e3 * size, "mm", ".geo")
                row = f"| {NAMES[attempt]} | {1e3 * size:g} mm |"
                start = time.process_time()
                try:
                    found = meshed(gmsh, FLOWER.name, "mm", attempt)
                except Exception as error:  # gmsh raises Exception itself
                    reason = "corner turned inside out" if "inside out" in str(error) else "fails"
                    lines.append(f"{row} {reason} | | | |")
                    continue
                seconds = time.process_time() - start
            quads = len(found.mesh.elements) - found.triangles
            lines.append(f"{row} {quads} | {found.triangles} | {found.worst:.2f} | {seconds:.1f} |")
            if size == SIZE:
                kept[attempt] = found
    return "\n".join(lines), kept


def draw(axes: Axes, mesh: Mesh) -> None:
    """A flat mesh with its groups tinted and its worst corner marked."""
    sides = mesh.elements[:, SIDES]
    rings = 1e3 * along(mesh.points, sides[:, :, :]).reshape(len(mesh.elements), -1, 3)[:, :, :2]
    for (_, elements), colour in zip(mesh.element_groups.items(), COLOURS, strict=False):
        axes.add_collection(PolyCollection(rings[elements], facecolor=colour, edgecolor="none", alpha=0.22))
    axes.add_collection(LineCollection(rings, colors=GREY, linewidths=0.5))
    for edges in mesh.edge_groups.values():
        axes.add_collection(LineCollection(1e3 * along(mesh.points, edges)[:, :, :2], colors=INK, linewidths=2.2))
    element = worst(mesh)["scaled_jacobian"].element
    centre = 1e3 * mesh.points[mesh.elements[element, :4]].mean(axis=0)
    axes.plot(*centre[:2], "o", markersize=19, markerfacecolor="none", markeredgecolor=ACCENT, markeredgewidth=2.2)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()


def along(points: FloatArray, edges: IntArray) -> FloatArray:
    """Points (..., 7, 3) along edges (..., 3) of end, end and middle."""
    t = np.linspace(0.0, 1.0, 7)[:, None]
    shape = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
    return np.einsum("spj,...sk->...pk", shape, points[edges])


def report() -> str:
    """What the command says."""
    said = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(said):
        main(["mesh", str(FLOWER), "--unit", "mm", "--size", f"{1e3 * SIZE:g} mm", "--out", f"{folder}/flower.msh"])
    return said.getvalue().replace(f"{folder}/", "")


def raising() -> str:
    """How far the middles are from the cylinder and the sphere of radius 1 that first-order meshes stand for."""

    def tube(points: FloatArray) -> FloatArray:
        return np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0)

    def ball(points: FloatArray) -> FloatArray:
        return np.abs(np.linalg.norm(points, axis=1) - 1.0)

    surfaces: dict[str, tuple[Callable[[int], Mesh], Callable[[FloatArray], FloatArray]]] = {
        "cylinder, sector of 100°": (lambda n: ms.mesh.cylinder(1, 1, (n, n), angle=(0, 100)), tube),
        "sphere, patch of 90° × 100°": (lambda n: ms.mesh.sphere_patch(1, (30, 120), (0, 100), (n, n)), ball),
    }
    lines = ["| Surface of radius 1 | Elements | Middles off it | Chords off it |", "|---|---|---|---|"]
    for name, (make, off) in surfaces.items():
        for n in (4, 8, 16, 32):
            mesh = make(n)
            corners = np.unique(mesh.elements[:, :4])
            quads = np.searchsorted(corners, mesh.elements[:, :4])
            raised = raise_order(mesh.points[corners], np.hstack([quads, np.full_like(quads, -1)]))
            sides = raised.rows[:, SIDES].reshape(-1, 3)
            middles, chords = raised.points[sides[:, 2]], raised.points[sides[:, :2]].mean(axis=1)
            lines.append(f"| {name} | {n} × {n} | {off(middles).max():.1e} | {off(chords).max():.1e} |")
    return "\n".join(lines)


if __name__ == "__main__":
    run()
