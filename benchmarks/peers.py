"""magshell against other codes on two published shell problems, to full load, in one run.

    python benchmarks/peers.py [--problem hemisphere annulus]

Peers are an extra: pip install 'magshell[peers]'. One that is missing is named and left out. Every code runs by itself
in a process of one thread and counts the CPU time of its solve: not its imports, its mesh or the compilation of its
kernels. An iteration is one factorisation and solve. magshell runs with its default settings and step control; the
others have none, and of several numbers of equal load steps the one with the fewest iterations is shown.

Errors are those of the displacements at the full load, the larger of two: beside the source's table, whose own
four-node elements are some tenths of a per cent off, and beside the limit of fine meshes (`peers_limit.py`).
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

from peers_problems import PROBLEMS, Answer

HERE = Path(__file__).parent
# Module that a code needs, its script, and the script's first arguments.
CODES = {
    "magshell": ("magshell", "peers_magshell.py", [[]]),
    "Kratos": (
        "KratosMultiphysics", "peers_kratos.py", [["thin-4"], ["thick-4"], ["thin-3"], ["thick-3"]],
    ),
    "NGSolve": ("ngsolve", "peers_ngsolve.py", [["2"]]),
}  # fmt: skip
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NGS_NUM_THREADS", "NUMBA_NUM_THREADS")
HEADER = f"{'code':16s} {'element':34s} {'problem':11s} unknowns steps  iter.   CPU s   table   limit"


def answered(script: str, arguments: list[str]) -> Answer:
    """What a script answers in a process of its own."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    environment = {**os.environ, **dict.fromkeys(THREADS, "1"), "PATH": path}
    run = subprocess.run(
        [sys.executable, str(HERE / script), *arguments], env=environment, capture_output=True, check=False
    )
    for line in run.stdout.decode(errors="replace").splitlines():
        if line.startswith("ANSWER "):
            return Answer(**json.loads(line.removeprefix("ANSWER ")))
    last = run.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no message"]
    name = next(argument for argument in arguments if argument in PROBLEMS)
    return Answer(script, " ".join(arguments), name, reason=f"exit status {run.returncode}: {last[0]}")


def line(answer: Answer, ours: float | None) -> str:
    """A row of the table."""
    row = f"{answer.code:16s} {answer.element:34s} {answer.problem:11s}"
    if not answer.values:
        return f"{row} failed: {answer.reason}"
    problem = PROBLEMS[answer.problem]
    row += f" {answer.unknowns:8d} {answer.steps:5d} {answer.solves:6d} {answer.seconds:7.2f}"
    row += "".join(f" {100 * answer.error(values):5.2f} %" for values in (problem.table, problem.limit))
    return row + (f"   {answer.seconds / ours:5.1f} times magshell's CPU time" if ours else "")


def compare(problems: list[str]) -> None:
    """The table of all codes."""
    print(HEADER)
    for name in problems:
        ours = None
        for code, (module, script, variants) in CODES.items():
            if importlib.util.find_spec(module) is None:
                print(f"{code:16s} is not installed: left out")
                continue
            for variant in variants:
                answer = answered(script, [*variant, name])
                print(line(answer, ours), flush=True)
                if code == "magshell" and answer.values:
                    ours = answer.seconds


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--problem", nargs="+", default=list(PROBLEMS), choices=list(PROBLEMS))
    compare(parser.parse_args().problem)


if __name__ == "__main__":
    main()
