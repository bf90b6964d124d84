"""Random models: shells, materials, remanences and loads as nobody chose them, and how their paths end.

Each is made from its number alone: always the same. Thickness ratios go from 5 to 1000 and loads up to several rolls,
on meshes that nobody checked for them; a part of the paths cannot be followed to the end, and has to say why.
"""

from __future__ import annotations

import math
import pathlib
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import magshell as ms
from magshell.mesh import Mesh
from path_study.page import Findings, number, table
from path_study.runs import Runs

SEED, COUNT = 2026, 160
LIMIT = 30.0
"""CPU seconds that a path may take, without the compilation of its kernels."""
COARSE, LIMITED = "mesh too coarse for the bending", "couple at the limit of the micro-rotation"
REFINED = 2
"""Every path that does not reach its end is followed again with so many times the elements in both directions, and
with a coupling modulus equal to the shear modulus."""

MU0 = 4e-7 * math.pi
KNOWN = ("unfinished-015", "unfinished-081", "unfinished-122", "stopped-039", "stopped-061", "stopped-091",
         "stopped-111", "stopped-159")  # fmt: skip
"""Problem files of another generator like this one, whose paths once ended without a cause, or not at all."""
CASES = pathlib.Path(__file__).parents[2] / "tests" / "solver" / "cases"
CAUSES = {
    LIMITED: "reaches the limit of what the micro-rotation",
    COARSE: "the mesh is too coarse for the bending",
    "material squashed": "the material is squashed",
    "element at a support turned inside out": "which is turned inside out, touches",
    "to and fro, nothing else": "came no nearer to the next stop",
}
"""What the statistics call a cause, and the words of the message; the first that applies counts."""
FINER, STIFFER = "times as many elements", "larger coupling_modulus"
"""Words of the message that name a finer mesh, and a stiffer coupling, as what to do."""
UNKNOWN, ENDED, UNFINISHED = "nothing stands out", "end of the path", f"not ended in {LIMIT:g} CPU s"


@dataclass(frozen=True)
class Drawn:
    """A random model, and what was drawn for it in words."""

    words: str
    model: ms.Model


def draw(which: int, refined: int = 1, coupling_ratio: float = 0.1) -> Drawn:
    """The random model of a number.

    `refined` times as many elements in both directions; `coupling_ratio`: the coupling modulus over the shear modulus.
    """
    rng = np.random.default_rng([SEED, which])
    name, make = SHAPES[rng.integers(len(SHAPES))]
    mesh, groups, size = make(rng, refined)
    ratio = float(np.exp(rng.uniform(math.log(5.0), math.log(1000.0))))
    thickness = size / ratio
    mu = 1e3 * float(np.exp(rng.uniform(math.log(50.0), math.log(800.0))))
    lam = mu * float(np.exp(rng.uniform(math.log(0.5), math.log(40.0))))
    law, coupling = PAIRS[rng.choice(len(PAIRS), p=SHARES)]
    material = law(mu, lam, coupling_ratio * mu, thickness / 10.0)
    magnitude = 1e-3 * float(rng.uniform(20.0, 150.0))
    kind, remanence = _remanence(rng, magnitude, size)
    beta = float(np.exp(rng.uniform(0.0, math.log(2000.0))))
    young = mu * (3.0 * lam + 2.0 * mu) / (lam + mu)
    direction = _unit(rng)
    field = beta * MU0 * young / (12.0 * magnitude * ratio**2) * direction
    loading = str(rng.choice(["load", "updown", "rotate"]))
    stages = [ms.Stage()] if loading == "load" else [ms.Stage(), ms.Stage(control="arc-length")]
    turning: dict[str, Any] = {"history": [1.0] * len(stages)}
    if loading == "updown":
        turning = {"history": [1.0, 0.0]}
    elif loading == "rotate":
        turning |= {"rotation_axis": _unit(rng), "rotation": [0.0, math.pi]}
    held = list(rng.permutation(groups))
    supports: list[Any] = [ms.Clamp(str(held[0]))]
    if len(held) > 1 and rng.random() < 0.2:
        supports.append((ms.Clamp if rng.random() < 0.5 else ms.SimpleSupport)(str(held[1])))
    model = ms.Model(
        ms.Shell(mesh, thickness, material, remanence), supports, ms.UniformField(field, **turning), coupling(),
        stages=stages,
    )  # fmt: skip
    words = (
        f"{name}, L/h {ratio:.0f}, load {beta:.0f}, {kind} remanence, {loading}, {law.__name__}, {coupling.__name__}"
    )
    return Drawn(words, model)


Shape = tuple[Mesh, list[str], float]
"""A mesh, its edge groups, and a length that says how large it is, m."""


