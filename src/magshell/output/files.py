"""Files that are whole or absent, and disk errors that name the file."""

from __future__ import annotations

import csv
import io
import os
import pathlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


@contextmanager
def naming(path: pathlib.Path) -> Iterator[None]:
    """Make every OSError of the block carry the path (a full disk does not say which file it was)."""
    try:
        yield
    except OSError as error:
        if error.filename is not None:
            raise
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


def write_atomically(path: pathlib.Path, content: bytes) -> None:
    """Write a file through a temporary one beside it, so that a reader sees the old or the new one.

    Parameters
    ----------
    path : pathlib.Path
        Its folder is made if missing.
    content : bytes

    Raises
    ------
    OSError
        The disk refuses; the message names the file and an older one is left as it was.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    with naming(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            temporary.write_bytes(content)
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def append_line(path: pathlib.Path, line: str) -> None:
    """Append a line in one write, so that it is on disk when this returns; a failed one is taken back.

    Raises
    ------
    OSError
        The disk refuses; the message names the file, which is left as it was.
    """
    with naming(path), open(path, "ab", buffering=0) as file:
        before = file.tell()
        content = line.encode()
        try:
            while content:
                content = content[file.write(content) or 0 :]
        except BaseException:
            file.truncate(before)
            raise


def csv_line(values: Iterable[str]) -> str:
    """A line of a CSV file."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()
