"""The version of this package, which is also written into results."""

from __future__ import annotations

__version__ = "0.1.0"
