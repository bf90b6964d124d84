"""One run at a time in a results folder."""

from __future__ import annotations

import contextlib
import os
import pathlib
import socket
from collections.abc import Iterator

from magshell.errors import InputError
from magshell.files import lock, naming
from magshell.units import shortened

NAME = ".lock"


@contextlib.contextmanager
def alone(directory: pathlib.Path) -> Iterator[None]:
    """Hold a results folder.

    The operating system releases the lock however the process ends, so a killed run never blocks the next. Where a file
    system (or Windows) has no locks, there is none.

    Raises
    ------
    InputError
        Another process holds it.
    """
    file = directory / NAME
    with contextlib.ExitStack() as stack:
        with naming(file):
            held = stack.enter_context(open(file, "a+", encoding="utf-8", errors="replace"))
        if not lock(held):
            held.seek(0)
            raise InputError(
                f"{directory}: another run writes into it ({shortened(held.read(200).strip()) or 'it has just begun'})"
            )
        with naming(file):
            held.truncate(0)
            held.write(f"process {os.getpid()} on {socket.gethostname()}\n")
            held.flush()
        yield
