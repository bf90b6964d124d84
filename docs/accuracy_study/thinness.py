"""Strips from thick to very thin against the elastica: what locks would lag behind it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

import magshell as ms
from accuracy_study.elastica import TABLE, tip_deflection
from accuracy_study.page import LEGEND, TEXT, Findings, dress, figure, percent, table
from accuracy_study.runs import Run, Runs
from magshell.output.style import COLOURS, INK, PALE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MU0 = 4e-7 * np.pi
LENGTH, WIDTH = 20e-3, 2.0
"""m; in thicknesses."""
SHEAR, LAME, REMANENCE = 303e3, 7300e3, 143e-3
"""Pa, Pa, T; as in the strips of the paper."""

RATIOS = (10.0, 30.0, 100.0, 300.0, 1000.0)
LOADS = tuple(TABLE)
ELEMENTS = 40
THIN = RATIOS[-1]


@dataclass(frozen=True)
class Strip:
    """A cantilever of two thicknesses' width, magnetised along its length, in a field across it.

    Attributes
    ----------
    ratio : float
        Length over thickness.
    lame_lambda : float
        Pa.
    length_scale : float
        l/h.
    sides : {"free", "mirrored"}
        Free long edges, or planes of symmetry, which make the strain plane.
    element : str
    divisions : int
        Elements along the strip; there is one across.
    """

    ratio: float
    lame_lambda: float = LAME
    length_scale: float = 0.01
    sides: Literal["free", "mirrored"] = "mirrored"
    element: str = "quadratic"
    divisions: int = ELEMENTS

    @property
    def modulus(self) -> float:
        """Modulus of bending: uniaxial stress, or plane strain where the sides are mirrored, Pa."""
        mu, lam = SHEAR, self.lame_lambda
        young, poisson = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), lam / (2.0 * (lam + mu))
        return young if self.sides == "free" else young / (1.0 - poisson**2)

    @property
    def couple_share(self) -> float:
        """Bending stiffness of the couple stress, mu l² h, over that of the stress, E h³/12."""
        return 12.0 * SHEAR / self.modulus * self.length_scale**2

    def field(self, q: float) -> float:
        """Field of a load q = 12 (L/h)² B̃ B/(mu0 E), mT."""
        return 1e3 * q * MU0 * self.modulus / (12.0 * REMANENCE * self.ratio**2)

    @property
    def fields(self) -> tuple[float, ...]:
        """Of all loads, mT."""
        return tuple(self.field(q) for q in LOADS)

    @property
    def settings(self) -> ms.Settings:
        """With a tolerance above round-off: next to nothing pulls in the plane, and residuals are relative to that."""
        return ms.Settings(tolerance=1e-5)

    def model(self) -> ms.Model:
        """The model."""
        thickness = LENGTH / self.ratio
        mesh = ms.mesh.rectangle(LENGTH, WIDTH * thickness, (self.divisions, 1))
        material = ms.MicropolarNeoHookean(SHEAR, self.lame_lambda, SHEAR / 10.0, self.length_scale * thickness)
        remanence = ms.remanence.constant((REMANENCE, 0.0, 0.0))
        shell = ms.Shell(mesh, thickness, material, remanence, element=self.element)
        supports: list[ms.Clamp | ms.SymmetryPlane] = [ms.Clamp("left")]
        if self.sides == "mirrored":
            supports += [ms.SymmetryPlane("bottom", (0, 1, 0)), ms.SymmetryPlane("top", (0, 1, 0))]
        fields = [1e-3 * field for field in self.fields]
        field = ms.UniformField((0.0, 0.0, fields[-1]), fields)
        return ms.Model(shell, supports, field, probes={"tip": (LENGTH, 0.0, 0.0)})


def tip(run: Run, strip: Strip, q: float) -> float:
    """Tip deflection over length."""
    return run.at("tip", 3, strip.field(q)) / (1e3 * LENGTH)


def study(runs: Runs) -> Findings:
    """Differences from the elastica by thickness, by theory at L/h = 1000, and by mesh there."""
    findings = Findings()
    findings.tables["elastica"] = _by_ratio(runs)
    findings.tables["theories"] = _by_theory(runs)
    findings.tables["thin-meshes"] = _by_mesh(runs)
    findings.pictures["thinness"] = _picture(runs)
    return findings


def _row(runs: Runs, strip: Strip, stiffer: float = 0.0) -> list[str]:
    """Differences of a strip from the elastica of a stiffness larger by a share."""
    run = runs.of(strip)
    return [percent(tip(run, strip, q), tip_deflection(q / (1.0 + stiffer)), 2) for q in LOADS]


def _header(*words: str) -> tuple[str, ...]:
    return (*words, *(f"q = {q:g}" if q == LOADS[0] else f"{q:g}" for q in LOADS))


def _by_ratio(runs: Runs) -> str:
    rows = [
        ["elastica, $u_3/L$", *(f"{tip_deflection(q):.5f}" for q in LOADS)],
        ["independent table", *(f"{TABLE[q]:.5f}" for q in LOADS)],
        *([f"shell, $L/h$ = {ratio:g} (%)", *_row(runs, Strip(ratio))] for ratio in RATIOS),
    ]
    return table(_header(""), rows)


def _by_theory(runs: Runs) -> str:
    plain, couple = Strip(THIN), Strip(THIN, length_scale=0.1)
    share = f"{100.0 * couple.couple_share:.1f} %"
    rows = [
        ["$\\nu = 0.48$, plane strain", "$E/(1-\\nu^2)$", *_row(runs, plain)],
        ["the same, $l = h/10$", "$E/(1-\\nu^2)$", *_row(runs, couple)],
        [
            "the same, $l = h/10$",
            f"$E/(1-\\nu^2)$ and {share} of couple stress",
            *_row(runs, couple, couple.couple_share),
        ],
        ["$\\nu = 0.25$, plane strain", "$E/(1-\\nu^2)$", *_row(runs, Strip(THIN, SHEAR))],
        ["$\\nu = 0.25$, narrow", "$E$", *_row(runs, Strip(THIN, SHEAR, sides="free"))],
        ["$\\nu = 0.48$, narrow", "$E$", *_row(runs, Strip(THIN, sides="free"))],
    ]
    return table(_header("Strip", "Stiffness of the elastica"), rows, 2)


def _by_mesh(runs: Runs) -> str:
    rows = []
    for element in ("quadratic", "paper", "paper-unenhanced"):
        for divisions in (5, 10, 20, 40):
            strip = Strip(THIN, element=element, divisions=divisions)
            rows.append([f"`{element}`", str(divisions), *_row(runs, strip)])
    return table(_header("Element", "Elements along"), rows)


def _picture(runs: Runs) -> Figure:
    new = figure((13.0, 5.2))
    curve, error = new.subplots(1, 2)
    dress(curve, "$q$", "$u_3/L$ at the tip")
    loads = np.geomspace(0.03, 60.0, 60)
    curve.semilogx(loads, [tip_deflection(q) for q in loads], color=INK, linewidth=1.6, label="elastica")
    dress(error, "$L/h$", "shell − elastica (%)")
    error.set_xscale("log")
    error.set_yscale("log")
    for place, ratio in enumerate(RATIOS):
        strip = Strip(ratio)
        run = runs.of(strip)
        curve.plot(
            LOADS, [tip(run, strip, q) for q in LOADS], linestyle="none", marker="os^Dv"[place],
            markersize=9 - place, color=COLOURS[place], label=f"shell, $L/h$ = {ratio:g}",
        )  # fmt: skip
    for place, q in enumerate((0.1, 1.0, 10.0)):
        off = [100.0 * abs(tip(runs.of(Strip(ratio)), Strip(ratio), q) / tip_deflection(q) - 1.0) for ratio in RATIOS]
        error.plot(RATIOS, off, color=COLOURS[place], marker="os^"[place], linewidth=1.8, label=f"$q$ = {q:g}")
    error.axhline(100.0 * Strip(THIN).couple_share, color=PALE, linestyle="--", linewidth=1.2)
    error.text(1000.0, 105.0 * Strip(THIN).couple_share, "couple stress, $l = h/100$", ha="right", va="bottom", **TEXT)
    curve.set_title("plane strain", **TEXT)
    curve.legend(**LEGEND)
    error.legend(**LEGEND)
    return new
