"""Results folders: made from a problem, and read back as a problem with its path.

A folder is self-contained: it holds the problem file and copies of the files that it names, so that a run can be
resumed and its results can be viewed wherever the folder is.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from magshell.errors import InputError
from magshell.files import first_line, naming, refuse_somebodys, refuse_to_replace, write_atomically
from magshell.output import checkpoint, saved, step_checks
from magshell.output.checkpoint import CheckpointWriter, Origin
from magshell.output.critical import CriticalWriter
from magshell.output.history import HistoryWriter
from magshell.output.summary import SummaryWriter
from magshell.output.vtu import VtuWriter
from magshell.problem import copies
from magshell.problem.building import Problem, build, with_earlier_defaults
from magshell.problem.building.material import by_default
from magshell.problem.reading import check, find, parse
from magshell.solver import Observer, Path
from magshell.solver.newton import StepFailure
from magshell.solver.retracing import path_through
from magshell.solver.waypoint import Waypoint
from magshell.units import shortened
from magshell.version import __version__

PROBLEM = "problem.toml"
WRITTEN = (
    "history.csv", "summary.json", "shell.pvd", "critical.csv", "curve.png", "shape.png", "steps/step-*.vtu",
    "critical/point-*.vtu", f"{checkpoint.FOLDER}/step-*.npz",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Results:
    """A results folder.

    Attributes
    ----------
    problem : Problem or None
        None: the path was saved by `Path.save`; its model is `path.model`.
    path : Path
        All converged steps; `magshell.resume` goes on with it.
    notes : list of str
        Why going on would not give the same bits as the run so far.
    """

    problem: Problem | None
    path: Path
    notes: list[str]

    @property
    def title(self) -> str:
        """That of the problem; nothing without one."""
        return "" if self.problem is None else self.problem.title

    def __repr__(self) -> str:
        return f"Results('{self.title}', {self.path!r})"

    def _repr_html_(self) -> str:
        return self.path._repr_html_()


def read(directory: str | os.PathLike[str], own: bool = False) -> Results:
    """Read a results folder, also while a run writes into it.

    Parameters
    ----------
    directory : path
        As `magshell run --out` or `Path.save` made it.
    own : bool
        Whether it is your own. What `Path.save` has made is a pickle, which may run any program when it is opened; it
        is read if you say so. Folders of runs need no trust.

    Raises
    ------
    InputError
        No results folder, no converged step in it, a step that cannot be read, or steps of another problem; the message
        names the file and says what to do.
    """
    folder = pathlib.Path(directory)
    if saved.is_saved(folder):
        if not own:
            raise InputError(
                f"{folder}: was saved in Python, and its {saved.NAME} may run any program when it is opened. If you "
                f"saved it yourself: ms.results.read({str(directory)!r}, own=True)"
            )
        return Results(None, *saved.read_saved(folder))
    files = checkpoint.step_files(folder)
    require_no_sweep(folder)
    if not (folder / PROBLEM).is_file():
        raise InputError(f"{folder}: is not a results folder; one that `magshell run --out` made has a {PROBLEM}")
    if not files:
        raise InputError(f"{folder}: no step has converged there yet; `magshell run --resume` begins it")
    found = _as_it_was(_built(folder / PROBLEM), files[0])
    origins: list[Origin] = []
    try:
        path = path_through(found.model, found.settings, _waypoints(found, files, origins))
    except StepFailure as failure:
        raise InputError(f"{folder / checkpoint.FOLDER}: its steps make no path: {failure}; run it anew") from None
    fault = step_checks.fault_of_path(path)
    if fault is not None:
        number, what = fault
        raise InputError(f"{files[number]}: is damaged or was changed: {what}. {checkpoint.remedy(number)}")
    return Results(found, path, _notes(path, origins[-1]))


def require_no_sweep(directory: pathlib.Path) -> None:
    """Refuse the folder of a sweep, which also has a problem file.

    Raises
    ------
    InputError
        It is one; says what to name instead.
    """
    if (directory / "sweep.toml").exists():
        raise InputError(
            f"{directory}: is the folder of a sweep, not of a run; `magshell sweep --resume` goes on with it, and the "
            f"results of its cells are in {directory / 'cells'}"
        )


def begun(directory: str | os.PathLike[str]) -> bool:
    """Whether a step has converged in a folder."""
    return bool(checkpoint.step_files(directory))


def is_one(directory: pathlib.Path) -> bool:
    """Whether a folder was made by a run, with its steps or, where these were removed, its curves."""
    steps, curves = directory / checkpoint.FOLDER, first_line(directory / "history.csv")
    return (directory / PROBLEM).is_file() and (steps.is_dir() or curves.startswith("load_factor,B1,B2,B3"))


def require_free(source: Problem, directory: pathlib.Path) -> None:
    """Refuse a folder in which a run would replace or remove somebody's own files.

    Raises
    ------
    InputError
        Names them.
    """
    if is_one(directory):
        return
    refuse_somebodys(directory, False, WRITTEN)
    text, inputs = copies.alone(source)
    others = [
        name
        for name, content in {PROBLEM: text.encode(), **inputs}.items()
        if (directory / name).exists() and (directory / name).read_bytes() != content
    ]
    refuse_to_replace(directory, others)


def make(source: Problem, directory: pathlib.Path) -> None:
    """Make a folder (which exists) ready for a run: steps of an earlier one are removed, the problem is copied into it.

    Raises
    ------
    InputError
        The folder holds somebody's own files with the names of those that a run writes.
    OSError
        A file of the problem has gone, or the disk refuses; the message names the file.
    """
    require_free(source, directory)
    text, inputs = copies.alone(source)
    with naming(directory / checkpoint.FOLDER):
        (directory / checkpoint.FOLDER).mkdir(exist_ok=True)
    checkpoint.forget(directory)
    for name, own in inputs.items():
        write_atomically(directory / name, own)
    write_atomically(directory / PROBLEM, text.encode())


def writers(source: Problem, directory: pathlib.Path) -> list[Observer]:
    """Observers that write the files of a results folder; the checkpoint first, so that it is never behind them."""
    return [
        CheckpointWriter(directory, copies.digest(source)),
        SummaryWriter(directory),
        HistoryWriter(directory),
        VtuWriter(directory),
        CriticalWriter(directory),
    ]


def _built(file: pathlib.Path) -> Problem:
    """The problem of a folder, without the note on defaults, which its run has given."""
    source = find(file)
    return build(check(parse(source.text, source.name), source.name), *source)


def _as_it_was(found: Problem, first: pathlib.Path) -> Problem:
    """The problem with the defaults of the time when the run began."""
    if by_default(found.file) is None:
        return found
    _, origin = checkpoint.read_step(first, step_checks.most_bytes(found.model))
    return found if origin.version > 1 else with_earlier_defaults(found)


def _waypoints(source: Problem, files: Iterable[pathlib.Path], origins: list[Origin]) -> Iterator[Waypoint]:
    """The steps in order, each checked; what they were made with goes into a list."""
    own = copies.digest(source)
    model = source.model
    shapes = (len(model.rows.of), 3), (len(model.shell.mesh.elements), model.shell.element.vectors, 3)
    most, before = step_checks.most_bytes(source.model), None
    for number, file in enumerate(files):
        waypoint, origin = checkpoint.read_step(file, most)
        if waypoint.step.number != number:
            raise InputError(f"{file.with_name(checkpoint.step_name(number))}: is missing. {checkpoint.remedy(number)}")
        if origin.problem != own:
            raise InputError(
                f"{file.parent.parent / PROBLEM}: is not the problem of the steps in {file.parent}, apart from its "
                "[solver]. Undo what was changed in it, or run it anew with --out"
            )
        if (waypoint.step.state.u.shape, waypoint.step.state.alpha.shape) != shapes:
            raise InputError(
                f"{file}: is of another mesh than {PROBLEM} makes now (magshell {origin.magshell} made the step, this "
                f"is {__version__}); run it anew with --out"
            )
        fault = step_checks.fault_of(waypoint, before, source.model)
        if fault is not None:
            raise InputError(f"{file}: is damaged or was changed: {fault}. {checkpoint.remedy(number)}")
        origins.append(origin)
        before = waypoint
        yield waypoint


def _notes(path: Path, origin: Origin) -> list[str]:
    notes = []
    if origin.magshell != __version__:
        notes.append(f"the last step was made by magshell {origin.magshell}, this is {__version__}")
    changed = [name for name, value in origin.settings.items() if getattr(path.settings, name, None) != value]
    if changed:
        names = shortened(", ".join(changed))
        notes.append(f"the solver's settings have changed since the last step: {names}")
    return notes
