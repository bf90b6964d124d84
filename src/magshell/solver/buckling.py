r"""Linear buckling: where the tangent along the linear path is singular.

From the state at the start of the last stage the path is taken to be straight: displacements *and* stresses grow in
proportion to the load factor t, by the increment v' = K⁻¹ q per load factor. The mixed tangent along it
(`linear_path.py`) is singular at the multipliers,

    K(t) φ = 0,

a nonlinear eigenproblem, as K(t) is nearly quadratic in t. Its real roots nearest to 0 and their modes are found
without passing one (`eigenproblem.py`), in a unit of t over which the path moves a little, so that they do not depend
on how large the reference load is. No nonlinear equation is solved.

What is left out is how the path bends. With θ the rotation up to the multiplier, its relative error is a few θ in
an arch, and less where the load acts along the stiff direction. Each mode tells θ and the strain; from `FAR` on the
multiplier is not to be relied on.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from magshell.arrays import FloatArray
from magshell.drawing import drawing
from magshell.equations.discretisation import Discretisation
from magshell.errors import InputError
from magshell.linalg import SingularMatrix, make_solver, nested_dissection
from magshell.model.model import Model
from magshell.shell.state import State
from magshell.solver.critical import normalised
from magshell.solver.eigenproblem import NoConvergence, roots_nearest_to_zero
from magshell.solver.events import Observer
from magshell.solver.follower import Follower
from magshell.solver.linear_path import REACH, LinearPath
from magshell.solver.newton import StepFailure, System
from magshell.solver.path import Path, SolveError
from magshell.solver.settings import Settings
from magshell.units import ANGLE, show

# Strain, or rotation in rad, from which the linear path has gone too far for its multiplier to be relied on.
FAR = 0.02


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
    mode : ndarray, shape (nodes, 11)
        Global axes, the largest displacement 1 m.
    strain, rotation : float
        The largest (rad) that the linear path has at that load factor at the points of the integration rule.
    """

    number: int
    stage: int
    load_factor: float
    flux_density: FloatArray
    state: State
    mode: FloatArray
    strain: float
    rotation: float

    @property
    def far(self) -> bool:
        """Whether the linear path has gone too far there for the multiplier to be relied on."""
        return max(self.strain, self.rotation) > FAR

    def __repr__(self) -> str:
        return f"BucklingMode({self.number}: load factor {self.load_factor:.6g} of stage {self.stage + 1})"


class Buckling(NamedTuple):
    """Buckling modes, and the path through the stages before the last one.

    Attributes
    ----------
    path : Path
    modes : list of BucklingMode
    counted : float or None
        Magnitude of the load factor up to which the negative pivots of the tangent tell of no other multipliers; None:
        the linear solver cannot count them.
    complete : bool
        Whether no multiplier of less magnitude than the last mode's is missing, as far as the pivots tell.
    reach : float
        Magnitude of the load factor up to which multipliers are looked for: there the linear path has a strain or a
        rotation (rad) of 0.1. Infinite where the load moves nothing.
    """

    path: Path
    modes: list[BucklingMode]
    counted: float | None
    complete: bool
    reach: float

    @property
    def doubts(self) -> list[str]:
        """What speaks against relying on the multipliers or on their being all, a sentence each."""
        found: list[str] = []
        far = [mode for mode in self.modes if mode.far]
        if far:
            names = f"mode {far[0].number}" if len(far) == 1 else f"modes {far[0].number} to {far[-1].number}"
            turn, strain = show(max(mode.rotation for mode in far), ANGLE), max(mode.strain for mode in far)
            found.append(
                f"{names}: the part turns by up to {turn} and strains by up to "
                f"{100.0 * strain:.2g} % before it buckles; the estimate assumes that it hardly moves. "
                "Follow the path (magshell run)"
            )
        if self.counted is None:
            found.append(f"{self.path.solver_name} counts no negative pivots: a multiplier may have been missed")
        elif not self.complete:
            found.append(
                f"beyond a load factor of ±{self.counted:.6g} the negative pivots of the tangent tell of more "
                "multipliers than were found"
            )
        elif self.counted >= self.reach:
            found.append(
                f"no {'other ' * bool(self.modes)}multiplier up to a load factor of ±{self.reach:.6g}, where the "
                f"linear path turns the part by {show(REACH, ANGLE)} or strains it by {100.0 * REACH:.0f} %, and ends"
                + ("" if self.modes else ". A part that bends at once has none: follow the path (magshell run)")
            )
        return found

    def _repr_html_(self) -> str:
        return str(drawing("buckling_html")(self))


def buckling(
    model: Model, modes: int = 4, settings: Settings | None = None, observers: Sequence[Observer] = ()
) -> Buckling:
    """Critical multipliers of the last stage's loading, about the state that the stages before it lead to.

    Parameters
    ----------
    model : Model
    modes : int
        How many are wanted; there may be fewer, as the linear path ends where it has gone much too far.
    settings : Settings, optional
    observers : sequence of Observer
        Told of the stages before the last.

    Raises
    ------
    InputError
        Not a count of modes that this shell can have, or a field of the body itself.
    SolveError
        The stages before cannot be followed, or the tangent about their end is singular.
    """
    settings = settings or Settings()
    discretisation = Discretisation(model, nested_dissection)
    if not 1 <= modes <= discretisation.dofs - 2:
        raise InputError(f"buckling: modes is {modes}; it must lie between 1 and {discretisation.dofs - 2}")
    if not discretisation.exact_tangent:
        raise InputError(
            "buckling: the tangent does not know how the body's own field follows the body; leave self_field out"
        )
    linear_solver = make_solver(settings.linear_solver)
    path = Path(model, discretisation, settings, linear_solver.name)
    follower = Follower(path, System(discretisation, linear_solver, model.course(0), settings), observers)
    try:
        for observer in observers:
            observer.started(discretisation, settings)
        follower.run(len(model.stages) - 1)
        state = follower.enter(len(model.stages) - 1).state
        path.converged, path.reason = True, "the last stage is reached"
        line = LinearPath(follower.system, state)
        roots = roots_nearest_to_zero(line.tangent, linear_solver, modes, line.reach)
    except (StepFailure, NoConvergence, SingularMatrix) as failure:
        path.reason = str(failure)
        raise SolveError(path.reason, path) from None
    finally:
        for observer in observers:
            observer.finished(path)
    found = []
    for number, (value, vector) in enumerate(roots.pairs, start=1):
        load_factor, size = value * line.unit, abs(value)
        flux_density = follower.system.course.at(load_factor).flux_density
        mode = normalised(discretisation.direction(vector).nodal)
        found.append(
            BucklingMode(
                number=number,
                stage=len(model.stages) - 1,
                load_factor=load_factor,
                flux_density=flux_density,
                state=state,
                mode=mode,
                strain=size * line.strain,
                rotation=size * line.rotation,
            )
        )
    counted = None if roots.counted is None else roots.counted * line.unit
    return Buckling(path, found, counted, roots.complete, line.reach * line.unit)
