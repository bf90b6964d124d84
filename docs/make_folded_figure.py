"""Draw what the generators `profile` and `miura` make, for `docs/problem-file.md`.

python docs/make_folded_figure.py       a second
"""

from __future__ import annotations

import pathlib

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

import magshell as ms
from magshell.mesh import Mesh
from magshell.output.style import ACCENT, COLOURS, DPI, GREY, INK, deliver

DOCS = pathlib.Path(__file__).parent


def run() -> None:
    """Make, draw, write."""
    ribbed = ms.mesh.profile(
        {"left": (0, 0), "foot": (20e-3, 0), "right": (40e-3, 0), "top": (20e-3, 8e-3)},
        {"plate-left": ("left", "foot"), "plate-right": ("foot", "right"), "rib": ("foot", "top")},
        40e-3,
        (4, 10),
        {"plate-left": 6, "plate-right": 6},
        axis=(0, -1, 0),
    )
    box = ms.mesh.profile(
        {"a": (0, 0), "b": (16e-3, 0), "c": (32e-3, 0), "d": (32e-3, 10e-3), "e": (16e-3, 10e-3), "f": (0, 10e-3)},
        {
            "bottom-1": ("a", "b"), "bottom-2": ("b", "c"), "right": ("c", "d"), "top-2": ("d", "e"),
            "top-1": ("e", "f"), "left": ("f", "a"), "web": ("b", "e"),
        },
        40e-3,
        (4, 10),
        axis=(0, -1, 0),
    )  # fmt: skip
    miura = ms.mesh.miura((10e-3, 10e-3), 60, 45, (2, 2), (3, 3))
    figure = Figure(figsize=(13, 4.4), dpi=DPI)
    shown = ((ribbed, "profile: a plate with a rib"), (box, "profile: two cells"), (miura, "miura: 2 × 2 cells"))
    for column, (mesh, title) in enumerate(shown):
        draw(figure.add_axes((column / 3, -0.06, 1 / 3, 1.04), projection="3d"), mesh)
        figure.text(column / 3 + 1 / 6, 0.93, title, ha="center", color=INK, fontsize=15)
    deliver(figure, DOCS / "images" / "meshes-folded.png")


def draw(axes, mesh: Mesh) -> None:
    """Elements in the colours of their groups; mountains and other edges between sheets dark, valleys in another."""
    points = 1e3 * mesh.points
    colour = np.zeros(len(mesh.elements), dtype=np.int64)
    for number, rows in enumerate(mesh.element_groups.values()):
        colour[rows] = number % len(COLOURS)
    faces = [f"{COLOURS[number]}90" for number in colour]
    axes.add_collection3d(
        Poly3DCollection(list(points[mesh.elements[:, :4]]), facecolors=faces, edgecolors=GREY, linewidths=0.4)
    )
    for name, rows in mesh.edge_groups.items():
        inside = ~np.isin(rows[:, 2], mesh.boundary_edges[:, 2])
        if not inside.any():
            continue
        lines = list(points[rows[inside][:, [0, 2, 1]]])
        axes.add_collection3d(Line3DCollection(lines, colors=ACCENT if name == "valley" else INK, linewidths=2.0))
    low, high = points.min(axis=0), points.max(axis=0)
    for which, least, greatest in zip("xyz", low, high, strict=True):
        getattr(axes, f"set_{which}lim")(least, greatest)
    axes.set_box_aspect(high - low, zoom=0.95)
    axes.view_init(elev=34, azim=-62)
    axes.set_axis_off()


if __name__ == "__main__":
    run()
