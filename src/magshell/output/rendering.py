"""Whether this machine can draw in three dimensions without a screen.

VTK ends the process with a segmentation fault where it finds no way to draw, so a trial picture is drawn in a process
of its own.
"""

from __future__ import annotations

import contextlib
import pathlib
import re
import subprocess
import sys
from collections.abc import Callable
from functools import cache

from magshell.errors import lacks_memory
from magshell.openblas import is_limited

SECONDS = 60.0
# Bytes that a picture may need beyond the trial, where the address space of processes is limited.
RESERVE = 256 << 20

_TRIAL = """
import sys
import pyvista
if room := int(sys.argv[1]):
    import re, resource
    with open("/proc/self/status") as file:
        used = 1024 * int(re.search(r"VmSize:\\s+(\\d+)", file.read())[1])
    resource.setrlimit(resource.RLIMIT_AS, (used + room, resource.getrlimit(resource.RLIMIT_AS)[1]))
plotter = pyvista.Plotter(off_screen=True, window_size=(32, 32))
plotter.add_mesh(pyvista.Sphere(), color="red")
picture = plotter.screenshot(None, return_img=True)
plotter.close()
raise SystemExit(0 if picture.min() < picture.max() else "the picture is empty")
"""


class RenderingUnavailable(RuntimeError):
    """Three-dimensional pictures cannot be drawn here; the message says what to install."""


@cache
def _trial_failure() -> str:
    """What went wrong with a trial picture, empty if nothing; tried once per process."""
    room = _room()
    if room is not None and room <= 0:
        return "too little of the address space is left"
    command = [sys.executable, "-P", "-c", _TRIAL, str(room or 0)]
    try:
        trial = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"it took more than {SECONDS:g} s"
    except OSError as error:
        return f"it could not be started: {error}"
    if trial.returncode < 0:
        return f"it died of signal {-trial.returncode}"
    if trial.returncode > 0:
        return (trial.stderr.strip().splitlines() or [f"exit status {trial.returncode}"])[-1]
    return ""


def _room() -> int | None:
    """Bytes of address space that a trial picture may take, of what is left to this process; None: no limit.

    VTK dies of a picture that it finds no memory for, and a new process has more left than this one.
    """
    if not is_limited():
        return None
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    try:
        import pyvista  # noqa: F401

        found = re.search(r"VmSize:\s+(\d+)", pathlib.Path("/proc/self/status").read_text(encoding="ascii"))
    except (ModuleNotFoundError, OSError):
        return None
    return None if found is None else limit - 1024 * int(found[1]) - RESERVE


def attempted(draw: Callable[[pathlib.Path], object], file: pathlib.Path) -> pathlib.Path | str:
    """Draw a file; if that fails, whatever the cause, a sentence that names it (an older file is then removed)."""
    try:
        draw(file)
        return file
    except RenderingUnavailable as unavailable:
        reason = str(unavailable)
    except Exception as error:
        cause = "there is not enough memory" if lacks_memory(error) else f"{type(error).__name__}: {error}"
        reason = f"No picture {file.name}: {cause}"
    with contextlib.suppress(OSError):
        file.unlink(missing_ok=True)
    return reason


def require_rendering() -> None:
    """Return if a trial picture succeeds.

    Raises
    ------
    RenderingUnavailable
        It does not.
    """
    failure = _trial_failure()
    if failure:
        remedy = "On Debian or Ubuntu install the packages libegl1 and libgl1-mesa-dri, or libosmesa6."
        if is_limited():
            remedy = f"The address space of this process is limited, perhaps too much (ulimit -v). {remedy}"
        raise RenderingUnavailable(
            f"No picture of the shape: drawing without a screen failed on a trial picture ({failure}). {remedy}"
        )
