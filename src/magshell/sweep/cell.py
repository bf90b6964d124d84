"""One cell of a sweep, solved in the process that it was sent to."""

from __future__ import annotations

import logging
import pathlib

from magshell.errors import InputError
from magshell.problem.reading import Source
from magshell.solver.events import Iteration, Observer
from magshell.solver.path import SolveError
from magshell.sweep.outcomes import WAITING, Outcome, outcome_in


class StopWhenAsked(Observer):
    """Ends a solve as Ctrl-C does, at the next iteration after a file has appeared.

    Parameters
    ----------
    file : path
    """

    def __init__(self, file: pathlib.Path) -> None:
        self._file = file

    def iterated(self, iteration: Iteration) -> None:
        """Look for the file."""
        if self._file.exists():
            raise KeyboardInterrupt


def solve_cell(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """Solve a problem into a results folder; errors are returned in the outcome, not raised.

    Parameters
    ----------
    name, text, folder : str
        The problem file, and where the paths in it start.
    directory : str
        For the results.
    stop : str
        A file that ends the solve when it appears.

    Returns
    -------
    Outcome
        WAITING if it was stopped.
    """
    path = pathlib.Path(directory)
    for part in ("magshell.model", "magshell.problem"):  # the sweep has said it of all cells
        logging.getLogger(part).addHandler(logging.NullHandler())
    try:
        _solve(Source(name, text, pathlib.Path(folder)), path, StopWhenAsked(pathlib.Path(stop)))
    except KeyboardInterrupt:
        return WAITING
    except SolveError as error:
        return Outcome(False, error.reason, outcome_in(path).summary)
    except InputError as error:
        return Outcome(False, str(error))
    except OSError as error:
        return Outcome(False, f"{error.filename or 'a file'}: {error.strerror or error}")
    except MemoryError:
        return Outcome(False, "there is not enough memory")
    except Exception as error:
        return Outcome(False, f"this is a bug in magshell: {type(error).__name__}: {error}")
    return outcome_in(path)


def _solve(source: Source, directory: pathlib.Path, stop: Observer) -> None:
    """From the last converged step in the folder, if there is one that can be read."""
    from magshell import results
    from magshell.files import remove_temporaries
    from magshell.output.lock import alone
    from magshell.output.summary import write_summary
    from magshell.problem.building import build
    from magshell.problem.reading import check, parse
    from magshell.solver import resume, solve

    problem = build(check(parse(source.text, source.name), source.name), *source)
    directory.mkdir(parents=True, exist_ok=True)
    with alone(directory):
        if results.is_one(directory):
            remove_temporaries(directory)
        try:
            earlier = results.read(directory).path if results.begun(directory) else None
        except InputError:
            earlier = None
        observers = [*results.writers(problem, directory), stop]
        try:
            if earlier is None:
                results.make(problem, directory)
                path = solve(problem.model, problem.settings, observers)
            else:
                path = resume(earlier, observers)
        except SolveError as error:
            write_summary(error.path, directory)
            raise
        write_summary(path, directory)
