"""One run of the command, interrupted after its first example, and the gripper's path, for all tests."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import time
from typing import NamedTuple

import pytest
from processes import PATIENCE, hear_ctrl_c

from magshell import Path, solve
from magshell.problem.building import build
from magshell.reproduction.variants import paper_file


class Interrupted(NamedTuple):
    """A run of the command that was sent Ctrl-C after its first example."""

    directory: pathlib.Path
    status: int
    output: str
    errors: str
    left_running: bool


@pytest.fixture(scope="session")
def interrupted(tmp_path_factory: pytest.TempPathFactory) -> Interrupted:
    """Thin cross and pump, Ctrl-C when the first is done; files of an earlier run lie in the folder."""
    directory = tmp_path_factory.mktemp("reproduction")
    (directory / "pump-shapes.png").write_bytes(b"of an earlier run")
    (directory / "reproduction.csv").write_text("example,quantity,unit,paper,computed,difference_percent,note\n")
    (directory / "mine.png").write_bytes(b"of the user")
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "magshell", "reproduce", "pump", "thin-cross", "--out", str(directory)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=hear_ctrl_c,
    )  # fmt: skip
    assert process.stdout is not None
    lines = []
    for line in process.stdout:
        lines.append(line)
        if "thin-cross: done" in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    rest, errors = process.communicate(timeout=PATIENCE)
    return Interrupted(directory, process.returncode, "".join(lines) + rest, errors, _lives(process.pid))


def _lives(group: int, seconds: float = 60.0) -> bool:
    """Whether processes of a group are still there after these seconds."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return False
        time.sleep(0.1)
    return True


@pytest.fixture(scope="session")
def gripper() -> Path:
    """The gripper with the element and on the mesh of the paper."""
    built = build(paper_file("gripper"), "gripper")
    return solve(built.model, built.settings)
