"""The whole way of a person: a drawing, a mesh, a check, a look, a run that is killed and goes on, a page.

A part of `make verify`; the tests have its pieces: the way from a DXF to a page, killed runs, pages in a browser.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from browser.chromium import browser, missing
from PIL import Image
from processes import until

from magshell.output.rendering import RenderingUnavailable, require_rendering

DRAWING = Path(__file__).with_name("tongue.geo")
PROBLEM = Path(__file__).with_name("tongue.toml")
COMMAND = [sys.executable, "-m", "magshell"]
ALONE = {**os.environ, "OMP_NUM_THREADS": "1"}
KEPT_AT_LEAST = 2
pytestmark = pytest.mark.verify
UNBROKEN = f"""
import pathlib
import magshell as ms
problem, folder = ms.problem.load("{PROBLEM.name}"), pathlib.Path("unbroken")
ms.solve(problem.model, problem.settings, ms.results.writers(problem, folder))
"""


def magshell(folder: Path, *arguments: str) -> str:
    """What a command that succeeds says."""
    done = subprocess.run([*COMMAND, *arguments], cwd=folder, env=ALONE, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout


def killed(folder: Path, out: str) -> list[str]:
    """Start a run, kill it with SIGKILL when some steps have converged; the rows of its history."""
    history = folder / out / "history.csv"
    command = [*COMMAND, "run", PROBLEM.name, "--out", out]
    with subprocess.Popen(command, cwd=folder, env=ALONE, stdout=subprocess.DEVNULL) as run:
        until(lambda: history.exists() and len(history.read_text().splitlines()) > KEPT_AT_LEAST, run)
        run.kill()
    assert run.returncode == -signal.SIGKILL, "the run ended before it was killed"
    return history.read_text().splitlines()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with blanks and accents in its name, with the drawing and the problem."""
    place = tmp_path_factory.mktemp("langue à plat")
    for file in (DRAWING, PROBLEM):
        shutil.copy(file, place)
    return place


def test_the_whole_way(folder: Path) -> None:
    pytest.importorskip("gmsh", reason="gmsh is not installed", exc_type=(ImportError, OSError))
    said = magshell(folder, "mesh", DRAWING.name, "--unit", "mm", "--size", "1.2 mm", "--out", "tongue.msh")
    assert "quadrilaterals" in said
    assert "root" in said

    said = magshell(folder, "check", PROBLEM.name)
    assert "warning" not in said
    assert "tongue, root" in said

    try:
        require_rendering()
    except RenderingUnavailable:
        drawn = False
    else:
        drawn = True
        magshell(folder, "show", PROBLEM.name, "--out", "setup.png")
        with Image.open(folder / "setup.png") as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 100

    rows = killed(folder, "results")
    said = magshell(folder, "run", "--resume", "results")
    assert "solved" in said
    history = (folder / "results" / "history.csv").read_text().splitlines()
    assert history[: len(rows)] == rows, "a step that had converged was lost or changed"

    subprocess.run([sys.executable, "-c", UNBROKEN], cwd=folder, env=ALONE, check=True)
    assert (folder / "unbroken" / "history.csv").read_bytes() == (folder / "results" / "history.csv").read_bytes()
    summary = json.loads((folder / "results" / "summary.json").read_text())
    assert summary["converged"]
    assert summary["force_imbalance"] < 1e-8
    assert (folder / "results" / "shape.png").exists() == drawn

    magshell(folder, "view", "results")


def test_the_page_in_a_browser(folder: Path) -> None:
    page = folder / "results" / "view.html"
    if not page.exists():
        pytest.skip("gmsh is not installed")
    if absent := missing():
        pytest.skip(f"not installed: {absent}")
    steps = len((folder / "results" / "history.csv").read_text().splitlines()) - 2
    with browser(1000, 700) as window:
        window.open(page)
        last = np.asarray(window.picture())
        assert window.until("return document.getElementById('step').textContent") == f"step {steps} of {steps}"
        window.do(
            "const slider = document.getElementById('slider'); slider.value = 0;"
            "slider.dispatchEvent(new Event('input', {bubbles: true}));"
            "await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));"
        )
        assert window.until("return document.getElementById('step').textContent").startswith("step 0 of")
        first = np.asarray(window.picture())
        changed = np.any(first != last, axis=2).mean()
        assert changed > 0.01, f"only {changed:.2%} of the picture changed from the last step to the first"
        assert not window.console()
        assert all(address.startswith(("file:", "data:")) for address in window.requests())
