"""`checkpoint/step-0007.npz`: one file per converged step, with all that is needed to continue from it.

The files are zipped NumPy arrays without pickles; docs/results.md lists them. All files of a folder together are the
path; a file alone is its own step, so writing it costs the same however long the path is.
"""

from __future__ import annotations

import io
import json
import os
import pathlib
import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import asdict
from tokenize import TokenError
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.equations.instant import Increment
from magshell.errors import InputError
from magshell.evaluation.balance import Balance
from magshell.files import naming, write_atomically
from magshell.output.archive import Unfit, digest, read_arrays
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS
from magshell.solver.critical import CriticalPoint
from magshell.solver.events import Observer
from magshell.solver.path import Path
from magshell.solver.step import NO_DRIVES, Step
from magshell.solver.track import Slope
from magshell.solver.waypoint import Waypoint
from magshell.units import shortened
from magshell.version import __version__

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.solver.settings import Settings

# Version 1: of a time when materials had another coupling modulus and length scale by default.
FORMAT, VERSION = "magshell checkpoint", 2
FOLDER = "checkpoint"
UNKNOWN = -1
# Of any number: products of a few of them are still finite.
LARGEST = 1e60
MOST_BYTES, MOST_TEXT = 16 * 2**30, 2**16
# What reading a torn zip file may raise.
DAMAGES = (
    zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, SyntaxError, TokenError, MemoryError,
    OverflowError, RecursionError, struct.error,
)  # fmt: skip


class Origin(NamedTuple):
    """What a step was made with.

    Attributes
    ----------
    magshell : str
        Version of this package.
    problem : str
        Digest of the problem (`magshell.problem.copies`).
    settings : dict of str
        Those of the solver.
    version : int
        Of the format.
    """

    magshell: str
    problem: str
    settings: dict[str, Any]
    version: int = VERSION


class CheckpointWriter(Observer):
    """Write every converged step before the other observers are told of it.

    Parameters
    ----------
    directory : path
        The results folder. Steps of an earlier run in its `checkpoint` are removed when a new solve starts.
    problem : str
        Digest of the problem.

    Raises
    ------
    OSError
        The disk refuses; the message names the file, and the steps before are left as they were.
    """

    def __init__(self, directory: str | os.PathLike[str], problem: str) -> None:
        self.folder, self._problem = pathlib.Path(directory) / FOLDER, problem

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Forget an earlier run."""
        forget(self.folder.parent)

    def resumed(self, path: Path) -> None:
        """The steps so far are there."""

    def kept(self, path: Path) -> None:
        """Write the step that has just converged."""
        waypoint = path.trail[-1]
        origin = Origin(__version__, self._problem, asdict(path.settings))
        write_atomically(self.folder / step_name(waypoint.step.number), content(waypoint, origin), durably=True)


def step_files(directory: str | os.PathLike[str]) -> list[pathlib.Path]:
    """The files of a results folder's checkpoint, by the numbers of their steps."""
    files = pathlib.Path(directory, FOLDER).glob("step-*.npz")
    return sorted((file for file in files if _number(file) is not None), key=lambda file: _number(file) or 0)


def forget(directory: str | os.PathLike[str]) -> None:
    """Remove the steps of a results folder, the last first, so that what is left at an interruption is still a path."""
    with naming(pathlib.Path(directory, FOLDER)):
        for file in reversed(step_files(directory)):
            file.unlink()


