"""One self-contained HTML page of a path: the shape in three dimensions beside the curves."""

from __future__ import annotations

from magshell.output.page.page import page, write_page
from magshell.output.page.steps import shown_steps

__all__ = ["page", "shown_steps", "write_page"]
