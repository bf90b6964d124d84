"""Draw the meshes of a drawing and of a mid-surface for `docs/meshes.md`, with what `magshell mesh` says of them.
Needs the extras `drawings` and `meshio`.

python docs/make_drawing_figure.py       ten seconds
"""

from __future__ import annotations

import io
import pathlib
import tempfile
from contextlib import chdir, redirect_stdout

import numpy as np
from blocks import write_blocks
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

import magshell as ms
from magshell.cli import main
from magshell.mesh import Mesh
from magshell.output.style import COLOURS, DPI, GREY, INK, deliver

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_drawing_figure.py"
PADDLE = DOCS / "meshes" / "paddle.dxf"
PLATE = DOCS / "meshes" / "plate.stl"


def run() -> None:
    """Mesh, draw, write."""
    paddle = ms.mesh.from_drawing(PADDLE, size=1.5e-3)
    plate = ms.mesh.mid_surface(PLATE, size=1.5e-3, unit="mm")
    figure = Figure(figsize=(13, 4.6), dpi=DPI)
    for column, (mesh, title) in enumerate(
        ((paddle, "paddle.dxf: layers plate, magnet and root"), (plate, "plate.stl: the mid-surface of a solid"))
    ):
        draw(figure.add_axes((0.5 * column + 0.02, 0.02, 0.46, 0.84)), mesh)
        figure.text(0.5 * column + 0.25, 0.92, title, ha="center", color=INK, fontsize=15)
    deliver(figure, DOCS / "images" / "meshes-drawings.png")
    made = {
        "drawing": said("mesh", str(PADDLE), "--size", "1.5 mm"),
        "solid": said("mesh", str(PLATE), "--unit", "mm", "--mid-surface", "--size", "1.5 mm"),
    }
    write_blocks(DOCS / "meshes.md", made, COMMAND)


def draw(axes: Axes, mesh: Mesh) -> None:
    """Elements in the colours of their groups, edges of groups that are marked or holes in strong lines."""
    colour = np.zeros(len(mesh.elements), dtype=np.int64)
    for number, rows in enumerate(mesh.element_groups.values()):
        colour[rows] = number
    ring = mesh.points[mesh.elements[:, [0, 4, 1, 5, 2, 6, 3, 7]], :2]
    faces = [f"{COLOURS[number]}40" for number in colour]
    axes.add_collection(PolyCollection(list(1e3 * ring), facecolors=faces, edgecolors=GREY, linewidths=0.7))
    strong = [name for name in mesh.edge_groups if not name.endswith("-edges")]
    rows = [1e3 * mesh.points[edge[[0, 2, 1]], :2] for name in strong for edge in mesh.edge_groups[name]]
    axes.add_collection(LineCollection(rows, colors=INK, linewidths=2.5))
    axes.autoscale()
    axes.set_aspect("equal")
    axes.axis("off")


def said(*arguments: str) -> str:
    """What a command prints, as a block of the page."""
    text = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, chdir(folder), redirect_stdout(text):
        assert main(list(arguments)) == 0
    return f"```text\n{text.getvalue().strip()}\n```"


if __name__ == "__main__":
    run()
