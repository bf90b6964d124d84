"""`python -m magshell`."""

from __future__ import annotations

import sys

from magshell.cli import main

if __name__ == "__main__":
    sys.exit(main())
