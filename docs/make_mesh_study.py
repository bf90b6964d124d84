"""Compare the expected error of meshes, as `magshell check` tells it, with what refining the mesh once changes.

    python docs/make_mesh_study.py

Writes the table of `docs/recipes/mesh-size.md`. Problems of several kinds, each on a coarse mesh, on its own and on a
fine one; the true error is the largest change of the displacement of the probe that moves farthest, over the stops that
both paths have, relative to that displacement on the finer mesh. Finished runs are kept in `results/`.
"""

from __future__ import annotations

import pathlib
from typing import Any

import blocks
import numpy as np
from element_study.runs import Store

import magshell as ms
from magshell import problem
from magshell.model.doubts.mesh_error import STEPS
from magshell.problem.building import build
from magshell.problem.schema import Blocks, Mesh

PAGE = pathlib.Path(__file__).parent / "recipes" / "mesh-size.md"
FILE = pathlib.Path(__file__).parents[1] / "results" / "mesh-study" / "runs.json"
PROBLEMS = (
    "strip-10", "strip-17", "strip-41", "thin-cross", "h-shape", "gripper", "starfish", "stepped-strip",
    "bilayer-strip", "cantilever-shear", "cantilever-moment", "ribbed-plate", "semi-cylinder", "strip-over-magnet",
    "magnet-approaches",
)  # fmt: skip
FACTORS = (0.5, 1.0, 2.0)
LARGE = ("semi-cylinder",)
"""Problems that are not refined beyond their own mesh."""


def times(count: Any, factor: float) -> Any:
    """Numbers of elements, each at least 1."""
    return tuple(times(one, factor) for one in count) if isinstance(count, tuple) else max(1, int(count * factor))


def divided(mesh: Mesh, factor: float) -> Mesh:
    """A mesh with so many times the elements in both directions."""
    update: dict[str, Any] = {} if mesh.elements is None else {"elements": times(mesh.elements, factor)}
    if isinstance(mesh, Blocks):
        update["blocks"] = {
            name: block.model_copy(update={"elements": times(block.elements, factor)}) if block.elements else block
            for name, block in mesh.blocks.items()
        }
    return mesh.model_copy(update=update)


def model_of(name: str, factor: float) -> problem.Problem | None:
    """A built-in problem with that many elements; None where its file cannot be meshed so."""
    source, file = problem.read(name)
    try:
        return build(file.model_copy(update={"mesh": divided(file.mesh, factor)}), source)
    except ms.InputError:
        return None


def solved(name: str, factor: float) -> dict[str, Any] | None:
    """Stage, load factor and displacements of the probes at all steps; None where there is no such mesh."""
    made = model_of(name, factor)
    if made is None:
        return None
    print(f"  {name} x {factor:g} ...", flush=True)
    path = ms.solve(made.model, made.settings)
    return {
        "elements": len(made.model.shell.mesh.elements),
        "steps": [[step.stage, round(step.load_factor, 9)] for step in path.steps],
        "probes": {probe: path.probe(probe).u.tolist() for probe in made.model.probe_nodes},
    }


def change(coarse: dict[str, Any], fine: dict[str, Any]) -> float:
    """Largest relative change of the farthest probe over the common stops."""
    found = [0.0]
    for place, step in enumerate(coarse["steps"]):
        if step[1] == 0.0 or step not in fine["steps"]:
            continue
        other = fine["steps"].index(step)
        finer = {probe: np.array(u[other]) for probe, u in fine["probes"].items()}
        farthest = max(finer, key=lambda probe: float(np.linalg.norm(finer[probe])))
        off = np.array(coarse["probes"][farthest][place]) - finer[farthest]
        found.append(float(np.linalg.norm(off) / np.linalg.norm(finer[farthest])))
    return max(found)


def short(ratio: float) -> str:
    """Two digits, without an exponent."""
    return f"{float(f'{ratio:.2g}'):g}"


def table(store: Store) -> tuple[str, str]:
    """The table, and what it says in a sentence."""
    lines = ["| Problem | Elements | Told | Refined once | Told over that |", "|---|---:|---:|---:|---:|"]
    ratios, above = [], []
    for name in PROBLEMS:
        factors = FACTORS[:2] if name in LARGE else FACTORS
        runs = [store.get(f"{name} {factor:g}", lambda: solved(name, factor)) for factor in factors]  # noqa: B023
        for factor, coarse, fine in zip(factors, runs, runs[1:], strict=False):
            made = model_of(name, factor)
            if made is None or coarse is None or fine is None:
                continue
            error, expected = change(coarse, fine), made.model.expected_error
            told = next((step for step in STEPS if expected <= step), None)
            shown = f"{100 * told:g} %" if told else f"> {100 * STEPS[-1]:g} %"
            ratio = (told or STEPS[-1]) / error
            ratios.append(ratio)
            above += [name] if ratio < 1.0 else []
            lines.append(f"| `{name}` | {coarse['elements']} | {shown} | {100 * error:.3f} % | {short(ratio)} |")
    names = " and ".join(f"`{name}`" for name in dict.fromkeys(above))
    exception = f" (not on {names})" if above else ""
    return "\n".join(lines), (
        f"On {len(ratios) - len(above)} of {len(ratios)} meshes the told error is an upper bound{exception}. It is "
        f"{short(min(ratios))} to {short(max(ratios))} times what refining the mesh changes; the median is "
        f"{short(float(np.median(ratios)))}."
    )


if __name__ == "__main__":
    found, sentence = table(Store(FILE))
    blocks.write_blocks(PAGE, {"mesh-study": found, "mesh-claim": sentence}, "docs/make_mesh_study.py")
    print(sentence)
