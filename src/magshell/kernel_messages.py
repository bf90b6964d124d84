"""Messages while kernels are compiled, in displays of a solve and in every other command."""

from __future__ import annotations

import logging
from collections.abc import Callable


class KernelMessages(logging.Handler):
    """Messages of compilation and its cache as lines of a display; the display that listens last gets them all.

    A solve compiles some fifteen functions at its first use. One line at its start says what is waited for, and how
    long; later ones say that a further law is compiled.

    Parameters
    ----------
    line : callable
        Writes a line of text, with the keyword `style`.
    solves : bool
        Whether a solve is to come, which needs all kernels.
    """

    def __init__(self, line: Callable[..., None], solves: bool = False) -> None:
        super().__init__()
        self._line, self._solves = line, solves
        self._logger = logging.getLogger("magshell.kernels")
        self._first_use = False

    def listen(self) -> None:
        """Begin; messages go nowhere else meanwhile."""
        self._before = self._logger.level, self._logger.propagate, self._logger.handlers[:]
        for handler in self._before[2]:
            if isinstance(handler, KernelMessages):
                self._logger.removeHandler(handler)
        self._logger.setLevel(logging.INFO)
        self._logger.propagate = False
        self._logger.addHandler(self)

    def stop(self) -> None:
        """End; whatever was there before listens again."""
        self._logger.removeHandler(self)
        level, self._logger.propagate, handlers = self._before
        self._logger.setLevel(level)
        for handler in handlers:
            self._logger.addHandler(handler)

    def emit(self, record: logging.LogRecord) -> None:
        """Show a message."""
        # Whoever logs here has imported these, which takes half a second; a command that only prints has not.
        from magshell.kernel_cache import COMPILING, FIRST_USE, WAITING
        from magshell.shell.loops import are_compiled

        if record.msg == FIRST_USE or (self._solves and record.msg in (COMPILING, WAITING) and not are_compiled()):
            if not self._first_use:
                self._line(FIRST_USE)
            self._first_use = True
        elif record.levelno >= logging.WARNING:
            self._line(f"warning: {record.getMessage()}", style="yellow")
        elif record.msg not in (COMPILING, WAITING):
            self._line(record.getMessage())
        elif not self._first_use:
            self._line(f"{record.getMessage()[:-4]} (some seconds, once) ...")
