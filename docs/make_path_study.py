"""Path following: solve, draw, and write the tables and pictures of `path-following.md`.

    python docs/make_path_study.py                  some minutes of CPU time
    python docs/make_path_study.py --only arch      one part

Finished runs are kept in `results/path-study`; an interrupted study goes on where it was. Runs of other sources are
not reused.
"""

from __future__ import annotations

import argparse

from path_study import arch, energy, multipliers, pump, random_models, strip, turning
from path_study.page import write
from path_study.runs import Runs

PARTS = {
    "arch": arch.study,
    "strip": strip.study,
    "turning": turning.study,
    "energy": energy.study,
    "multipliers": multipliers.study,
    "pump": pump.study,
    "random": random_models.study,
}


def main() -> None:
    """Make the parts that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=PARTS, metavar="NAME", help=", ".join(PARTS))
    only = parser.parse_args().only
    runs = Runs()
    for name, study in PARTS.items():
        if only in (None, name):
            print(f"== {name}", flush=True)
            findings = study(runs)
            print("\n\n".join(findings.blocks.values()), flush=True)
            write(findings)
    print(f"CPU time of all runs: {runs.cpu / 60.0:.1f} min")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        raise SystemExit("Interrupted; finished runs are kept, start again to go on.") from None
