"""The result of a solve: converged steps along the load path."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.drawing import drawing
from magshell.equations.discretisation import Discretisation
from magshell.errors import InputError, suggest
from magshell.evaluation.balance import largest_imbalances
from magshell.evaluation.converged import converged
from magshell.evaluation.maxima import described
from magshell.evaluation.outputs import find
from magshell.linalg import nested_dissection
from magshell.model.course import Course, Loading
from magshell.model.model import Model
from magshell.solver.critical import CriticalPoint
from magshell.solver.history import History
from magshell.solver.settings import Settings
from magshell.solver.step import Step
from magshell.solver.waypoint import Waypoint


class Probe(NamedTuple):
    """A node along the path: load_factor (n,), flux_density (n, 3) in T (or NaN), displacement u (n, 3) in m."""

    load_factor: FloatArray
    flux_density: FloatArray
    u: FloatArray

    @property
    def u1(self) -> FloatArray:
        """Component along X1, m."""
        return self.u[:, 0]

    @property
    def u2(self) -> FloatArray:
        """Component along X2, m."""
        return self.u[:, 1]

    @property
    def u3(self) -> FloatArray:
        """Component along X3, m."""
        return self.u[:, 2]


@dataclass
class Path:
    """Converged steps, and how they were obtained.

    Attributes
    ----------
    model : Model
    discretisation : Discretisation
    settings : Settings
    solver_name : str
        Linear solver in use.
    steps : list of Step
        The undeformed state first.
    courses : list of Course
        The loading of each stage that was begun.
    critical_points : list of CriticalPoint
        Limit points and bifurcations passed.
    converged : bool
        Whether the end of the last stage was reached.
    reason : str
        Why the path ends where it does.
    solves, cuts : int
        Linear solves in all, those of cut steps included; cuts.
    cpu_seconds : float
    trail : list of Waypoint
        Of the last steps, up to three: with `steps`, all that going on depends on.
    """

    model: Model
    discretisation: Discretisation
    settings: Settings
    solver_name: str
    steps: list[Step] = field(default_factory=list)
    courses: list[Course] = field(default_factory=list)
    critical_points: list[CriticalPoint] = field(default_factory=list)
    converged: bool = False
    reason: str = "not finished"
    solves: int = 0
    cuts: int = 0
    cpu_seconds: float = 0.0
    trail: list[Waypoint] = field(default_factory=list)
    _solving: threading.Lock = field(default_factory=threading.Lock, init=False, repr=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        """What a pickle or a copy has: all but the equations, whose laws have addresses in this process only."""
        left_out = ("discretisation", "history", "_solving")
        return {name: value for name, value in self.__dict__.items() if name not in left_out}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, discretisation=Discretisation(state["model"], nested_dissection))
        self._solving = threading.Lock()

    def __repr__(self) -> str:
        return f"Path({max(len(self.steps) - 1, 0)} steps, {self.discretisation.dofs} unknowns: {self.reason})"

    def _repr_html_(self) -> str:
        return str(drawing("path_html")(self))

    @contextmanager
    def solving(self) -> Iterator[None]:
        """While this lasts nobody else can lengthen the path.

        Raises
        ------
        InputError
            Somebody does already.
        """
        if not self._solving.acquire(blocking=False):
            raise InputError("this path is being solved already, by another thread or the one that calls an observer")
        try:
            yield
        finally:
            self._solving.release()

    def add(self, waypoint: Waypoint) -> None:
        """Lengthen the path by a converged step."""
        self.critical_points.extend(waypoint.critical_points)
        self.cuts, self.solves, self.cpu_seconds = waypoint.cuts, waypoint.solves, waypoint.cpu_seconds
        self.trail = [*self.trail[-2:], waypoint]
        self.steps.append(waypoint.step)

    def end(self) -> None:
        """Note that the last step is the end of the last stage."""
        self.converged, self.reason = True, "the end of the path is reached"

    def probe(self, name: str) -> Probe:
        """Displacement of a probe, or of a node group of one node, along the path.

        Raises
        ------
        InputError
            No such probe.
        """
        node = self._node(name)
        factors = np.array([step.load_factor for step in self.steps])
        flux_density = np.array([self.flux_density(step) for step in self.steps])
        return Probe(factors, flux_density, np.array([step.state.u[node] for step in self.steps]))

    @cached_property
    def history(self) -> History:
        """The rows of `history.csv`, step by step."""
        return History(self.discretisation, self.steps, self.critical_points)

    def table(self) -> Any:
        """The history as a pandas frame: a row for each converged step, the columns of `history.csv`.

        Returns
        -------
        pandas.DataFrame
            Empty cells are NaN.

        Raises
        ------
        InputError
            pandas is not installed; the message says how to install it.
        """
        return drawing("table")(self)

    def values(self, name: str, step: int = -1) -> AnyArray:
        """An output at a step, in SI.

        Parameters
        ----------
        name : str
            A name or symbol of `magshell.evaluation.outputs`, or either with the suffix of a component: "u3",
            "von_mises_top", "stress_top", "s11_top".
        step : int
            Which converged step; negative counts from the last.

        Returns
        -------
        ndarray, shape (rows,) or (rows, components)
            A row for each node or element. What may jump, such as stresses, has further rows after those of the nodes
            where the shell has borders or joints (`magshell.evaluation.patches`).

        Raises
        ------
        InputError
            No such output or step.
        """
        output, component = find(name, whole=True)
        if not -len(self.steps) <= step < len(self.steps):
            raise InputError(f"There is no step {step}; the path has steps 0 to {len(self.steps) - 1}.")
        values = np.array(output.evaluate(converged(self.discretisation, self.steps[step])))
        return values if component is None else values[:, component - 1]

    def loading(self, step: Step) -> Loading:
        """What acts on the shell at a step."""
        return self.courses[step.stage].at(step.load_factor)

    def flux_density(self, at: Step | CriticalPoint) -> FloatArray:
        """The field (3,) at the shell's centre, T, at a step or critical point; NaN where it is not known there."""
        return self.courses[at.stage].reported(at.load_factor, at.flux_density)

    def _node(self, name: str) -> int:
        if name in self.model.probe_nodes:
            return self.model.probe_nodes[name]
        group = self.model.shell.mesh.node_groups.get(name)
        if group is None or len(group) != 1:
            raise InputError(f"probe '{name}' is unknown. {suggest(name, self.model.probe_nodes)}")
        return int(group[0])

    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json holds."""
        last = self.steps[-1] if self.steps else None
        force, moment = largest_imbalances([step.balance for step in self.steps if step.balance is not None])
        return {
            "converged": self.converged,
            "reason": self.reason,
            "steps": max(len(self.steps) - 1, 0),
            "iterations": self.solves,
            "cuts": self.cuts,
            "elements": len(self.model.shell.mesh.elements),
            "dofs": self.discretisation.dofs,
            "linear_solver": self.solver_name,
            "cpu_seconds": self.cpu_seconds,
            "stage": last.stage + 1 if last else 1,
            "load_factor": last.load_factor if last else 0.0,
            "negative_pivots": last.negative_pivots if last else None,
            "critical_points": [
                {
                    "kind": point.kind,
                    "stage": point.stage + 1,
                    "load_factor": point.load_factor,
                    "flux_density": self.flux_density(point).tolist(),
                }
                for point in self.critical_points
            ],
            "force_imbalance": force,
            "moment_imbalance": moment,
            "probes": {name: self.probe(name).u[-1].tolist() for name in self.model.probe_nodes} if last else {},
            **(self._reached(last) if last else {}),
        }

    def _reached(self, last: Step) -> dict[str, Any]:
        """Reactions, energies, work, torque and the largest stresses at the last step, for the summary."""
        self.history.rows(self.steps)
        numbers = dict(zip(self.history.columns, self.history.row(last), strict=True))
        kinds = {"force": "R", "moment": "M"}
        return {
            "reactions": {
                name: {kind: [numbers[f"{name}.{letter}{i}"] for i in (1, 2, 3)] for kind, letter in kinds.items()}
                for name in self.model.reactions
            },
            **{
                name: numbers[name]
                for name in ("elastic", "magnetic", "springs", "work", "work_field")
                if name in numbers
            },
            "magnetic_torque": [numbers[f"torque{i}"] for i in (1, 2, 3)],
            "largest": described(numbers, self.model.shell.mesh.points),
        }

    def save(self, file: str | PathLike[str]) -> None:
        """Write the path: a whole folder, or a file that ParaView opens.

        Parameters
        ----------
        file : path
            With a slash at its end, or of a folder: the folder gets `history.csv`, `summary.json`, shapes, critical
            points and pictures, as `magshell run --out` writes them, and `path.pickle`, from which
            `magshell.results.read` reads the path back. Any other name: every step as VTU beside a PVD file.

        Raises
        ------
        InputError
            Files of something else would be replaced, or the model has a function that cannot be pickled.
        """
        drawing("save_path")(self, file)

    def export(self, file: str | PathLike[str], step: int = -1) -> None:
        """Write the deformed body with its true thickness, as a solid.

        Parameters
        ----------
        file : path
            `.stl`: a closed surface for printers and CAD, binary, in mm. `.vtu`: solid elements of second order, in m,
            with the outputs of the mid-surface.
        step : int
            Which converged step; negative counts from the last.
        """
        drawing("export")(self, file, step)

    def view(self, file: str | PathLike[str] = "view.html", color: str = "u3") -> None:
        """Write one self-contained page for a browser: shape, steps, colours, curves.

        Parameters
        ----------
        file : path
        color : str
            Output that colours the shape at first.
        """
        drawing("write_page")(self, file, color=color)

    def animate(
        self,
        file: str | PathLike[str],
        color: str = "u3",
        seconds: float = 4.0,
        camera: ArrayLike | None = None,
        smooth: bool = False,
    ) -> None:
        """Write the path as an animation, a converged step for each frame.

        Parameters
        ----------
        file : path
            `.gif`, or `.mp4` with the extra `magshell[video]`.
        color : str
            Output that colours the shape.
        seconds : float
            From the first to the last step, s.
        camera : (3,) array_like, optional
            Direction from the body to the camera, such as (0, -1, 0) for a view along X2; by default the best of a few.
        smooth : bool
            Whether frames between the steps are drawn too, linearly interpolated.
        """
        drawing("animate")(self, file, color, seconds=seconds, camera=camera, smooth=smooth)

    def plot(
        self,
        color: str = "u3",
        step: int = -1,
        camera: ArrayLike | None = None,
        file: str | PathLike[str] | None = None,
    ) -> Any:
        """Picture of a deformed shape.

        Parameters
        ----------
        color : str
            Output that colours the shape.
        step : int
            Which converged step; negative counts from the last.
        camera : (3,) array_like, optional
            Direction from the body to the camera, such as (0, -1, 0) for a view along X2; by default the best of a few.
        file : path, optional
            PNG file to write.

        Returns
        -------
        PIL.Image.Image or None
            The picture, if no file was named.
        """
        return drawing("draw_shape")(self, file=file, step=step, color=color, camera=camera)


class SolveError(RuntimeError):
    """The load path could not be followed to its end.

    Attributes
    ----------
    reason : str
        Why, and what to try.
    path : Path
        Every converged step up to the failure.
    """

    def __init__(self, reason: str, path: Path) -> None:
        super().__init__(reason)
        self.reason = reason
        self.path = path
