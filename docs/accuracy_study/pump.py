"""The pump: small fields against linear shell theory, the crease, clamp, grading and law, and its steep path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import magshell as ms
from accuracy_study.convergence import converged, paper_run, sequence
from accuracy_study.examples import READINGS, Divisions, Variant, changed
from accuracy_study.page import LABEL, LEGEND, TEXT, Findings, dress, figure, number, percent, table
from accuracy_study.runs import Runs, name_of
from accuracy_study.tube import Tube
from magshell.mesh import Mesh
from magshell.output.style import COLOURS, PALE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

READING = READINGS["pump"]
LOW, FINAL = READING.fields
MU, LAME, THICKNESS, RADIUS, HALF_LENGTH = 135e3, 3250e3, 0.9e-3, 22.918311805233e-3, 60e-3
REMANENCE, MU0 = 94e-3, 4e-7 * np.pi
FINE, MEDIUM, USUAL = (24, 20), (18, 15), (12, 10)
SHARP = 0.95
"""Grading that makes the elements at one end twenty times smaller than the mean."""
STEEP = (30.0, 45.0)
SMALL_STEPS = 0.02
"""Largest increment of the load factor on the steep path."""
TINY = 0.05
"""A field, mT, at which displacements are proportional to it; at 1 mT they are a quarter of the thickness."""
LAWS = ("couple", "micro-rotation", "deformation-gradient")


@dataclass(frozen=True)
class Graded(Variant):
    """The pump with elements that get smaller towards the generators at top and bottom, or towards the clamp.

    Attributes
    ----------
    around, along : float
        g in s + g sin(πs)/π, which moves nodes; the smallest elements are 1 - g of the mean.
    """

    around: float = 0.0
    along: float = 0.0

    def model(self) -> ms.Model:
        """The model on the moved nodes."""
        plain = super().model()
        mesh = plain.shell.mesh
        X1, X2, X3 = mesh.points.T
        angle = 0.5 * np.pi * _moved(np.arctan2(X3, X1) / (0.5 * np.pi), self.around)
        along = HALF_LENGTH * _moved(X2 / HALF_LENGTH, self.along)
        points = np.stack([RADIUS * np.cos(angle), along, RADIUS * np.sin(angle)], axis=1)
        points[np.abs(points) < 1e-12] = 0.0
        moved = Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)
        return replace(plain, shell=replace(plain.shell, mesh=moved))


def _moved(s: np.ndarray, grading: float) -> np.ndarray:
    return s + grading * np.sin(np.pi * s) / np.pi


def study(runs: Runs) -> Findings:
    """Tables of the low field, of what changes the result and of the steep path; pictures of crease and path."""
    findings = Findings()
    findings.tables["pump-low"] = _low(runs)
    findings.tables["pump-changes"] = _changes(runs)
    findings.tables["pump-steep"], findings.pictures["pump-path"] = _steep(runs)
    findings.pictures["pump-crease"] = _crease(runs)
    return findings


# -- small field -----------------------------------------------------------------------------------------------------


def linear_theory(length: float) -> float:
    """|u1| at B by linear shell theory at the low field, mm, for a length scale over h."""
    couple, couple_modulus = REMANENCE * 1e-3 * LOW / MU0, MU * (length * THICKNESS) ** 2
    return -1e3 * Tube(RADIUS, HALF_LENGTH, THICKNESS, MU, LAME, couple_modulus, couple).side()


def _low(runs: Runs) -> str:
    def linear(**keys: float) -> float:
        graded = Graded("pump", MEDIUM, "quadratic", (TINY,), around=0.9, along=0.5)
        return READING.of(runs.of(changed(graded, **keys)), TINY) * LOW / TINY

    thin, usual = linear_theory(0.0), linear_theory(0.1)
    small = f"shell at {TINY:g} mT, per mT"
    rows = [
        ("linear theory", "no couple stress", thin, thin),
        (small, "$\\eta = 10\\mu$, $l = h/100$", linear(eta=10.0, length=0.01), thin),
        ("linear theory", "$l = h/10$", usual, usual),
        (small, "$\\eta = 10\\mu$, $l = h/10$", linear(eta=10.0), usual),
        (small, "$\\eta = \\mu/10$, $l = h/10$", linear(), usual),
        ("shell at 1 mT, limit of the default element", "the same", converged(runs, "pump", LOW), usual),
        (
            "shell at 1 mT, limit of the paper's element",
            "the same",
            sequence(runs, "pump", "paper", LOW).limit.value,
            usual,
        ),
        ("shell at 1 mT, the paper's element and mesh", "the same", READING.of(paper_run(runs, "pump"), LOW), usual),
    ]
    header = ("Pump", "", "$\\lvert u_1\\rvert$ at B (mm)", "From linear theory (%)")
    return table(header, [(one, two, number(value), percent(value, of)) for one, two, value, of in rows], 2)


# -- what changes it -------------------------------------------------------------------------------------------------


def _changes(runs: Runs) -> str:
    kinds: dict[str, dict[str, Any]] = {
        "as it is (mm); below, change in per cent": {},
        "ends: $\\varphi$ held too": {"ends": "phi held"},
        "the same, graded towards the clamp, 1:20": {"ends": "phi held", "along": SHARP},
        "ends: free to turn": {"ends": "simple"},
        "graded towards the clamp, 1:20": {"along": SHARP},
        "graded towards the crease, 1:20": {"around": SHARP},
        "law `micro-rotation`": {"coupling": "micro-rotation"},
        "law `deformation-gradient`": {"coupling": "deformation-gradient"},
    }

    def reading(divisions: Divisions, fields: tuple[float, ...], keys: dict[str, Any]) -> float:
        kind = Graded if "around" in keys or "along" in keys else Variant
        return READING.of(runs.of(kind("pump", divisions, "quadratic", fields, **keys)), fields[-1])

    found = {
        words: (reading(MEDIUM, (LOW,), keys), reading(USUAL, READING.fields, keys)) for words, keys in kinds.items()
    }
    first, *others = found.items()
    rows = [[first[0], *map(number, first[1])]]
    for words, values in others:
        rows.append([words, *(percent(new, old) for new, old in zip(values, first[1], strict=True))])
    meshes = (f"{field:g} mT, {n} × {m}" for field, (n, m) in ((LOW, MEDIUM), (FINAL, USUAL)))
    return table(("Pump", *meshes), rows)


# -- steep path ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Steep(Variant):
    """The pump to 45 mT in small steps, without a stop where the path may turn back."""

    @property
    def settings(self) -> ms.Settings:
        """Small steps."""
        return ms.Settings(largest_step=SMALL_STEPS)


def _steep(runs: Runs) -> tuple[str, Figure]:
    every = {
        "default 12 × 10": runs.of(Variant("pump", USUAL, "quadratic", READING.fields)),
        "default 18 × 15": runs.of(Steep("pump", MEDIUM, "quadratic", STEEP)),
    }
    every["paper's 24 × 20"] = runs.of(Steep("pump", FINE, "paper", STEEP))
    for law in LAWS[1:]:
        every[f"default 12 × 10, {law}"] = runs.of(Steep("pump", USUAL, "quadratic", STEEP, coupling=law))
    new = figure((13.0, 5.4))
    whole, near = new.subplots(1, 2, width_ratios=(1.0, 1.3))
    rows = []
    for place, (words, run) in enumerate(every.items()):
        fields, values = np.array(run.fields), -np.array(run.probes["B"])[:, 0]
        for axes in (whole, near):
            dress(axes, "field (mT)", r"$|u_1|$ at B (mm)")
            axes.plot(fields, values, color=COLOURS[place], marker=".", markersize=6, linewidth=1.5, label=words)
        turns = [f"{fields[at]:.2f}" for at in _turns(fields)]
        end = "reached" if not run.reason else f"stops at {fields[-1]:.2f} mT"
        rows.append((words, ", ".join(turns) or "none", str(len(fields) - 1), str(run.cuts), end))
    whole.set_xlim(0.0, STEEP[-1])
    whole.set_ylim(0.0, 15.0)
    near.set_xlim(31.0, 37.0)
    near.set_ylim(7.0, 10.6)
    whole.legend(loc="upper left", **LEGEND)
    header = ("Pump", "Turns at (mT)", "Steps", "Cuts", "End")
    return table(header, rows, 2), new


def _turns(fields: np.ndarray) -> np.ndarray:
    """Steps at which the field turns from rising to falling or back."""
    rises = np.sign(np.diff(fields))
    return 1 + np.flatnonzero(rises[1:] != rises[:-1])


# -- crease ----------------------------------------------------------------------------------------------------------


def _profile(runs: Runs, variant: Variant) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Around the middle section at the low field: angle, degrees; micro-rotation and that of the director, mrad."""

    def make() -> list[list[float]]:
        path = ms.solve(variant.model(), variant.settings)
        points, state = path.discretisation.mesh.points, path.steps[-1].state
        nodes = np.flatnonzero((np.abs(points[:, 1]) < 1e-9) & path.model.shell.carriers["w"])
        angle = np.arctan2(points[nodes, 2], points[nodes, 0])
        nodes, angle = nodes[np.argsort(angle)], np.sort(angle)
        micro = 2e3 * state.q[nodes, 2]
        director = 1e3 * (np.sin(angle) * state.w[nodes, 0] - np.cos(angle) * state.w[nodes, 2])
        return [np.degrees(angle).tolist(), micro.tolist(), director.tolist()]

    angle, micro, director = runs.store.get(f"profile of {name_of(variant)}", make)
    return np.array(angle), np.array(micro), np.array(director)


