"""Files that are whole or absent, and disk errors that name the file."""

from __future__ import annotations

import csv
import io
import os
import pathlib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import IO


def read_at_most(path: pathlib.Path, most: int) -> bytes:
    """The bytes of a file from anybody.

    Raises
    ------
    OSError
        It cannot be read.
    ValueError
        It has more than `most`.
    """
    with open(path, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ValueError(f"it has more than {most} bytes")
    return content


@contextmanager
def naming(path: pathlib.Path) -> Iterator[None]:
    """Make every OSError of the block carry the path (a full disk does not say which file it was)."""
    try:
        yield
    except OSError as error:
        if error.filename is not None:
            raise
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


# Least memory page: a write within one is seen whole or not at all, even if the process is killed in it.
PAGE = 4096


def write_atomically(path: pathlib.Path, content: bytes, durably: bool = False) -> None:
    """Write a file through a temporary one beside it, so that a reader sees the old or the new one.

    Parameters
    ----------
    path : pathlib.Path
        Its folder is made if missing.
    content : bytes
    durably : bool
        Return only when the disk has it, so that it also outlives the machine.

    Raises
    ------
    OSError
        The disk refuses; the message names the file and an older one is left as it was.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(temporary, "wb") as file:
            file.write(content)
            if durably:
                file.flush()
                os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException as error:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        raise


def append_line(path: pathlib.Path, line: str) -> None:
    """Append a line, so that it is there when this returns; a reader sees all of it or nothing.

    Within a page of the file that is one write; over its end the file is written anew.

    Raises
    ------
    OSError
        The disk refuses; the message names the file, which is left as it was.
    """
    content = line.encode()
    with naming(path), open(path, "ab", buffering=0) as file:
        before = file.tell()
        if before // PAGE != (before + len(content) - 1) // PAGE:
            write_atomically(path, path.read_bytes() + content)
            return
        try:
            while content:
                content = content[file.write(content) or 0 :]
        except BaseException:
            file.truncate(before)
            raise


def lock(file: IO[str], wait: bool = False) -> bool:
    """Lock an open file until it is closed, which it also is however the process ends; whether that was possible.

    Where a file system (or Windows) has no locks, it always is.
    """
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except (ImportError, OSError):
        return True
    return True


def remove_temporaries(directory: pathlib.Path) -> None:
    """Remove what killed processes left of files that they were writing, in a folder and those in it."""
    with naming(directory):
        for left in directory.rglob(".*.tmp"):
            if re.fullmatch(r"\..+\.\d+\.tmp", left.name):
                left.unlink(missing_ok=True)


def csv_line(values: Iterable[str]) -> str:
    """A line of a CSV file."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()
