"""A strip in a field against its magnetisation: buckling field, both branches, experiment in the reversed field."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

import magshell as ms
from magshell.output.style import COLOURS, INK
from path_study.page import LEGEND, Findings, draw, dress, figure, legend_of_marks, percent, table
from path_study.runs import Place, Runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LENGTH, WIDTH, THICKNESS = 17.2e-3, 5e-3, 0.84e-3
MU, LAME, REMANENCE, MU0 = 303e3, 7300e3, 143e-3, 4e-7 * math.pi
YOUNG, POISSON = MU * (3 * LAME + 2 * MU) / (LAME + MU), LAME / (2 * (LAME + MU))
MEASURED = ((5.043, 0.5453), (7.047, 0.7548), (9.983, 0.7725), (14.99, 0.6686), (25.08, 0.5299), (40.21, 0.4191))
"""Field (mT), reversed, and deflection over length of a real strip; Zhao et al., J. Mech. Phys. Solids 124, 2019."""
MISALIGNED = (0.1, 1.0, 3.0)
"""Angles between the reversed field and the strip, degrees; the experiment does not say which."""
HIGHEST = MEASURED[-1][0] * 1e-3
FINE = ms.Settings(largest_step=0.1)


def strip(
    field: float = HIGHEST,
    angle: float = 0.0,
    length_scale: float = 0.1,
    width: float = WIDTH,
    thickness: float = THICKNESS,
    plane_strain: bool = False,
    law: Any = None,
    stages: Sequence[ms.Stage] = (ms.Stage(),),
    history: Sequence[float] | None = None,
) -> ms.Model:
    """The strip in a field against its magnetisation.

    Parameters
    ----------
    field : float
        T.
    angle : float
        By which the field misses the strip's axis, degrees.
    length_scale : float
        l, in thicknesses.
    width, thickness : float
        m.
    plane_strain : bool
        Sides that cannot move sideways.
    law, stages, history
        Coupling law, stages, multipliers of the field.
    """
    mesh = ms.mesh.rectangle(LENGTH, width, (20, 2))
    material = ms.MicropolarNeoHookean(MU, LAME, MU / 10, length_scale * thickness)
    sides = [ms.SymmetryPlane(side, (0, 1, 0)) for side in ("bottom", "top")] if plane_strain else []
    direction = np.array([-math.cos(math.radians(angle)), 0.0, math.sin(math.radians(angle))])
    return ms.Model(
        ms.Shell(mesh, thickness, material, ms.remanence.constant((REMANENCE, 0, 0))),
        supports=[ms.Clamp("left"), *sides],
        field=ms.UniformField(field * direction, [1e-3 * at for at, _ in MEASURED if 1e-3 * at <= field], history),
        coupling=law or ms.MicropolarCouple(),
        probes={"tip": (LENGTH, 0.5 * width, 0)},
        stages=stages,
    )


# -- elastica --------------------------------------------------------------------------------------------------------


def elastica_field(young: float = YOUNG, thickness: float = THICKNESS) -> float:
    """Field at which the elastica buckles, q = π²/4, mT."""
    return 1e3 * math.pi**2 / 4.0 * MU0 * young / (12.0 * REMANENCE) * (thickness / LENGTH) ** 2


def elastica_deflection(q: float) -> float:
    """Tip deflection over length: of θ'' + q sin θ = 0, θ(0) = θ'(1) = 0, it is 2k/√q with K(k) = √q."""
    from scipy.optimize import brentq
    from scipy.special import ellipk

    if q <= math.pi**2 / 4.0:
        return 0.0
    k = brentq(lambda k: float(ellipk(k**2)) - math.sqrt(q), 1e-9, 1.0 - 1e-15)
    return 2.0 * k / math.sqrt(q)


# -- buckling field --------------------------------------------------------------------------------------------------

STRAIN_YOUNG = YOUNG / (1.0 - POISSON**2)
VARIANTS: dict[str, dict[str, Any]] = {
    "as it is": {},
    "law `micro-rotation`": {"law": ms.MicroRotationEnergy()},
    "law `deformation-gradient`": {"law": ms.DeformationGradientEnergy()},
    "without couple stress, $l = h/100$": {"length_scale": 0.01},
    "the same, two thicknesses wide": {"length_scale": 0.01, "width": 2 * THICKNESS},
    "the same, a fifth as thick": {"length_scale": 0.01, "width": 0.4 * THICKNESS, "thickness": 0.2 * THICKNESS},
    "sides held, plane strain": {"plane_strain": True},
    "the same, without couple stress": {"plane_strain": True, "length_scale": 0.01},
}


