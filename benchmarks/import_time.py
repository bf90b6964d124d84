"""CPU time of `import magshell` in a fresh interpreter, beside that of numpy alone.

python benchmarks/import_time.py
"""

from __future__ import annotations

import subprocess
import sys


def cpu(statement: str) -> float:
    """Median of five, s."""
    code = f"import time; start = time.process_time(); {statement}; print(time.process_time() - start)"
    times = sorted(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(5))
    return times[2]


def main() -> None:
    """Print the figures."""
    print(f"import numpy      {cpu('import numpy'):.2f} s")
    print(f"import magshell   {cpu('import magshell'):.2f} s  (asked: below 0.5)")
    print(f"its public names  {cpu('import magshell; [getattr(magshell, name) for name in magshell.__all__]'):.2f} s")


if __name__ == "__main__":
    main()