def read_step(file: pathlib.Path, most: int = MOST_BYTES) -> tuple[Waypoint, Origin]:
    """A converged step and what it was made with.

    Parameters
    ----------
    file : pathlib.Path
    most : int
        Bytes that it may have.

    Raises
    ------
    InputError
        The file is damaged, larger, of a newer version or no checkpoint, has numbers that are not finite or other ones
        than were written; the message says what to do.
    """
    number = _number(file) or 0
    try:
        arrays = read_arrays(file, most)
        if str(arrays.get("format")) != FORMAT:
            raise InputError(f"{file}: is not a checkpoint of magshell. {remedy(number)}")
        if (version := int(arrays["version"])) > VERSION:
            raise InputError(
                f"{file}: has version {version} of the format, this magshell reads up to {VERSION}; update it"
            )
        _check(arrays)
        waypoint, origin = _waypoint(arrays), _origin(arrays)
    except InputError:
        raise
    except Unfit as unfit:
        raise InputError(f"{file}: is damaged or was changed: {unfit}. {remedy(number)}") from None
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror or error}") from None
    except (*DAMAGES, KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"{file}: is damaged ({type(error).__name__}: {shortened(str(error))}). {remedy(number)}"
        ) from None
    if waypoint.step.number != number:
        raise InputError(f"{file}: holds step {waypoint.step.number}; it was renamed. {remedy(number)}")
    return waypoint, origin


def remedy(number: int) -> str:
    """What to do about a step that cannot be used."""
    if not number:
        return "Without the first step nothing can be resumed; run the problem anew with --out"
    return f"Delete it and the steps after it; `magshell run --resume` then goes on from step {number - 1}"


def content(waypoint: Waypoint, origin: Origin) -> bytes:
    """The bytes of a file."""
    step, slope = waypoint.step, waypoint.slope
    arrays: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "magshell": origin.magshell,
        "problem": origin.problem,
        "settings": json.dumps(origin.settings),
        "number": step.number,
        "stage": step.stage,
        "load_factor": step.load_factor,
        "arc_length": step.arc_length,
        "iterations": step.iterations,
        "residual": step.residual,
        "flux_density": step.flux_density,
        "loads": step.loads,
        "drives": step.drives,
        "negative_pivots": _counted(step.negative_pivots),
        **step.state._asdict(),
        "slope_increment": slope.increment.nodal,
        "slope_alpha": slope.increment.alpha,
        "slope_load": slope.load,
        "goal": waypoint.goal,
        "taken": waypoint.taken,
        "by_arc": waypoint.by_arc,
        "radius": waypoint.radius,
        "cuts": waypoint.cuts,
        "solves": waypoint.solves,
        "cpu_seconds": waypoint.cpu_seconds,
        "critical_points": len(waypoint.critical_points),
    }
    if step.balance is not None:
        arrays |= {f"balance_{name}": value for name, value in step.balance._asdict().items()}
    for number, point in enumerate(waypoint.critical_points, start=1):
        own = point._asdict()
        own |= own.pop("state")._asdict() | {"negative_pivots": [_counted(one) for one in point.negative_pivots]}
        arrays |= {f"critical{number}_{name}": value for name, value in own.items()}
    arrays = {name: np.asarray(values) for name, values in arrays.items()}
    file = io.BytesIO()
    np.savez(file, **arrays, digest=_digest(arrays))
    return file.getvalue()


def _digest(arrays: Mapping[str, np.ndarray]) -> str:
    """Of all that two runs of one problem have in common."""
    return digest({name: values for name, values in arrays.items() if name not in ("digest", "cpu_seconds")})


def _check(arrays: Mapping[str, np.ndarray]) -> None:
    """Refuse values that are not finite or were changed (files of magshell 0.1.0 have no digest)."""
    for name, values in arrays.items():
        if values.dtype.kind not in "biufU":
            raise Unfit(f"{name} is of the type {values.dtype}")
        if values.dtype.kind == "f" and not np.isfinite(values).all():
            raise Unfit(f"{name} is not finite")
        if values.dtype.kind == "f" and values.dtype != np.float64:
            raise Unfit(f"{name} is of the type {values.dtype}, not float64")
        if values.dtype.kind == "f" and np.abs(values).max(initial=0.0) > LARGEST:
            raise Unfit(f"{name} has the number {np.abs(values).max():g}")
        if values.dtype.kind == "U" and values.nbytes > MOST_TEXT:
            raise Unfit(f"{name} is a text of {values.nbytes} bytes")
    if "digest" in arrays and str(arrays["digest"]) != _digest(arrays):
        raise Unfit("its numbers are not those that were written")


