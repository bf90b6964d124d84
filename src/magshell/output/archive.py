"""Archives of NumPy arrays (`.npz`) of unknown origin: nothing is unpacked that is larger than the file itself."""

from __future__ import annotations

import hashlib
import io
import math
import pathlib
import zipfile
from collections.abc import Mapping
from typing import IO

import numpy as np

from magshell.arrays import AnyArray

HEADER = 10_000
"""Most characters in the header of an array."""


class Unfit(ValueError):
    """An archive that magshell cannot have written; the message says why."""


def read_arrays(file: pathlib.Path, most: int) -> dict[str, AnyArray]:
    """The arrays of a file that `numpy.savez` wrote; each is read to its end, where its checksum is compared.

    Parameters
    ----------
    file : pathlib.Path
    most : int
        Bytes that it may have.

    Raises
    ------
    OSError
        It cannot be read.
    Unfit
        It is larger, compressed, or its arrays claim to be larger than they are.
    zipfile.BadZipFile, zlib.error, EOFError, ValueError, SyntaxError
        It is damaged, or something else.
    """
    size = file.stat().st_size
    if size > most:
        raise Unfit(f"{size} bytes, where at most {most} are possible")
    with zipfile.ZipFile(file) as archive:
        entries = archive.infolist()
        if any(entry.compress_type != zipfile.ZIP_STORED for entry in entries):
            raise Unfit("its arrays are compressed, as magshell never writes them")
        if sum(entry.file_size for entry in entries) > size:
            raise Unfit("its arrays claim to be larger than the file")
        return {entry.filename.removesuffix(".npy"): _array(archive.read(entry)) for entry in entries}


def _array(content: bytes) -> AnyArray:
    """An array of numbers or text whose header claims no more than there is."""
    file = io.BytesIO(content)
    shape, dtype = _header(file)
    if dtype.hasobject:
        raise Unfit("an array of Python objects")
    if any(length < 0 for length in shape) or math.prod(shape) * dtype.itemsize != len(content) - file.tell():
        raise Unfit(f"an array of the shape {shape} in {len(content)} bytes")
    file.seek(0)
    return np.lib.format.read_array(file, allow_pickle=False, max_header_size=HEADER)


def _header(file: IO[bytes]) -> tuple[tuple[int, ...], np.dtype]:
    version = np.lib.format.read_magic(file)
    read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}.get(version)
    if read is None:
        raise Unfit(f"version {version} of NumPy's format")
    shape, _, dtype = read(file, max_header_size=HEADER)
    return shape, dtype


def digest(arrays: Mapping[str, AnyArray]) -> str:
    """Of names, types, shapes and every bit of arrays, in whatever order they are."""
    found = hashlib.sha256()
    for name in sorted(arrays):
        array = np.asarray(arrays[name])
        found.update(f"{name}|{array.dtype.str}|{array.shape}|".encode())
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()
