"""Exit statuses of the command."""

from __future__ import annotations

SOLVED, NOT_SOLVED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