def _waypoint(arrays: Mapping[str, np.ndarray]) -> Waypoint:
    step = Step(
        int(arrays["number"]), float(arrays["load_factor"]), _state(arrays, ""), int(arrays["iterations"]),
        float(arrays["residual"]), _balance(arrays), float(arrays["arc_length"]), int(arrays["stage"]),
        arrays["flux_density"], arrays["loads"], _known(arrays["negative_pivots"]),
        arrays.get("drives", NO_DRIVES),
    )  # fmt: skip
    slope = Slope(Increment(_columns(arrays["slope_increment"]), arrays["slope_alpha"]), float(arrays["slope_load"]))
    critical = tuple(_critical(arrays, f"critical{number + 1}_") for number in range(int(arrays["critical_points"])))
    return Waypoint(
        step, critical, slope, int(arrays["goal"]), int(arrays["taken"]), bool(arrays["by_arc"]),
        float(arrays["radius"]), int(arrays["cuts"]), int(arrays["solves"]), float(arrays["cpu_seconds"]),
    )  # fmt: skip


def _origin(arrays: Mapping[str, np.ndarray]) -> Origin:
    settings = json.loads(str(arrays["settings"]))
    if not isinstance(settings, dict):
        raise Unfit("settings is not a table")
    return Origin(shortened(str(arrays["magshell"])), str(arrays["problem"]), settings, int(arrays["version"]))


def _state(arrays: Mapping[str, np.ndarray], prefix: str) -> State:
    own = {name: arrays[prefix + name] for name in State._fields if name != "s"}
    return State(**own, s=arrays.get(prefix + "s", np.zeros(len(own["u"]))))  # files of magshell 0.1.0 have no s


def _columns(nodal: np.ndarray) -> np.ndarray:
    """Nodal columns; files of magshell 0.1.0 lack that of s."""
    return np.pad(nodal, ((0, 0), (0, 1))) if nodal.ndim == 2 and nodal.shape[1] == COMPONENTS - 1 else nodal


def _balance(arrays: Mapping[str, np.ndarray]) -> Balance | None:
    if "balance_force_imbalance" not in arrays:
        return None
    own: dict[str, Any] = {
        name: value if value.ndim else float(value)
        for name, value in ((name, arrays.get(f"balance_{name}")) for name in Balance._fields)
        if value is not None
    }
    if "force_scale" not in own:  # a folder of version 0.1: the scale is in the ratio
        force = own["reaction_force"] + own["load_force"]
        moment = own["reaction_moment"] + own["load_moment"] + own["magnetic_torque"]
        own["force_scale"] = _scale(force, own["force_imbalance"])
        own["moment_scale"] = _scale(moment, own["moment_imbalance"])
    return Balance(**own)


def _scale(total: np.ndarray, imbalance: float) -> float:
    """What a sum was divided by."""
    return float(np.linalg.norm(total)) / imbalance if imbalance > 0.0 else 0.0


def _critical(arrays: Mapping[str, np.ndarray], prefix: str) -> CriticalPoint:
    own = {name: arrays[prefix + name] for name in CriticalPoint._fields if name != "state"}
    before, after = own["negative_pivots"]
    return CriticalPoint(
        int(own["number"]), str(own["kind"]), int(own["stage"]), float(own["load_factor"]), own["flux_density"],
        float(own["arc_length"]), _state(arrays, prefix), _columns(own["mode"]), (_known(before), _known(after)),
    )  # fmt: skip


def _counted(pivots: int | None) -> int:
    return UNKNOWN if pivots is None else pivots


def _known(pivots: np.ndarray) -> int | None:
    return None if pivots == UNKNOWN else int(pivots)


def step_name(number: int) -> str:
    """Name of a step's file."""
    return f"step-{number:04d}.npz"


def _number(file: pathlib.Path) -> int | None:
    found = re.fullmatch(r"step-(\d{4,})\.npz", file.name)
    return int(found[1]) if found else None
