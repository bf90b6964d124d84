"""Small shells, and a record of what a solve tells its observers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import magshell as ms
from magshell import Model, Observer, Path, Step
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import make_solver
from magshell.shell.state import State

LENGTH, WIDTH, THICKNESS = 11e-3, 5e-3, 1.1e-3
MU, LAMBDA = 303e3, 7300e3


def rubber(thickness: float = THICKNESS, coupling: float = 0.1, length: float = 0.1) -> ms.MicropolarNeoHookean:
    """The strips' material; coupling modulus in mu, length scale in thicknesses."""
    return ms.MicropolarNeoHookean(MU, LAMBDA, coupling * MU, length * thickness)


def strip(
    elements: tuple[int, int] = (4, 1),
    supports: Sequence[Any] | None = None,
    field: Sequence[float] = (0.0, 0.0, 20e-3),
    stops: Sequence[float] = (),
    remanence: Sequence[float] = (143e-3, 0.0, 0.0),
    material: Any = None,
    coupling: Any = None,
) -> Model:
    """A thick strip, clamped on the left and turned up by the field unless told otherwise; probe `tip`."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    shell = ms.Shell(mesh, THICKNESS, material or rubber(), ms.remanence.constant(remanence))
    held = [ms.Clamp("left")] if supports is None else supports
    return Model(shell, held, ms.UniformField(field, stops), coupling, probes={"tip": (LENGTH, 0, 0)})


def arm(
    elements: tuple[int, int] = (6, 2),
    field: float = 10e-3,
    stops: Sequence[float] = (),
    element: str = "quadratic",
    stretch: str = "linear",
    **options: Any,
) -> Model:
    """A gripper's arm in a coarse mesh: part of a sphere, clamped near the pole, magnetised along its meridians."""
    mesh = ms.mesh.sphere_patch(22.918e-3, polar=(15, 165), azimuth=(-15, 15), elements=elements)
    material = ms.MicropolarNeoHookean(135e3, 3.25e6, 13.5e3, 9e-5)
    shell = ms.Shell(mesh, 0.9e-3, material, ms.remanence.meridional(94e-3), element, stretch)
    return Model(shell, [ms.Clamp("top")], ms.UniformField([0, 0, field], stops), **options)


def in_parts(model: Model) -> Model:
    """A third thicker and flush, a third of two layers of which one is stiff and one magnetised."""
    shell = model.shell
    _, second, third = np.array_split(np.arange(len(shell.mesh.elements)), 3)
    stiff = ms.MicropolarMooneyRivlin(400e3, 2e6, 40e3, 9e-5)
    layers = [ms.Layer(0.2e-3, stiff), ms.Layer(0.5e-3, shell.material, shell.remanence)]
    regions = [ms.Region(second, 1.1e-3, offset=0.1e-3), ms.Region(third, layers=layers)]
    return replace(model, shell=replace(shell, regions=regions))


def contents(state: State) -> bytes:
    """All values of a state."""
    return b"".join(np.ascontiguousarray(values).tobytes() for values in state)


def last_correction(path: Path) -> float:
    """Largest change of u by one more Newton iteration, m: the error of the last state, to first order."""
    discretisation, step = path.discretisation, path.steps[-1]
    assembly = discretisation.assemble(Instant(step.state, discretisation.model.loading(step.load_factor)))
    assert assembly.matrix is not None
    factors = make_solver("superlu").factorise(assembly.matrix)
    return float(np.abs(discretisation.direction(factors.solve(assembly.right_side)).nodal[:, :3]).max())


def equation_numbers(discretisation: Discretisation) -> np.ndarray:
    """Equation of each nodal component, shape (nodes, 11); -1 where it is held or absent."""
    return discretisation.direction(np.arange(1.0, discretisation.dofs + 1.0)).nodal.astype(int) - 1


def central_difference(discretisation: Discretisation, state: State, increment: np.ndarray, step: float) -> np.ndarray:
    """Minus the derivative of the right side (dofs,) at load factor 1 along an increment (nodes, 11) of size `step`.

    The enhanced parameters follow, as the condensed tangent has it.
    """

    def right_side(sign: float) -> np.ndarray:
        discretisation.assemble(Instant(state, discretisation.model.loading(1.0)))
        moved = state.moved(sign * increment, discretisation.shell.recovered(sign * increment, whole=True))
        return discretisation.assemble(Instant(moved, discretisation.model.loading(1.0))).right_side

    return (right_side(-1.0) - right_side(1.0)) / (2 * step)


class Record(Observer):
    """Names of the calls in order, their arguments, and the bytes of every converged state."""

    def __init__(self) -> None:
        self.calls: list[str] = []
        self.iterations: list[Any] = []
        self.steps: list[Step] = []
        self.bytes: list[bytes] = []
        self.cuts: list[tuple[float, str]] = []
        self.path: Path | None = None

    def started(self, discretisation: Any, settings: Any) -> None:
        self.calls.append("started")
        self.discretisation, self.settings = discretisation, settings

    def iterated(self, iteration: Any) -> None:
        self.calls.append("iterated")
        self.iterations.append(iteration)

    def converged(self, step: Step) -> None:
        self.calls.append("converged")
        self.steps.append(step)
        self.bytes.append(contents(step.state))

    def cut(self, load_factor: float, reason: str) -> None:
        self.calls.append("cut")
        self.cuts.append((load_factor, reason))
        assert contents(self.steps[-1].state) == self.bytes[-1], f"the cut at {load_factor} changed the last state"

    def finished(self, path: Path) -> None:
        self.calls.append("finished")
        self.path = path
