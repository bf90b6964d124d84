r"""Linear buckling: where the tangent would become singular if it went on changing as it begins to.

About the state at the start of the last stage, with its load factor t from there on, the tangent along the path is

    K(t) = K + t K' + O(t²),      K' = dK/dt = ∂K/∂v · v' + ∂K/∂t,      v' = K⁻¹ q,

so that (K + t K') φ = 0 has the solutions t = 1/ν with the eigenvalues of largest magnitude in -K⁻¹ K' φ = ν φ: shift
and invert about t = 0 (Arnoldi, by ARPACK). K' is a central difference along the path. The estimate is good where the
shell moves little before it buckles, and as bad as that assumption elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.assembly import Discretisation, InvertedElement
from magshell.errors import InputError, SolveError
from magshell.linalg import make_solver, nested_dissection
from magshell.model import Model
from magshell.shell.state import State
from magshell.solver.constraints import Metric
from magshell.solver.critical import normalised
from magshell.solver.events import Observer
from magshell.solver.follower import Follower
from magshell.solver.newton import Solution, StepFailure, System, Trial
from magshell.solver.path import Path
from magshell.solver.settings import Settings
from magshell.solver.track import Slope, point_at

# Length of the path, displacements over the body's size, over which K' is differenced to either side.
DIFFERENCE = 1e-6
# An eigenvalue counts as real with an imaginary part up to this share of it.
REAL = 1e-6


class BucklingMode(NamedTuple):
    """A critical multiplier about a loaded state.

    Attributes
    ----------
    number : int
        From 1, the multiplier nearest to 0 first.
    stage : int
    load_factor : float
        Of the last stage; negative: its loading reversed.
    flux_density : ndarray, shape (3,)
        At that load factor, T.
    state : State
        About which it is.
    mode : ndarray, shape (nodes, 10)
        Global axes, the largest displacement 1 m.
    """

    number: int
    stage: int
    load_factor: float
    flux_density: FloatArray
    state: State
    mode: FloatArray

    def __repr__(self) -> str:
        return f"BucklingMode({self.number}: load factor {self.load_factor:.6g} of stage {self.stage + 1})"


class Buckling(NamedTuple):
    """Buckling modes, and the path through the stages before the last one."""

    path: Path
    modes: list[BucklingMode]

    def _repr_html_(self) -> str:
        from magshell.output.notebook import buckling_html

        return buckling_html(self)


def buckling(
    model: Model, modes: int = 4, settings: Settings | None = None, observers: Sequence[Observer] = ()
) -> Buckling:
    """Critical multipliers of the last stage's loading, about the state that the stages before it lead to.

    Parameters
    ----------
    model : Model
    modes : int
        How many are wanted; there may be fewer, as only real ones are kept.
    settings : Settings, optional
    observers : sequence of Observer
        Told of the stages before the last.

    Raises
    ------
    InputError
        Not a count of modes that this shell can have.
    SolveError
        The stages before cannot be followed, or the tangent about their end is singular.
    """
    settings = settings or Settings()
    discretisation = Discretisation(model, nested_dissection)
    if not 1 <= modes <= discretisation.dofs - 2:
        raise InputError(f"buckling: modes is {modes}; it must lie between 1 and {discretisation.dofs - 2}")
    linear_solver = make_solver(settings.linear_solver)
    path = Path(model, discretisation, settings, linear_solver.name)
    follower = Follower(path, System(discretisation, linear_solver, model.course(0), settings), observers)
    try:
        for observer in observers:
            observer.started(discretisation, settings)
        follower.run(len(model.stages) - 1)
        state, arc_length = follower.enter(len(model.stages) - 1)[:2]
        path.converged, path.reason = True, "the last stage is reached"
        slope = _slope(follower.system, follower.metric, state, arc_length)
        load_factors, vectors = _eigenpairs(follower.system, state, slope, modes)
    except StepFailure as failure:
        path.reason = str(failure)
        raise SolveError(path.reason, path) from None
    finally:
        for observer in observers:
            observer.finished(path)
    course, found = follower.system.course, []
    for number, (load_factor, vector) in enumerate(zip(load_factors.tolist(), vectors, strict=True), start=1):
        mode = normalised(discretisation.expand(vector))
        flux_density = course.at(load_factor).flux_density
        found.append(BucklingMode(number, len(model.stages) - 1, load_factor, flux_density, state, mode))
    return Buckling(path, found)


def _slope(system: System, metric: Metric, state: State, arc_length: float) -> Slope:
    """The direction of the path at the start of the stage; leaves its tangent factorised."""
    trial = Trial(state, 0.0, system.discretisation.stresses_at(state))
    solution = Solution(trial, system.assemble(trial), [0.0], None)
    return point_at(system, metric, solution, arc_length, (np.zeros_like(state.u), 1.0)).slope


def _eigenpairs(system: System, state: State, slope: Slope, wanted: int) -> tuple[FloatArray, list[FloatArray]]:
    """Load factors, rising in magnitude, and their modes (dofs,)."""
    from scipy.sparse.linalg import ArpackError, LinearOperator, eigs

    ahead, back = (_tangent(system, state, slope, side * DIFFERENCE) for side in (1.0, -1.0))
    change = (ahead - back) / (2.0 * DIFFERENCE * slope.load)
    solve, size = system.linear_solver.solve, system.discretisation.dofs
    operator = LinearOperator((size, size), matvec=lambda vector: -solve(change @ vector), dtype=float)
    start = np.random.default_rng(0).normal(size=size)
    try:
        values, vectors = eigs(operator, k=wanted, which="LM", v0=start)
    except ArpackError as error:
        raise StepFailure(f"the eigenvalues do not converge: {error}") from None
    real = np.flatnonzero((np.abs(values.imag) <= REAL * np.abs(values)) & (np.abs(values) > 0.0))
    real = real[np.argsort(-np.abs(values[real]))]
    return 1.0 / values[real].real, [vectors[:, number].real for number in real]


def _tangent(system: System, state: State, slope: Slope, distance: float) -> sp.csc_array:
    """A copy of the plain tangent a distance along the path."""
    moved = state.moved(distance * slope.increment, distance * slope.d_alpha)
    try:
        assembly = system.discretisation.assemble(moved, system.course.at(distance * slope.load))
    except InvertedElement as inverted:
        raise StepFailure(f"element {inverted.element} is turned inside out next to the state") from None
    assert assembly.matrix is not None
    return assembly.matrix.copy()
