"""Finds the functions that draw or write an object, by name.

Meshes, models and paths show and save themselves, but the modules that draw import them. So these functions are looked
up here when they are called; no other module of the package looks upward.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

HOMES = {
    "mesh_html": "magshell.output.notebook",
    "model_html": "magshell.output.notebook",
    "path_html": "magshell.output.notebook",
    "buckling_html": "magshell.output.notebook",
    "problem_html": "magshell.problem.report",
    "save_path": "magshell.output.saved",
    "export": "magshell.output.solid",
    "table": "magshell.output.history",
    "write_page": "magshell.output.page",
    "animate": "magshell.output.animation",
    "draw_shape": "magshell.output.pictures",
}


def drawing(name: str) -> Callable[..., Any]:
    """The function of this name that draws or writes an object."""
    found: Callable[..., Any] = getattr(import_module(HOMES[name]), name)
    return found
