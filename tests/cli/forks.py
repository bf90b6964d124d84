"""Runs of the command in processes of their own that start at once, and may be killed at any moment.

A parent process imports everything one time and forks a child for each run. A child that is sent SIGKILL dies like any
other process. `python -m cli.forks` is that parent: it reads one request a line and answers each with a line.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from magshell.output.checkpoint import step_files

TESTS = Path(__file__).parents[1]


class Kill(NamedTuple):
    """When a run is sent SIGKILL, unless it has ended: so long after its folder has so many steps."""

    folder: str
    steps: int
    seconds: float


class Forks:
    """The parent process; used as a context."""

    def __enter__(self) -> Forks:
        self._parent = subprocess.Popen(
            [sys.executable, "-m", "cli.forks"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=TESTS,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )  # fmt: skip
        return self

    def __exit__(self, *_: object) -> None:
        assert self._parent.stdin is not None
        self._parent.stdin.close()
        self._parent.wait(timeout=60)

    def run(self, arguments: Sequence[str], shown: Path, kill: Kill | None = None) -> int:
        """Exit status of `magshell ARGUMENTS`, or minus the signal that ended it; what it says goes into a file."""
        assert self._parent.stdin is not None
        assert self._parent.stdout is not None
        self._parent.stdin.write(json.dumps([list(arguments), str(shown), kill]) + "\n")
        self._parent.stdin.flush()
        answer = self._parent.stdout.readline()
        assert answer, f"the parent of the runs has ended with {self._parent.wait(timeout=60)}"
        return int(answer)


def _serve() -> None:
    _warm_up()
    for line in sys.stdin:
        arguments, shown, kill = json.loads(line)
        child = os.fork()
        if child == 0:
            _be_a_run(arguments, shown)
        print(_end(child, Kill(*kill) if kill else None), flush=True)


def _end(child: int, kill: Kill | None) -> int:
    """Wait for the end of a process, or bring it about."""
    due = None
    while kill is not None:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        if due is None and len(step_files(kill.folder)) >= kill.steps:
            due = time.monotonic() + kill.seconds
        if due is not None and time.monotonic() >= due:
            os.kill(child, signal.SIGKILL)
            break
        time.sleep(5e-4)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def _warm_up() -> None:
    """Import everything, read the kernels from their cache and ask whether pictures can be drawn; draw none.

    Those of the runs have few pixels.
    """
    import tempfile

    from problem_files import STRIP

    import magshell as ms
    import magshell.cli
    import magshell.output.pictures
    from magshell.output import curve, rendering, shape

    curve.DPI = shape.DPI = 40
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory) / "problem.toml"
        file.write_text(STRIP)
        problem = ms.problem.load(file)
        ms.solve(problem.model, problem.settings, ms.results.writers(problem, Path(directory)))
    with contextlib.suppress(rendering.RenderingUnavailable):
        rendering.require_rendering()


def _be_a_run(arguments: list[str], shown: str) -> None:
    import magshell.cli

    file = os.open(shown, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.dup2(file, 1)
    os.dup2(file, 2)
    sys.stdout.reconfigure(line_buffering=True)
    status = magshell.cli.main(arguments)
    sys.stdout.flush()
    os._exit(status)


if __name__ == "__main__":
    _serve()
