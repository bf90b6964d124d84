"""Processes that tests start."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

PATIENCE = 900.0
"""Seconds until what hangs is given up. A busy machine may take minutes to compile the kernels before a first step."""


def hear_ctrl_c() -> None:
    """For `preexec_fn`: a shell that runs the tests in the background has its children ignore Ctrl-C."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def until(condition: Callable[[], bool], process: subprocess.Popen[str] | None = None) -> None:
    """Wait for something that a process brings about, which must not end before."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if process is not None and process.poll() is not None and not condition():
            raise AssertionError(f"ended with {process.returncode}: {process.stderr and process.stderr.read()}")
        assert time.monotonic() < end, f"not within {PATIENCE:g} s"
        time.sleep(0.02)


def is_there(process: int) -> bool:
    """Whether a process has not ended yet; one that has may still wait for somebody to ask how."""
    try:
        os.kill(process, 0)
        state = Path(f"/proc/{process}/status")
        return not (state.exists() and re.search(r"State:\s+Z", state.read_text()))
    except (ProcessLookupError, FileNotFoundError):
        return False
