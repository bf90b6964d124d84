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

import magshell as ms
from magshell.assembly import Discretisation
from magshell.linalg.ordering import nested_dissection
from magshell.output.page import write_page
from magshell.shell.state import State
from magshell.solver.path import Path, Step

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests" / "browser"))

from chromium import browser, missing

LENGTH, WIDTH, ELEMENTS, STEPS = 0.1, 0.1, (100, 50), 30
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


def rolled(elements: tuple[int, int] = ELEMENTS, steps: int = STEPS) -> Path:
    """A plate clamped at one end and rolled up to a circle, with directors and rotations that go with it."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    rubber = ms.MicropolarNeoHookean(shear_modulus=303e3, lame_lambda=7.3e6, coupling_modulus=30.3e3, length_scale=1e-4)
    shell = ms.Shell(mesh, 1e-3, rubber, ms.remanence.constant([143e-3, 0, 0]))
    model = ms.Model(
        shell, supports=[ms.Clamp("left")], field=ms.UniformField([0, 0, 50e-3]), probes={"tip": (LENGTH, WIDTH / 2, 0)}
    )
    settings = ms.Settings()
    discretisation = Discretisation(model, nested_dissection)
    path = Path(model, discretisation, settings, "none")
    rest = discretisation.undeformed()
    s = mesh.points[:, 0]
    for number in range(steps + 1):
        load = number / steps
        angle = 2 * np.pi * load / LENGTH * s
        zero = np.zeros_like(s)
        x = s * np.sinc(angle / np.pi)
        z = s * np.sin(angle / 2) * np.sinc(angle / (2 * np.pi))
        u = np.stack([x - s, zero, z], axis=1)
        w = np.stack([-np.sin(angle), zero, np.cos(angle) - 1], axis=1)
        q = np.stack([np.cos(angle / 2), zero, -np.sin(angle / 2), zero], axis=1)
        state = State(u, w, zero, q, rest.alpha)
        field = load * model.field.vector
        path.steps.append(Step(number, load, state, 4, 0.0, None, float(load), 0, field, np.zeros(0), 0))
    path.converged = True
    return path


def main() -> None:
    """Print the figures."""
    if missing():
        raise SystemExit(f"this benchmark needs {missing()}")
    path = rolled()
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
