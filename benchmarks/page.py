"""How fast a browser page of 5 000 elements and 30 steps opens, and how fast its slider is, in headless Chromium.

python benchmarks/page.py

The path is a plate rolled up by a formula: what a page costs does not depend on how its states were found.
"""

from __future__ import annotations

import pathlib
import sys
import tempfile
import time

import numpy as np

from magshell.output.page import write_page

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))

from browser.chromium import browser, missing
from browser.rolled import plate, rolled

ELEMENTS, STEPS = (100, 50), 30
DRAWN = """
await new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)));
scene.gl.readPixels(0, 0, 1, 1, scene.gl.RGBA, scene.gl.UNSIGNED_BYTE, new Uint8Array(4));
return performance.now() - begin;
"""
MOVE = f"const begin = performance.now(); go(given[0]); {DRAWN}"
COLOUR = f"""
const begin = performance.now();
at("colour").value = given[0];
at("colour").dispatchEvent(new Event("change"));
{DRAWN}
"""


def main() -> None:
    """Print the figures."""
    if missing():
        raise SystemExit(f"this benchmark needs {missing()}")
    path = rolled(plate(ELEMENTS), STEPS)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "view.html"
        begin = time.perf_counter()
        write_page(path, file, "Rolled plate")
        took = time.perf_counter() - begin
        size = file.stat().st_size / 1e6
        print(
            f"{len(path.discretisation.mesh.elements)} elements, {STEPS} steps: written in {took:.2f} s, {size:.1f} MB"
        )
        with browser() as window:
            opened = [window.open(file) / 1e3 for _ in range(5)]
            moves = [window.do(MOVE, step) / 1e3 for step in range(1, STEPS, 3)]
            colours = [window.do(COLOUR, name) / 1e3 for name in ("energy 0", "displacement 3", "phi 0")]
    print(
        "opened: " + ", ".join(f"{seconds:.2f}" for seconds in opened) + " s, first the cold browser  (asked: below 2)"
    )
    print(f"slider: median {np.median(moves):.3f} s, slowest {max(moves):.3f} s  (asked: below 0.3)")
    print("another colour: " + ", ".join(f"{seconds:.3f}" for seconds in colours) + " s")


if __name__ == "__main__":
    main()