def _unit(rng: np.random.Generator) -> np.ndarray:
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def _counts(rng: np.random.Generator, refined: int) -> tuple[int, int]:
    """Elements in both directions: from few to 32 in all."""
    first = int(rng.integers(3, 13))
    return refined * first, refined * int(rng.integers(1, 32 // first + 1))


def _rectangle(rng: np.random.Generator, refined: int) -> Shape:
    length = 1e-3 * rng.uniform(5.0, 25.0)
    mesh = ms.mesh.rectangle(length, length * rng.uniform(0.15, 1.0), _counts(rng, refined))
    return mesh, ["left", "right", "bottom", "top"], length


def _annulus(rng: np.random.Generator, refined: int) -> Shape:
    outer = 1e-3 * rng.uniform(5.0, 25.0)
    around, across = _counts(rng, refined)
    counts = (max(across // 2, 1), max(around, 8 * refined))
    return ms.mesh.annulus(outer * rng.uniform(0.3, 0.7), outer, counts), ["inner", "outer"], 2.0 * outer


def _cylinder(rng: np.random.Generator, refined: int) -> Shape:
    radius = 1e-3 * rng.uniform(4.0, 12.0)
    around, along = _counts(rng, refined)
    mesh = ms.mesh.cylinder(radius, radius * rng.uniform(0.5, 3.0), (max(around, 8 * refined), along))
    return mesh, ["start", "end"], 2.0 * radius


def _sphere(rng: np.random.Generator, refined: int) -> Shape:
    polar, azimuth = (rng.uniform(30.0, 50.0), rng.uniform(75.0, 150.0)), (0.0, rng.uniform(60.0, 230.0))
    radius = 1e-3 * rng.uniform(6.0, 13.0)
    down, around = _counts(rng, refined)
    mesh = ms.mesh.sphere_patch(radius, polar, azimuth, (down, max(around, 2 * refined)))
    return mesh, ["top", "bottom", "left", "right"], 2.0 * radius


SHAPES: Sequence[tuple[str, Callable[[np.random.Generator, int], Shape]]] = [
    ("rectangle", _rectangle),
    ("annulus", _annulus),
    ("cylinder", _cylinder),
    ("sphere patch", _sphere),
]
PAIRS: Sequence[tuple[type, type]] = [
    (ms.MicropolarNeoHookean, ms.MicropolarCouple),
    (ms.MicropolarNeoHookean, ms.MicroRotationEnergy),
    (ms.MicropolarNeoHookean, ms.DeformationGradientEnergy),
    (ms.MicropolarMooneyRivlin, ms.MicropolarCouple),
    (ms.MicropolarStVenantKirchhoff, ms.MicropolarCouple),
]
SHARES = (0.4, 0.15, 0.15, 0.15, 0.15)


def _remanence(rng: np.random.Generator, magnitude: float, size: float) -> tuple[str, Any]:
    """Constant, radial, a smooth function of the position, or a table of places."""
    kind = str(rng.choice(["constant", "radial", "smooth", "tabulated"]))
    if kind == "constant":
        return kind, ms.remanence.constant(magnitude * _unit(rng))
    if kind == "radial":
        return kind, ms.remanence.radial(magnitude, through=(0.37 * size, 0.21 * size, -size))
    waves, phases = rng.normal(size=(3, 3)) * 2.0 / size, rng.uniform(0.0, 2.0 * math.pi, 3)

    def smooth(points: np.ndarray) -> np.ndarray:
        values = np.sin(points @ waves.T + phases)
        return magnitude * values / math.sqrt(3.0)

    if kind == "smooth":
        return kind, ms.remanence.function(smooth)
    grid = np.linspace(-1.6, 1.6, 9) * size
    places = np.stack(np.meshgrid(grid, grid, grid), axis=-1).reshape(-1, 3)
    return kind, ms.remanence.at_places(places, smooth(places), tolerance=size)


@dataclass(frozen=True)
class Ending:
    """How the path of a random model ends.

    Attributes
    ----------
    words : str
        The model.
    ending : str
        `ENDED`, `UNFINISHED`, a cause or `UNKNOWN`.
    reason : str
        The message; "" at the end of the path.
    reached : float
        Load factors of all stages together, over their number.
    steps, solves, cuts : int
    cpu : float
        s, without compilation.
    """

    words: str
    ending: str
    reason: str
    reached: float
    steps: int
    solves: int
    cuts: int
    cpu: float


class OutOfTime(Exception):
    """The limit is passed."""


class Clock(ms.Observer):
    """CPU time since the undeformed state, which all kernels have been compiled for."""

    def __init__(self, limit: float) -> None:
        self.limit, self.begin = limit, np.inf

    def converged(self, step: ms.Step) -> None:
        if not step.number:
            self.begin = time.process_time()

    def iterated(self, iteration: Any) -> None:
        if self.seconds > self.limit:
            raise OutOfTime

    def finished(self, path: ms.Path) -> None:
        self.path = path

    @property
    def seconds(self) -> float:
        return max(time.process_time() - self.begin, 0.0)


def ending_of(which: int, refined: int = 1, coupling_ratio: float = 0.1) -> Ending:
    """Follow the path of a random model."""
    return ending(draw(which, refined, coupling_ratio))


def known(name: str) -> Ending:
    """Follow the path of one of `KNOWN`."""
    problem = ms.problem.load(str(CASES / f"{name}.toml"))
    return ending(Drawn(problem.file.title, problem.model))


def ending(drawn: Drawn, limit: float = LIMIT) -> Ending:
    """Follow the path of a model."""
    clock, reason = Clock(limit), ""
    try:
        ms.solve(drawn.model, observers=[clock])
        found = ENDED
    except ms.SolveError as failure:
        reason = failure.reason
        found = next((cause for cause, said in CAUSES.items() if said in reason), UNKNOWN)
    except OutOfTime:
        found = UNFINISHED
    path, last = clock.path, clock.path.steps[-1]
    reached = (last.stage + max(last.load_factor, 0.0)) / len(drawn.model.stages)
    return Ending(drawn.words, found, reason, reached, len(path.steps) - 1, path.solves, path.cuts, clock.seconds)


def study(runs: Runs) -> Findings:
    """How the paths end, and whether finer meshes help those that want one."""
    endings = {which: _kept(runs, which) for which in range(COUNT)}
    rows = []
    for ending in (ENDED, *CAUSES, UNKNOWN, UNFINISHED):
        some = [one for one in endings.values() if one.ending == ending]
        figures = ["–"] * 4
        if some:
            cpu, solves = [one.cpu for one in some], [one.solves for one in some]
            figures = [
                number(float(np.median(cpu)), 2),
                number(max(cpu), 2),
                f"{np.median(solves):.0f}",
                str(max(solves)),
            ]
        rows.append([ending, str(len(some)), *figures])
    head = ["Path ends with", "Models", "CPU s, median", "longest", "Linear solves, median", "most"]
    words = _remedies(runs, endings)
    others = {name: _stored(runs, name, lambda name=name: known(name)) for name in KNOWN}
    known_rows = [
        [f"`{name}`", one.ending, f"{100.0 * one.reached:.3g}", number(one.cpu, 2), str(one.solves)]
        for name, one in others.items()
    ]
    known_head = ["Model", "Path ends with", "Reached (%)", "CPU s", "Linear solves"]
    blocks = {"random": table(head, rows), "random-refined": words, "random-known": table(known_head, known_rows, 2)}
    return Findings(blocks)


def _remedies(runs: Runs, endings: dict[int, Ending]) -> str:
    """What becomes of the paths that do not reach their end with a finer mesh, and with a stiffer coupling."""
    stopped = {which: one for which, one in endings.items() if one.ending != ENDED}
    finer = {which: _kept(runs, which, refined=REFINED) for which in stopped}
    stiffer = {which: _kept(runs, which, coupling_ratio=1.0) for which in stopped}
    meshed, coupled = ({which for which, one in some.items() if one.ending == ENDED} for some in (finer, stiffer))
    named = {which: _remedies_named(one.reason) for which, one in stopped.items()}
    solved = {FINER: meshed, STIFFER: coupled}
    first = sum(which in solved[words] for which, some in named.items() for words in some[:1])
    any_one = sum(any(which in solved[words] for words in some) for which, some in named.items())
    both = sum(len(some) == len(solved) for some in named.values())
    ended, solvable = len(endings) - len(stopped), len(endings) - len(stopped) + len(meshed | coupled)
    steps, cuts = (sum(getattr(one, name) for one in endings.values()) for name in ("steps", "cuts"))
    return (
        f"All paths together take {steps} steps and {cuts} cuts. Of the {len(stopped)} models that do not reach the "
        f"end, {len(meshed)} do so with {REFINED} times as many elements in both directions, {len(coupled)} with a "
        f"coupling modulus equal to the shear modulus, {len(meshed | coupled)} with one or the other: {first} of these "
        f"with what the message names first, {any_one} with one that it names ({both} of the {len(stopped)} messages "
        f"name both). So {solvable} of {len(endings)} can be solved within {LIMIT:g} CPU s, and "
        f"{ended} of these, {100.0 * ended / solvable:.0f} %, are solved as they are drawn."
    )


def _remedies_named(reason: str) -> list[str]:
    """Those that a message names, in its order."""
    return sorted((words for words in (FINER, STIFFER) if words in reason), key=reason.index)


def _kept(runs: Runs, which: int, refined: int = 1, coupling_ratio: float = 0.1) -> Ending:
    changes = f", {refined} times as fine" * (refined > 1) + ", stiffly coupled" * (coupling_ratio == 1.0)
    return _stored(runs, f"random {which}{changes}", lambda: ending_of(which, refined, coupling_ratio))


def _stored(runs: Runs, name: str, make: Callable[[], Ending]) -> Ending:
    def solved() -> dict[str, Any]:
        found = make()
        print(f"  {name}: {found.words}: {found.ending}, {found.solves} solves, {found.cpu:.1f} s", flush=True)
        return asdict(found)

    return Ending(**runs.store.get(name, solved))
