"""Solve the examples, draw `docs/images`, write the tables of README.md and accuracy.md and the pages of docs/examples.

    python docs/make_figures.py            some minutes, on all cores
    python docs/make_figures.py remanence  only the pictures of remanence.md and of the flower
    python docs/make_figures.py reactions  only that of reactions.md

Every number in the tables is computed here; what they are compared with is in `magshell.reproduction.references`.
"""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Mapping, Sequence

import example_pages
import numpy as np
import reaction_pictures
import remanence_pictures
from blocks import write_blocks
from matplotlib.figure import Figure

import magshell as ms
from magshell import problem
from magshell.files import write_atomically
from magshell.output.bodies import Body, cameras_for, step_at, turned
from magshell.output.panels import colour_bar, colour_scale, draw_sequence, field_arrow
from magshell.output.style import deliver
from magshell.problem.schema import ProblemFile
from magshell.reproduction.catalogue import EXAMPLES
from magshell.reproduction.numbers import at_probe, length_of, measured_differences
from magshell.reproduction.page import Section
from magshell.reproduction.references import ASPECT_RATIOS, MEASURED_ON
from magshell.reproduction.reproduce import section_of
from magshell.reproduction.runs import solve_all
from magshell.reproduction.table import Row
from magshell.reproduction.variants import paper_file, variants

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_figures.py"
IMAGES = DOCS / "images"
PROBLEMS = sorted(name for example in EXAMPLES for name in example.problems)
MESHES = ((15, 4), (30, 6), (60, 12))
MESH_FIELDS = (0.02, 1.0, 10.0)
Paths = Mapping[str, ms.Path]


def main() -> None:
    """Solve, draw, write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("only", nargs="?", choices=["remanence", "reactions"], help="make only these")
    only = parser.parse_args().only
    IMAGES.mkdir(exist_ok=True)
    if only != "reactions":
        remanence_pictures.draw(IMAGES)
    if only != "remanence":
        reaction_pictures.draw(IMAGES)
    if only:
        return
    files = {name: file for example in EXAMPLES for name, file in variants(example).items()}
    files |= {f"built-in {name}": problem.read(name)[1] for name in PROBLEMS}
    files |= {_mesh_name(mesh): gripper_on(mesh) for mesh in MESHES}
    paths = solved(files)
    built_in = {name: paths[f"built-in {name}"] for name in PROBLEMS}
    sections = []
    for example in EXAMPLES:
        print(f"figures of {example.name} ...", flush=True)
        sections.append(section_of(example, {name: paths[name] for name in variants(example)}, IMAGES))
    draw_gripper(paths["gripper"])
    rows = [row for section in sections for row in section.rows if row.paper is not None]
    tables = {
        "accuracy": accuracy_table(rows),
        "strips": strip_table(paths),
        "effort": effort_table(built_in),
        "meshes": mesh_table(paths),
    }
    print("\n\n".join(tables.values()))
    displacements = [row for row in rows if row.unit == "mm" and "largest" not in row.quantity]
    write_blocks(DOCS.parent / "README.md", {"accuracy": accuracy_table(displacements)}, COMMAND)
    write_blocks(DOCS / "accuracy.md", tables, COMMAND)
    for section in sections:
        write_page(section, built_in)


def solved(files: Mapping[str, ProblemFile]) -> dict[str, ms.Path]:
    """The load paths of all problems, solved in parallel."""
    paths = {}
    for outcome in solve_all(files, lambda name, load: None):
        if outcome.path is None:
            raise SystemExit(f"{outcome.name}: {outcome.reason}")
        paths[outcome.name] = outcome.path
        print(f"{outcome.name}: solved ({len(paths)} of {len(files)})", flush=True)
    return paths


def write_page(section: Section, built_in: Paths) -> None:
    """The page of an example, its script run."""
    name = section.example.name
    print(f"page of {name} ...", flush=True)
    script = DOCS / "examples" / f"{name.replace('-', '_')}.py"
    write_atomically(DOCS / "examples" / f"{name}.md", example_pages.page(section, built_in, script).encode())


# -- tables ----------------------------------------------------------------------------------------------------------


def accuracy_table(rows: Sequence[Row]) -> str:
    """What the paper quotes, and what comes out here."""
    lines = ["| Example | Quantity | Unit | Paper | magshell | Difference |", "|---|---|---|---:|---:|---:|"]
    for row in rows:
        quantity = row.quantity.replace("|", "\\|")
        lines.append(
            f"| `{row.example}` | {quantity} | {row.unit} | {row.paper:g} | {row.computed:.4g} "
            f"| {row.difference_percent:+.1f} % |"
        )
    return "\n".join(lines)


def strip_table(paths: Paths) -> str:
    """Tip deflection over length of the four strips, and the experiment where it was made."""
    fields = (2.0, 5.0, 10.0, 20.0, 50.0)
    lines = [f"| Strip | {' | '.join(f'{field:g} mT' for field in fields)} |", "|---|" + "---:|" * len(fields)]
    for name, ratio in ASPECT_RATIOS.items():
        values = (at_probe(paths[name], "tip", 3, field) / (1e3 * length_of(paths[name])) for field in fields)
        lines.append(f"| `{name}`, aspect ratio {ratio:g} | {' | '.join(f'{value:.4f}' for value in values)} |")
    off = measured_differences(paths[MEASURED_ON])
    lines += ["", f"From the measured points the computed curve is off by {off.min():+.1f} to {off.max():+.1f} %."]
    return "\n".join(lines)


def effort_table(paths: Paths) -> str:
    """Size and effort of every problem."""
    lines = [
        "| Problem | Elements | Unknowns | Steps | Linear solves | Cuts | CPU (s) | Force balance | Moment balance |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, path in paths.items():
        s = path.summary
        lines.append(
            f"| `{name}` | {s['elements']} | {s['dofs']} | {s['steps']} | {s['iterations']} | {s['cuts']} "
            f"| {s['cpu_seconds']:.1f} | {s['force_imbalance']:.0e} | {s['moment_imbalance']:.0e} |"
        )
    return "\n".join(lines)


def gripper_on(mesh: tuple[int, int]) -> ProblemFile:
    """The gripper with the paper's element on another mesh."""
    file = paper_file("gripper")
    field = file.field.model_copy(update={"stops": tuple(1e-3 * field for field in MESH_FIELDS)})
    return file.model_copy(
        update={
            "mesh": file.mesh.model_copy(update={"elements": mesh}),
            "field": field,
            "probes": {"B": file.probes["B"]},
        }
    )


