"""The cells of a sweep, solved by workers; the table is up to date after each of them, the histories at the end."""

from __future__ import annotations

import contextlib
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait

from magshell.problem.alternatives import Setting
from magshell.sweep.cell import solve_cell
from magshell.sweep.display import Display
from magshell.sweep.executors import Workers
from magshell.sweep.folder import SweepFolder
from magshell.sweep.grid import Cell
from magshell.sweep.histories import write_histories
from magshell.sweep.outcomes import WAITING, Outcome, outcome_in, undeformed, write_table

ATTEMPTS = 2
"""How often a cell is given to a worker, if workers die on it."""
_LOOK = 0.5
_PATIENCE = 30.0


def sweep(
    folder: SweepFolder, settings: Sequence[Setting], cells: Sequence[Cell], workers: Workers, display: Display
) -> dict[int, Outcome]:
    """Solve the cells that are not solved yet.

    Parameters
    ----------
    folder : SweepFolder
    settings : sequence of Setting
    cells : sequence of Cell
    workers : Workers
    display : Display
        Told of every cell that ends.

    Returns
    -------
    dict of int to Outcome
        By the number of the cell; those without a converged solution say why.

    Raises
    ------
    KeyboardInterrupt
        By Ctrl-C; the workers have been told to stop, and the table says what is done.
    OSError
        The disk refuses; the message names the file.
    """
    from magshell.shell.loops import are_compiled

    outcomes = {cell.number: undeformed(cell) for cell in cells if cell.undeformed}
    for cell in cells:
        if not cell.undeformed and (found := outcome_in(folder.cell(cell.name))).converged:
            outcomes[cell.number] = found
    folder.cells.mkdir(parents=True, exist_ok=True)
    folder.stop.unlink(missing_ok=True)
    write_table(folder.table, settings, cells, outcomes)
    display.begin(len(cells), outcomes)
    missing = [cell for cell in cells if cell.number not in outcomes]
    run = _Run(folder, workers, display)
    ahead = 0 if are_compiled() else 1  # others would only wait for it
    if missing[:ahead]:
        display.compiling()
    try:
        for group in (missing[:ahead], missing[ahead:]):
            for number, outcome in run.solve(group):
                outcomes[number] = outcome
                write_table(folder.table, settings, cells, outcomes)
    except BaseException:
        folder.stop.touch()
        for number, outcome in run.remains():
            outcomes[number] = outcome
        write_table(folder.table, settings, cells, outcomes)
        raise
    finally:
        workers.close()
        folder.stop.unlink(missing_ok=True)
        write_histories(folder, settings, cells)
    return outcomes


class _Run:
    """Cells on their way through the workers."""

    def __init__(self, folder: SweepFolder, workers: Workers, display: Display) -> None:
        self._folder, self._workers, self._display = folder, workers, display
        self._running: dict[Future[Outcome], Cell] = {}
        self._deaths: Counter[int] = Counter()

    def solve(self, cells: Iterable[Cell]) -> Iterator[tuple[int, Outcome]]:
        """Number and outcome of each cell, as they end."""
        waiting = deque(cells)
        while waiting or self._running:
            while waiting and len(self._running) < self._workers.places:
                self._send(waiting.popleft())
            self._display.running(len(self._running))
            done, _ = wait(self._running, timeout=_LOOK, return_when=FIRST_COMPLETED)
            for future in done:
                cell = self._running.pop(future)
                outcome = _outcome(future)
                if outcome is None:
                    self._deaths[cell.number] += 1
                    if self._deaths[cell.number] < ATTEMPTS:
                        self._display.died(cell)
                        waiting.append(cell)
                        continue
                    outcome = Outcome(False, "the process that solved it was killed, twice: out of memory?")
                self._display.ended(cell, outcome)
                yield cell.number, outcome

    def remains(self) -> Iterator[tuple[int, Outcome]]:
        """The outcomes of what runs, when it has been told to stop."""
        for future in self._running:
            future.cancel()
        with contextlib.suppress(KeyboardInterrupt):
            wait(self._running, timeout=_PATIENCE)
        for future, cell in self._running.items():
            outcome = _outcome(future) if future.done() and not future.cancelled() else None
            if outcome is not None and outcome != WAITING:
                yield cell.number, outcome

    def _send(self, cell: Cell) -> None:
        source, directory = cell.source, self._folder.cell(cell.name)
        paths = [str(path.resolve()) for path in (source.folder, directory, self._folder.stop)]
        self._running[self._workers.submit(solve_cell, source.name, source.text, *paths)] = cell


def _outcome(future: Future[Outcome]) -> Outcome | None:
    """None where the process died with the cell."""
    try:
        return future.result()
    except BrokenExecutor:
        return None
    except CancelledError:
        return Outcome(False, "the cluster has dropped it")
    except Exception as error:
        return Outcome(False, f"its worker failed: {str(error) or type(error).__name__}")
