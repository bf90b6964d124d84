"""Stresses and resultants beside known values: the table of `stress.md`, and the picture of its recipe.

python docs/make_stress_study.py      less than a minute of CPU time
"""

from __future__ import annotations

import pathlib

from blocks import write_blocks
from element_study.tables import table
from stress_study.problems import PROBLEMS, Value

import magshell as ms
from magshell.output.shape import draw_shape
from magshell.problem.building import build
from magshell.problem.reading import check, parse

PAGE = pathlib.Path(__file__).parent / "stress.md"
PICTURE = pathlib.Path(__file__).parent / "images" / "stress-arm.png"
COMMAND = "docs/make_stress_study.py"


def known_values() -> str:
    """A row for each value, a column for each mesh."""
    rows = []
    for solve, counts in PROBLEMS.values():
        found = [solve(count) for count in counts]
        for values in zip(*found, strict=True):
            last: Value = values[-1]
            errors = ", ".join(f"{100.0 * value.error:+.2f}" for value in values)
            meshes = ", ".join(map(str, counts))
            row = [last.problem, last.quantity, last.unit, f"{last.reference:.6g}", f"{last.computed:.6g}"]
            rows.append([*row, meshes, errors, f"{100.0 * last.within:g} %"])
    heads = ("Problem", "Quantity", "Unit", "Reference", "Finest mesh", "Elements along a side", "Errors (%)", "Within")
    return table(heads, rows)


def main() -> None:
    """Solve, write the table, draw."""
    write_blocks(PAGE, {"known": known_values()}, COMMAND)
    text = PAGE.read_text(encoding="utf-8").split("```toml\n")[1].split("```")[0]
    arm = build(check(parse(text, "arm.toml"), "arm.toml"), "arm.toml", text)
    draw_shape(ms.solve(arm.model, arm.settings), PICTURE, color="von_mises_top")


if __name__ == "__main__":
    main()
