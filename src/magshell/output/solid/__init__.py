"""The deformed body with its true thickness, as a closed surface and as solid elements."""

from __future__ import annotations

from magshell.output.solid.export import export, write_solid

__all__ = ["export", "write_solid"]
