"""The built-in problems: the examples of the source paper, and published problems of classical shells.

Each is a commented problem file beside this one.
"""

from __future__ import annotations

from importlib import resources

from magshell.errors import InputError, suggest


def names() -> list[str]:
    """Names of the built-in problems."""
    files = resources.files(__name__).iterdir()
    return sorted(file.name.removesuffix(".toml") for file in files if file.name.endswith(".toml"))


def text(name: str) -> str:
    """The problem file of that name, as written.

    Raises
    ------
    InputError
        No such built-in problem; names the nearest.
    """
    if name not in names():
        raise InputError(f"There is no built-in problem '{name}'. {suggest(name, names())}")
    return resources.files(__name__).joinpath(f"{name}.toml").read_text(encoding="utf-8")