def _buckling(runs: Runs) -> tuple[str, float]:
    rows, fields = [], {}
    for words, keys in VARIANTS.items():
        stress, strain = (elastica_field(young, keys.get("thickness", THICKNESS)) for young in (YOUNG, STRAIN_YOUNG))
        trace = runs.of(f"strip, {words}", lambda keys=keys, top=1.2e-3 * strain: strip(top, **keys))
        (point,) = trace.critical
        fields[words] = strength(point)
        rows.append(
            (words, f"{fields[words]:.4f}", percent(fields[words], stress, 2), percent(fields[words], strain, 2))
        )
    model = strip(elastica_field() * 1e-3)
    linear = runs.store.get("strip, linear buckling", lambda: {"cpu": 0.0, "field": _linear(model)})["field"]
    off = [percent(linear, elastica_field(young), 2) for young in (YOUNG, STRAIN_YOUNG)]
    rows.insert(1, ("the same by linear buckling", f"{linear:.4f}", *off))
    header = ("Strip", "Buckles at (mT)", "from the elastica, plane stress (%)", "plane strain (%)")
    return table(header, rows), fields["as it is"]


def _linear(model: ms.Model) -> float:
    first = next(mode for mode in ms.buckling(model, modes=2).modes if mode.load_factor > 0.0)
    return 1e3 * float(np.linalg.norm(first.flux_density))


# -- page ------------------------------------------------------------------------------------------------------------


def strength(place: Place) -> float:
    """|B|, mT."""
    return math.hypot(*place.flux_density)


def tip(place: Place) -> float:
    """u3 of the tip over the length."""
    return place.u("tip", 3) / (1e3 * LENGTH)


def study(runs: Runs) -> Findings:
    """Buckling field, branches, and the experiment."""
    buckling, critical_field = _buckling(runs)
    stages = (ms.Stage(), *(ms.Stage(control="arc-length", branch=1, side=side) for side in (1, -1)))
    both = runs.of("strip, both branches", lambda: strip(stages=stages, history=(0.25, 1.0, 1.0)), FINE)
    turned = {
        angle: runs.of(f"strip, {angle:g}°", lambda angle=angle: strip(angle=angle), FINE) for angle in MISALIGNED
    }
    for name, trace in {"branches": both, **turned}.items():
        if trace.reason:
            raise SystemExit(f"strip, {name}: {trace.reason}")
    one, other = (
        {round(strength(p), 6): p.u("tip", 3) for p in both.stages(number) if p.kind == "step"} for number in (1, 2)
    )
    shared = sorted(set(one) & set(other))
    worst = max(abs(one[at] + other[at]) for at in shared) / max(map(abs, one.values()))
    mirror = (
        f"The two branches are mirror images: at {len(shared)} fields their deflections differ by {worst:.0e} at most."
    )
    blocks = {
        "buckling": buckling,
        "mirror": mirror,
        "reversed": _reversed({"0° (branch)": both.stages(2), **{f"{a:g}°": t.places for a, t in turned.items()}}),
    }
    return Findings(blocks, {"strip": _picture(both.places, {a: t.places for a, t in turned.items()}, critical_field)})


def _reversed(paths: dict[str, Sequence[Place]]) -> str:
    rows = []
    for field, measured in MEASURED:
        values = [next(abs(tip(p)) for p in places if abs(strength(p) - field) < 1e-9) for places in paths.values()]
        cells = (f"{value:.4f} ({percent(value, measured)} %)" for value in values)
        rows.append([f"{field:g}", f"{measured:.4f}", *cells])
    return table(("Field (mT)", "Measured $u_3/L$", *paths), rows)


def _picture(both: Sequence[Place], turned: dict[float, Sequence[Place]], critical_field: float) -> Figure:
    new = figure((13.0, 5.6))
    near, whole = new.subplots(1, 2)
    dress(near, "reversed field (mT)", "$u_3/L$ of the tip")
    for number in range(3):
        branch = [place for place in both if place.stage == number or (number and place.kind == "bifurcation")]
        draw(near, _sorted(branch), strength, tip, COLOURS[0], "no misalignment" if number == 0 else "")
    fields = np.linspace(critical_field, 10.0, 300)
    shape = [elastica_deflection(math.pi**2 / 4.0 * field / critical_field) for field in fields]
    look = {"color": INK, "linewidth": 1.2, "linestyle": ":"}
    near.plot(fields, shape, label="elastica", **look)
    near.plot(fields, -np.array(shape), **look)
    for place, (angle, places) in enumerate(turned.items()):
        for axes in (near, whole):
            colour = COLOURS[(2, 3, 4)[place]]
            draw(axes, places, strength, tip, colour, f"field {angle:g}° off" if axes is whole else "", linewidth=1.6)
    near.set_xlim(0.0, 10.0)
    near.set_ylim(-0.85, 0.85)
    dress(whole, "reversed field (mT)", "")
    whole.plot(*zip(*MEASURED, strict=True), "o", color=INK, markersize=8, markerfacecolor="white", markeredgewidth=1.8,
               label="measured", zorder=6)  # fmt: skip
    whole.set_xlim(0.0, 42.0)
    whole.set_ylim(0.0, 0.85)
    legend_of_marks(near, ["bifurcation"])
    near.legend(loc="lower left", **{**LEGEND, "fontsize": 11})
    whole.legend(loc="lower right", **LEGEND)
    return new


def _sorted(places: Sequence[Place]) -> list[Place]:
    return sorted(places, key=lambda place: place.arc_length)