def _mesh_name(mesh: tuple[int, int]) -> str:
    return f"gripper, {mesh[0]} × {mesh[1]}"


def mesh_table(paths: Paths) -> str:
    """The gripper's equator point on a coarser and a finer mesh."""
    lines = ["| Mesh | Unknowns | 0.02 mT | 1 mT | 10 mT |", "|---|---:|---:|---:|---:|"]
    for mesh in MESHES:
        path = paths[_mesh_name(mesh)]
        values = (f"{at_probe(path, 'B', 3, field):#.4g}" for field in MESH_FIELDS)
        lines.append(f"| {mesh[0]} × {mesh[1]} | {path.discretisation.dofs} | {' | '.join(values)} |")
    return "\n".join(lines)


# -- pictures --------------------------------------------------------------------------------------------------------


def draw_gripper(path: ms.Path) -> None:
    """The whole gripper, twelve arms, as the field grows, in one row."""
    fields, view = (0.0, 1.0, 2.0, 4.0, 6.8), (0.0, 20.0)
    groups = [[Body(path, step_at(path, 1e-3 * field), turned(12), "u3")] for field in fields]
    cameras = cameras_for(groups, *view, level=True)
    left, right, below, above, width = 0.06, 0.9, 0.12, 0.98, 12.0
    spread = sum(camera.half_width for camera in cameras)
    height = (right - left) * width * cameras[0].half_height / spread / (above - below)
    figure = Figure(figsize=(width, height), dpi=160, facecolor="white")
    shares = [(right - left) * camera.half_width / spread for camera in cameras]
    starts = left + np.cumsum([0.0, *shares[:-1]])
    places = [(float(start), below, share, above - below) for start, share in zip(starts, shares, strict=True)]
    scale = colour_scale([body for group in groups for body in group], 3)
    titles = [f"{field:g} mT" if field else "no field" for field in fields]
    draw_sequence(figure, groups, titles, places, scale, view, level=True)
    field_arrow(figure, 0.03, 0.5, np.array([0.0, 1.0]))
    colour_bar(figure, (0.912, 0.2, 0.012, 0.55), scale, "$u_3$ (mm)")
    deliver(figure, IMAGES / "gripper.png")


if __name__ == "__main__":
    main()
