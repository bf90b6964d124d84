"""Cells that end as tests want: what stands in for `magshell.sweep.cell.solve_cell`, in whatever process."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path

from processes import until

from magshell.sweep.cell import solve_cell
from magshell.sweep.outcomes import Outcome, outcome_in


def instead(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """A solution that is no more than its summary."""
    out = Path(directory)
    out.mkdir(parents=True, exist_ok=True)
    summary = {"converged": True, "reason": "", "steps": 3, "iterations": 9, "load_factor": 1.0, "cpu_seconds": 0.5}
    summary |= {"force_imbalance": 1e-12, "probes": {"tip": [0.0, 0.0, 1e-3 * int(out.name)]}}
    (out / "summary.json").write_text(json.dumps(summary))
    return outcome_in(out)


def killed_once(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """Cell 2 takes its process with it the first time."""
    mark = Path(directory).parent.parent / f"killed-{Path(directory).name}"
    if Path(directory).name == "0002" and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return instead(name, text, folder, directory, stop)


def killed_in_the_middle(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """The process that solves cell 2 is killed when a few steps have converged, the first time."""
    mark = Path(directory).parent.parent / "killed"
    if Path(directory).name == "0002" and not mark.exists():
        from magshell.output.history import HistoryWriter

        converged = HistoryWriter.converged

        def killing(self, step):
            converged(self, step)
            if step.number == 3:
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)

        HistoryWriter.converged = killing
    return solve_cell(name, text, folder, directory, stop)


def killed_always(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """Cell 2 takes every process with it."""
    if Path(directory).name == "0002":
        os.kill(os.getpid(), signal.SIGKILL)
    return instead(name, text, folder, directory, stop)


def slow(name: str, text: str, folder: str, directory: str, stop: str) -> Outcome:
    """Cell 1 is solved; the others wait until they are told to stop, and then say so."""
    if Path(directory).name == "0001":
        return instead(name, text, folder, directory, stop)
    Path(directory).mkdir(parents=True)
    until(Path(stop).exists)
    (Path(directory) / "stopped").touch()
    return Outcome()


def process_of(*arguments: str) -> Outcome:
    """Threads that the process computes with, and whether it hears Ctrl-C."""
    threads = [os.environ.get(f"{name}_NUM_THREADS") for name in ("OMP", "OPENBLAS", "MKL", "NUMBA")]
    return Outcome(True, f"{os.getpid()} {threads} {signal.getsignal(signal.SIGINT) == signal.SIG_IGN}")
