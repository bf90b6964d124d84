"""Rigid bodies, joints and hinges against closed forms: write the table of `joints-accuracy.md`.

python docs/make_joint_study.py       half a minute
"""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Sequence

from blocks import write_blocks
from joint_study.frames import cantilever, hinge, joint_row, large_rotation, stiff_hinge, tee
from joint_study.sections import box, folded_plate, z_section
from joint_study.strips import SCALES, Row, rolled, tip_magnet

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_joint_study.py"


def rigid_ends(name: str) -> Iterator[Row]:
    """Strips with rigid ends and moments."""
    yield from rolled(name, by_moment=False)
    yield from rolled(name, by_moment=True)
    yield from tip_magnet(name)


GROUPS = {
    "rigid-ends": (rigid_ends,),
    "frames": (cantilever, tee, large_rotation),
    "sections": (box, folded_plate),
    "hinges": (hinge, stiff_hinge),
    "rows-of-joints": (joint_row,),
}
"""Blocks of the page: functions of a length scale."""


def table(rows: Sequence[Row]) -> str:
    """The rows as a table: cases with both length scales beside each other."""
    lines = [
        "| Case | Quantity | Reference | l = h/10 | off by (%) | l = h/100 | off by (%) |",
        "|---|---|---:|---:|---:|---:|---:|",
    ]
    by_name: dict[tuple[str, str], dict[str, Row]] = {}
    for row in rows:
        by_name.setdefault((row.case, row.quantity), {})[row.scale] = row
    for (case, quantity), found in by_name.items():
        cells = [f"{one.found:.6g} | {100.0 * one.difference:.3f}" if (one := found.get(s)) else " | " for s in SCALES]
        reference = next(iter(found.values())).reference
        lines.append(f"| {case} | {quantity} | {reference:.6g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    """Write the blocks, and print them."""
    blocks = {
        block: table([row for name in SCALES for function in functions for row in function(name)])
        for block, functions in GROUPS.items()
    }
    blocks["z-section"] = table(list(z_section()))
    for block in blocks.values():
        print(block, end="\n\n")
    write_blocks(DOCS / "joints-accuracy.md", blocks, COMMAND)


if __name__ == "__main__":
    main()