def _crease(runs: Runs) -> Figure:
    kinds = {
        "paper's element, 24 × 20": Variant("pump", FINE, "paper", (LOW,)),
        "default, 24 × 20": Variant("pump", FINE, "quadratic", (LOW,)),
        "default, 36 × 10, graded 1:20": Graded("pump", (36, 10), "quadratic", (LOW,), around=SHARP),
    }
    new = figure((13.0, 5.2))
    panels = new.subplots(1, 2)
    titles = (f"micro-rotation about $X_2$, middle section, {LOW:g} mT", "micro-rotation less rotation of the director")
    for axes, title in zip(panels, titles, strict=True):
        dress(axes, "angle from the side (degrees); 90 is the top")
        axes.set_title(title, **TEXT)
        axes.axhline(0.0, color=PALE, linewidth=1.0)
    for place, (words, variant) in reversed(list(enumerate(kinds.items()))):
        angle, micro, director = _profile(runs, variant)
        style = {"marker": "sod"[place], "markersize": (6, 4, 3)[place], "color": COLOURS[(1, 0, 2)[place]]}
        for axes, rotation in zip(panels, (micro, micro - director), strict=True):
            axes.plot(angle, rotation, linewidth=1.6, label=words, **style)
    panels[0].set_xlim(0.0, 91.0)
    panels[0].set_ylim(-6.0, 46.0)
    panels[1].set_xlim(60.0, 90.3)
    panels[1].set_ylim(-0.1, 3.2)
    panels[0].set_ylabel("mrad", **LABEL)
    panels[0].legend(loc="upper left", **LEGEND)
    return new
