"""Whether this machine can draw in three dimensions without a screen.

VTK ends the process with a segmentation fault where it finds no way to draw, so the question is put to a
process that may die.
"""

from __future__ import annotations

import subprocess
import sys
from functools import cache

SECONDS = 60.0

_TRIAL = """
import pyvista
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
    try:
        trial = subprocess.run(
            [sys.executable, "-P", "-c", _TRIAL], capture_output=True, text=True, timeout=SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        return f"it took more than {SECONDS:g} s"
    except OSError as error:
        return f"it could not be started: {error}"
    if trial.returncode < 0:
        return f"it died of signal {-trial.returncode}"
    if trial.returncode > 0:
        return (trial.stderr.strip().splitlines() or [f"exit status {trial.returncode}"])[-1]
    return ""


def require_rendering() -> None:
    """Return if a trial picture succeeds.

    Raises
    ------
    RenderingUnavailable
        It does not.
    """
    failure = _trial_failure()
    if failure:
        raise RenderingUnavailable(
            f"No picture of the shape: drawing without a screen failed on a trial picture ({failure}). "
            "On Debian or Ubuntu install the packages libegl1 and libgl1-mesa-dri, or libosmesa6."
        )
