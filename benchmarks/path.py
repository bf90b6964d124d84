"""Linear solves along whole paths: mixed tangent against the plain one.

python benchmarks/path.py
"""

from __future__ import annotations

import magshell as ms
from magshell import problem


def count(name: str, mixed: bool) -> tuple[str, int]:
    """Linear solves of a built-in problem, those of cut steps included, and how it ended."""
    model = problem.load(name).model
    try:
        path = ms.solve(model, ms.Settings(mixed_tangent=mixed))
    except ms.SolveError as error:
        return "stopped", error.path.solves
    return f"{len(path.steps) - 1} steps, {path.cuts} cuts", path.solves


def main() -> None:
    """Print a line per problem."""
    for name in ("strip-10", "strip-17", "strip-20", "strip-41", "thin-cross", "gripper"):
        (how, mixed), (plainly, plain) = count(name, True), count(name, False)
        print(f"{name:11s} mixed {mixed:4d} solves ({how})   plain {plain:4d} ({plainly})   ratio {plain / mixed:.1f}")


if __name__ == "__main__":
    main()
