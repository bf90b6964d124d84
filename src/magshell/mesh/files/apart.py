"""Calls of other programs, in a process of their own.

On a damaged file they may crash, which then ends only that process. They can be stopped, and what they print, leave
behind or do to signals has no effect here.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import TypeVar

from magshell.errors import InputError

Result = TypeVar("Result")


def apart(
    function: Callable[..., Result], *arguments: object, program: str, name: str, seconds: int | None = None
) -> Result:
    """Call a function in another process and return its result.

    Parameters
    ----------
    function : callable
        Of a module; it, the arguments and the result can be pickled.
    *arguments
    program : str
        That the function calls, for messages.
    name : str
        Of the file that it is called for, for messages.
    seconds : int, optional
        Of CPU time that it may take, where the system can see to that.

    Raises
    ------
    InputError
        What the function raises, or that the program has crashed or found no end.
    """
    with subprocess.Popen(
        [sys.executable, "-P", "-m", __name__],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(os.path.abspath, sys.path))},
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(pickle.dumps((function, arguments, program, name, seconds)))
            process.stdin.flush()
            answer = process.stdout.read()
            if not answer:
                process.wait()
        finally:
            process.kill()
    try:
        found: Result | InputError = pickle.loads(answer)
    except (EOFError, pickle.UnpicklingError):
        if process.returncode == 0:
            raise InputError(f"{name}: ends {program} before all of it is read; a script must not have Exit") from None
        if -process.returncode == getattr(signal, "SIGXCPU", None):
            raise InputError(f"{name}: {program} does not finish reading it: it is damaged") from None
        raise InputError(f"{name}: {program} crashes on it: it is damaged, or too large for the memory") from None
    if isinstance(found, InputError):
        raise found
    return found


def _main() -> None:
    """Send what a call returns, or what is wrong, to standard output, on which nobody else writes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    function, arguments, program, name, seconds = pickle.load(sys.stdin.buffer)
    threading.Thread(target=_end_with_the_one_who_asked, daemon=True).start()
    with os.fdopen(os.dup(1), "wb") as answer:
        os.dup2(2, 1)
        _limit(seconds)
        try:
            found = function(*arguments)
        except InputError as error:
            found = error
        except Exception as error:
            found = InputError(f"{name}: cannot be read by {program}: {type(error).__name__}; it is damaged")
        answer.write(pickle.dumps(found))


def _end_with_the_one_who_asked() -> None:
    """However it ends: its end of the pipe is closed then."""
    os.read(0, 1)
    os._exit(1)


def _limit(seconds: int | None) -> None:
    """Time, and memory to what the machine has: a damaged count may ask for anything. A crash leaves no core file."""
    try:
        import resource
    except ImportError:
        return
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    for what, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_AS, memory), (resource.RLIMIT_CPU, seconds)):
        if most is not None:
            with contextlib.suppress(ValueError, OSError):
                resource.setrlimit(what, (most, resource.getrlimit(what)[1]))


if __name__ == "__main__":
    _main()
