"""Run the sweep of `docs/sweeps.md`, and put its command, table and picture there.

python docs/make_sweep_figure.py       half a minute
"""

from __future__ import annotations

import csv
import pathlib
import shlex
import tempfile

from blocks import write_blocks

from magshell.cli import main
from magshell.files import write_atomically

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_sweep_figure.py"
SWEEP = """magshell sweep strip-10 --set field.flux_density="0 mT:50 mT:11" \\
    --set shell.thickness="0.4,0.6,0.8,1.1 mm" --out sweep"""
SHOWN = ("cell", "field.flux_density [T]", "shell.thickness [m]", "converged", "steps", "tip.u1 [m]", "tip.u3 [m]")


def run() -> None:
    """Run the sweep in a temporary folder, and write what the page shows of it."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = shlex.split(SWEEP.replace("\\\n", ""))[1:-1]
        status = main([*arguments, f"{folder}/sweep"])
        if status:
            raise SystemExit(status)
        write_atomically(DOCS / "images" / "sweep.png", pathlib.Path(folder, "sweep", "sweep.png").read_bytes())
        with pathlib.Path(folder, "sweep", "sweep.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
    write_blocks(DOCS / "sweeps.md", {"command": f"```sh\n{SWEEP}\n```", "table": table(rows)}, COMMAND)


def table(rows: list[dict[str, str]]) -> str:
    """The last rows, with the digits that matter."""
    lines = ["| " + " | ".join(SHOWN) + " |", "|" + "---|" * len(SHOWN)]
    for row in rows[-4:]:
        lines.append("| " + " | ".join(_short(row[name]) for name in SHOWN) + " |")
    return "\n".join(lines)


def _short(text: str) -> str:
    return f"{float(text):.5g}" if "." in text else text


if __name__ == "__main__":
    run()
