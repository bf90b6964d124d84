"""How accurate the shell is: solve, print, draw and write `docs/how-accurate.md`.

    python docs/make_accuracy_study.py                     everything, about half an hour on one core
    python docs/make_accuracy_study.py --only thinness     one part

Finished runs are kept in `results/accuracy-study`; an interrupted study goes on where it was. A change of the physics
makes them anew.
"""

from __future__ import annotations

import argparse

from accuracy_study import claims, convergence, laws, parameters, pump, solids, thinness
from accuracy_study.page import write
from accuracy_study.runs import Runs

PARTS = {
    "convergence": convergence.study,
    "claims": claims.study,
    "solids": solids.study,
    "thinness": thinness.study,
    "laws": laws.study,
    "parameters": parameters.study,
    "pump": pump.study,
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
            print("\n\n".join(findings.tables.values()), flush=True)
            write(findings)
    print(f"CPU time of all runs: {runs.cpu / 60.0:.0f} min")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        raise SystemExit("Interrupted; finished runs are kept, start again to go on.") from None
