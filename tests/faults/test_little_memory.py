"""Little memory: every command ends, says why, and is no bug; a picture that fails hides nothing."""

from __future__ import annotations

import errno
import subprocess
import sys

import pytest

from faults.limits import MUTATIONS
from magshell import cli
from magshell.errors import lacks_memory
from magshell.output import pictures

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits of the address space, and what is used of it")

STRIP = """
[mesh]
generator = "rectangle"
length = "11 mm"
width = "5 mm"
elements = [4, 1]
[shell]
thickness = "1.1 mm"
[material]
law = "micropolar-neo-hookean"
shear_modulus = "303 kPa"
lame_lambda = "7300 kPa"
coupling_modulus = "0.1 mu"
length_scale = "0.1 h"
[[remanence]]
kind = "constant"
vector = ["143 mT", 0, 0]
[field]
flux_density = [0, 0, "5 mT"]
[[supports]]
kind = "clamp"
group = "left"
"""
SIZE = """
import re
def used():
    with open("/proc/self/status") as file:
        return 1024 * int(re.search(r"VmSize:\\s+(\\d+)", file.read())[1])
"""
SECONDS = 120.0


@pytest.fixture
def strip(tmp_path):
    (tmp_path / "s.toml").write_text(STRIP)
    return tmp_path / "s.toml"


def python(script, *arguments):
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)


def imported():
    """Address space of a process that has loaded what a solve needs, bytes."""
    return int(python(f"{SIZE}import magshell.solver, magshell.shell.loops, pyvista; print(used())").stdout)


def shares():
    """Of that: a third is less than the libraries need, four fifths are enough to solve, but not to draw."""
    return [0.02 * i for i in range(5, 100)] if MUTATIONS else [0.33, 0.8]


@pytest.mark.parametrize("share", shares())
def test_a_run_ends_and_says_why(strip, share):
    script = "import resource, sys; resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[1]),) * 2)\n"
    script += "from magshell.cli import main; sys.exit(main(sys.argv[2:]))"
    done = python(script, int(share * imported()), "run", strip, "--out", strip.parent / "out")
    shown = done.stdout + done.stderr
    assert done.returncode in (0, 1), f"status {done.returncode}: {shown}"
    assert "Traceback" not in shown
    assert "this is a bug" not in shown
    if done.returncode:
        assert "error: " in done.stderr
        assert "memory" in done.stderr
    else:
        assert "solved at 100 %" in shown


def test_the_work_arrays_of_the_linear_algebra_are_allocated_before_the_first_solve():
    """With 20 MB left OpenBLAS would ask for ever for its 32 MB."""
    script = f"""{SIZE}
import resource, numpy, scipy.linalg.blas
from magshell.openblas import allocate_buffers
resource.setrlimit(resource.RLIMIT_AS, (used() + (20 << 20),) * 2)
try:
    allocate_buffers()
except MemoryError as error:
    print(error)
"""
    assert python(script).stdout == "no room for the work arrays of the linear algebra\n"


@pytest.mark.parametrize(
    ("error", "cause", "solved"),
    [
        (MemoryError(), "there is not enough memory", True),
        (ImportError("libvtk.so: failed to map segment from shared object"), "there is not enough memory", False),
        (OSError(errno.ENOSPC, "No space left on device", "shape.png"), "No space left on device", True),
        (KeyError("colour"), "KeyError: 'colour'", True),
    ],
)
def test_a_picture_that_fails_hides_neither_the_result_nor_its_reason(strip, monkeypatch, capsys, error, cause, solved):
    def fail(*arguments):
        raise error

    monkeypatch.setattr(pictures, "draw_shape", fail)
    monkeypatch.setattr(pictures, "draw_curve", fail)
    out = strip.parent / "out"
    options = [] if solved else ["--set", 'field.flux_density=[0, 0, "40 T"]', "--set", "solver.max_iterations=2"]
    status = cli.main(["run", str(strip), *options, "--out", str(out)])
    shown = capsys.readouterr()
    assert status == (0 if solved else 1), shown
    assert ("not solved: " in shown.err) is not solved
    for name in ("curve.png", "shape.png"):
        (line,) = [line for line in shown.out.splitlines() if line.startswith(f"warning: No picture {name}: ")]
        assert cause in line
    assert f"results: {out}" in shown.out
    assert (out / "summary.json").is_file()


def test_what_is_a_lack_of_memory():
    chained = ImportError("cannot import name 'vtk'")
    chained.__cause__ = OSError("libvtk.so: failed to map segment from shared object")
    lacking = [MemoryError(), OSError(errno.ENOMEM, "x"), RuntimeError("can't start new thread"), chained]
    others = [ImportError("no module named vtk"), OSError(errno.ENOSPC, "x"), RuntimeError("singular"), None]
    assert [lacks_memory(error) for error in (*lacking, *others)] == [True] * 4 + [False] * 4
