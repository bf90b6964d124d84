"""What a page holds of a path, in the types of JSON and as arrays in text."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import Output, chosen, find
from magshell.evaluation.patches import patches_of
from magshell.output.history import history_text
from magshell.output.labels import plain, shown_unit
from magshell.output.page.arrays import quantised, span, text
from magshell.output.page.curves import curves, over, probes
from magshell.output.page.solid import solid
from magshell.output.page.sources import reached, sources
from magshell.output.page.stencils import stencils
from magshell.output.rounding import without_round_off
from magshell.output.scene import best_axes
from magshell.output.skin import MOST_ELEMENTS_WITH_EDGES, skin_of

if TYPE_CHECKING:
    from magshell.mesh import Mesh
    from magshell.solver.path import Path
    from magshell.solver.step import Step

DIRECTIONS = 80
MOST_ARROWS = 400


class Data(NamedTuple):
    """A header in the types of JSON, and arrays in base64 by name."""

    header: dict[str, Any]
    arrays: dict[str, str]


def collect(path: Path, steps: Sequence[Step], color: str, advance: Callable[[float], None]) -> Data:
    """Everything a page shows of a path.

    Parameters
    ----------
    path : Path
    steps : sequence of Step
        Those of the path that are shown, one at least; the curves have all.
    color : str
        Output that colours the shape when the page opens.
    advance : callable
        Told the share of the work that is done, after each step.

    Raises
    ------
    InputError
        No such output.
    """
    mesh, patches = path.discretisation.mesh, patches_of(path.model.shell)
    first, component = find(color)
    shown = page_outputs(path, first)
    kinds, arrays = stencils(path.model.shell)
    levels, arrays_of_levels = solid(path, steps)
    arrays |= arrays_of_levels | {
        "points": text(mesh.points[patches.nodes], "<f4"),
        "mesh-nodes": text(patches.nodes, "<u4"),
        "history": base64.b64encode(history_text(path).encode()).decode(),
        "sequential": text(_colours("viridis"), "u1"),
        "diverging": text(_colours("coolwarm"), "u1"),
    }
    coded = [_Coded(path, output) for output in shown]
    for number, found in enumerate(without_round_off(path, shown, steps)):
        for one, values in zip(coded, found, strict=True):
            one.add(values)
        advance((number + 1) / len(steps))
    outputs = []
    for output, one in zip(shown, coded, strict=True):
        about, arrays[output.name] = one.told()
        outputs.append(about)
    drawn, of_sources = sources(path, steps)
    arrays |= of_sources
    fields = [_known(path.flux_density(step)) for step in steps]
    magnitudes = [None if B is None else float(np.linalg.norm(B)) for B in fields]
    header = {
        "outputs": outputs,
        "colour": f"{first.name} {_column(first, component)}",
        "mesh": kinds,
        "solid": levels,
        "edges": len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES,
        "hull": _hull(path, steps).tolist(),
        "view": _view(path),
        "arrows": {"output": "remanence", "most": MOST_ARROWS, "length": _arrow_length(mesh)},
        "steps": [
            {
                "number": step.number,
                "stage": step.stage + 1,
                "load_factor": float(step.load_factor),
                "field": B,
                "magnitude": magnitude,
                "unstable": bool(step.negative_pivots),
            }
            for step, B, magnitude in zip(steps, fields, magnitudes, strict=True)
        ],
        "strongest": max((one for one in magnitudes if one is not None), default=0.0),
        "where": "" if path.model.field.is_uniform else " at the centre",
        "stages": path.steps[-1].stage + 1,
        "over": over(path),
        "curves": curves(path),
        "probes": probes(path),
        "sources": drawn,
    }
    return Data(header, arrays)


def _known(flux_density: FloatArray) -> list[float] | None:
    return flux_density.tolist() if np.isfinite(flux_density).all() else None


def page_outputs(path: Path, first: Output) -> list[Output]:
    """What a page of the path shows: the usual outputs, those that the model asks for, and that of the first view."""
    return chosen([*path.model.outputs, first.name])


def _column(output: Output, component: int | None) -> int:
    """Index of what colours the shape: a component from 0; after them the length of a vector."""
    if component is not None:
        return component - 1
    return 0 if output.components == 1 else output.components


class _Coded:
    """An output as codes and ranges: step by step, component by component."""

    def __init__(self, path: Path, output: Output) -> None:
        self._output, self._nodes = output, patches_of(path.model.shell).nodes
        self._whole = output.components > 1 and output.has_length
        self._ranges: list[list[tuple[float, float]]] = [[] for _ in range(output.components + self._whole)]
        self._codes: list[AnyArray] = []

    def add(self, values: FloatArray) -> None:
        """Values of the next step."""
        values = values[self._nodes] if self._output.where == "point" else values
        coded = [quantised(column) for column in values.reshape(len(values), self._output.components).T]
        for found, (_, ends) in zip(self._ranges, coded, strict=False):
            found.append(ends)
        if self._whole:
            self._ranges[-1].append(span(np.linalg.norm(values, axis=1)))
        self._codes.append(np.stack([code for code, _ in coded]))

    def told(self) -> tuple[dict[str, Any], str]:
        """Description and codes; once if the output never changes."""
        output, codes, ranges = self._output, self._codes, self._ranges
        constant = all(np.array_equal(code, codes[0]) for code in codes)
        if constant and all(len(set(found)) == 1 for found in ranges):
            codes, ranges = codes[:1], [found[:1] for found in ranges]
        count = output.components
        unit, factor = shown_unit(output)
        about = {
            "name": output.name,
            "letters": [plain(output, i + 1 if count > 1 else None) for i in range(count)]
            + [plain(output)] * self._whole,
            "unit": unit,
            "factor": factor,
            "sentence": output.sentence,
            "where": "cell" if output.where == "cell" else "point",
            "components": count,
            "rows": codes[0].shape[1],
            "steps": len(codes),
            "ranges": ranges,
        }
        return about, text(np.stack(codes), "<u2")


def _hull(path: Path, steps: Sequence[Step]) -> FloatArray:
    """Points (n, 3) of the steps that reach farthest in directions all around: what a picture of them must hold."""
    number = np.arange(DIRECTIONS) + 0.5
    height, turn = 1.0 - 2.0 * number / DIRECTIONS, np.pi * (1.0 + 5.0**0.5) * number
    ring = np.sqrt(1.0 - height**2)
    directions = np.stack([ring * np.cos(turn), ring * np.sin(turn), height])
    skin = skin_of(path.model.shell)
    positions = (skin.extent(converged(path.discretisation, step)) for step in steps)
    extreme = np.concatenate([x[np.unique((x @ directions).argmax(axis=0))] for x in positions])
    extreme = np.concatenate([extreme, reached(path, steps, extreme)])
    return np.asarray(extreme[np.unique((extreme @ directions).argmax(axis=0))])


def _view(path: Path) -> tuple[float, float]:
    """Azimuth and elevation of the eye that pictures have, degrees."""
    mesh = path.discretisation.mesh
    towards = best_axes(np.vstack([mesh.points, mesh.points + path.steps[-1].state.displacement(len(mesh.points))]))[2]
    return float(np.degrees(np.arctan2(towards[1], towards[0]))), float(np.degrees(np.arcsin(towards[2])))


def _arrow_length(mesh: Mesh) -> float:
    """Of the longest arrow, m: arrows on `MOST_ARROWS` elements, spread evenly, then do not cover each other."""
    corners = mesh.points[mesh.elements[:, :4]]
    diagonals = corners[:, 2:] - corners[:, :2]
    area = 0.5 * np.linalg.norm(np.cross(diagonals[:, 0], diagonals[:, 1]), axis=1).sum()
    return float(0.85 * np.sqrt(area / min(MOST_ARROWS, len(mesh.elements))))


def _colours(name: str) -> Any:
    """256 colours of a colour map, red, green, blue, 0 to 255."""
    from matplotlib import colormaps

    return colormaps[name](np.linspace(0.0, 1.0, 256), bytes=True)[:, :3]
