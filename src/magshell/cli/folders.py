"""Folders for results."""

from __future__ import annotations

import os
import pathlib

from magshell.errors import InputError


def made(directory: pathlib.Path) -> pathlib.Path:
    """The folder for the results, made if missing; refused unless it is writable."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"--out {directory}: is a file, or lies below one; name a folder") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"--out {directory}: cannot be made: {reason}") from None
    if not os.access(directory, os.W_OK | os.X_OK):
        raise InputError(f"--out {directory}: is not writable; name another folder")
    return directory
