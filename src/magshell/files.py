"""Files that are written completely or not at all, and disk errors that name the file."""

from __future__ import annotations

import csv
import io
import os
import pathlib
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import IO

from magshell.errors import InputError


def with_suffix(file: str | os.PathLike[str], *suffixes: str) -> pathlib.Path:
    """The path of a file to write, whose name must say the format that it gets.

    Raises
    ------
    InputError
        It ends in none of the suffixes; the message names one that does.
    """
    path = pathlib.Path(file)
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{path}: only {' or '.join(suffixes)} can be written; name it {path.stem + suffixes[0]}")
    return path


def refuse_somebodys(directory: pathlib.Path, made: bool, patterns: Iterable[str]) -> None:
    """Refuse to write into a folder where files that no run has made would be replaced or removed.

    Parameters
    ----------
    directory : pathlib.Path
    made : bool
        Whether the whole folder was made by an earlier run of the command: then anything may be replaced.
    patterns : iterable of str
        What the command writes there.

    Raises
    ------
    InputError
        Names the files.
    """
    if made:
        return
    found = {str(file.relative_to(directory)) for pattern in patterns for file in directory.glob(pattern)}
    refuse_to_replace(directory, sorted(found))


def refuse_to_replace(directory: pathlib.Path, names: Sequence[str]) -> None:
    """Refuse a folder if there are any of these files, which no run has made.

    Raises
    ------
    InputError
        Names them.
    """
    if names:
        listed = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
        raise InputError(f"{directory}: {listed} would be lost and is not of an earlier run; name another folder")


def first_line(file: pathlib.Path) -> str:
    """Of a text file, up to 1000 bytes; empty where there is none."""
    try:
        with open(file, "rb") as opened:
            return opened.readline(1000).decode("utf-8", "replace")
    except OSError:
        return ""


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
