"""Machine code of the kernels on disk: one file for each compiled function, with a checksum.

A file's folder and name hold digests of all that its content depends on: the sources, the argument types, the
processor and the versions of Numba and Python. So a file is either right or damaged; a damaged one is dropped.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import importlib.util
import logging
import multiprocessing
import os
import pathlib
import pickle
import sys
import sysconfig
from functools import cache
from typing import Any

import numba
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from magshell.files import write_atomically

log = logging.getLogger("magshell.kernels")

# Messages, one for each function. Displays show FIRST_USE in place of them while the large kernels are missing.
COMPILING = "compiling %s ..."
WAITING = "waiting for another process that compiles %s ..."
FIRST_USE = "compiling the kernels for the first use of this version (about half a minute, once) ..."

LARGE = ("fill", "predict_stresses")
"""Kernels that take so long that even a program without a display says it."""
PACKAGE = "magshell"
SUFFIX = ".kernel"
_CHECKSUM = hashlib.sha256
CHECKSUM_SIZE = _CHECKSUM().digest_size


def sources(file: pathlib.Path) -> frozenset[pathlib.Path]:
    """A Python file and all files that it imports, directly or not, without the standard and installed libraries.

    Installed packages are left out but for this one and the file's own: their versions change seldom, and kernels call
    none but Numba and NumPy.
    """
    file = file.resolve()
    found, waiting = {file}, [file]
    own = _package_of(file)
    while waiting:
        for name in _imported(waiting.pop()):
            source = _source_of(name)
            if source is not None and source not in found and _is_followed(name, source, own):
                found.add(source)
                waiting.append(source)
    return frozenset(found)


@cache
def digest(*files: pathlib.Path) -> str:
    """Of the contents of all `sources` of files."""
    contents = sorted(_CHECKSUM(source.read_bytes()).digest() for source in frozenset().union(*map(sources, files)))
    return _CHECKSUM(b"".join(contents)).hexdigest()[:16]


def _package_of(file: pathlib.Path) -> pathlib.Path:
    """The outermost package that a file is in, or the file."""
    place = file
    while (place.parent / "__init__.py").exists():
        place = place.parent
    return place


def _is_followed(name: str, source: pathlib.Path, own: pathlib.Path) -> bool:
    if name.split(".")[0] == PACKAGE or source.is_relative_to(own):
        return True
    return not any(source.is_relative_to(library) for library in _libraries())


@cache
def _libraries() -> frozenset[pathlib.Path]:
    """Folders of the standard and the installed libraries."""
    paths = sysconfig.get_paths()
    return frozenset(pathlib.Path(paths[kind]).resolve() for kind in ("stdlib", "platstdlib", "purelib", "platlib"))


@cache
def _imported(file: pathlib.Path) -> frozenset[str]:
    """Names of the modules that a file imports when it runs; a package only if it takes more of it than modules."""
    names: set[str] = set()
    tree = ast.parse(file.read_bytes())
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            node.body = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = _absolute(node, file)
            parts = {f"{base}.{alias.name}" for alias in node.names}
            modules = {part for part in parts if _source_of(part) is not None}
            names.update(modules if modules == parts else {base, *modules})
    return frozenset(names)


def _absolute(node: ast.ImportFrom, file: pathlib.Path) -> str:
    """The module's whole name, also of `from . import`."""
    if not node.level:
        return node.module or ""
    parts: list[str] = []
    folder = file.parent
    while (folder / "__init__.py").exists():
        parts.insert(0, folder.name)
        folder = folder.parent
    parts = parts[: len(parts) - node.level + 1]
    return ".".join([*parts, node.module] if node.module else parts)


@cache
def _source_of(name: str) -> pathlib.Path | None:
    """The file of a module, which is not imported for this; None: there is none, or it is no Python file."""
    top, *rest = name.split(".")
    try:
        found = importlib.util.find_spec(top) if top else None
    except (ImportError, ValueError):
        return None
    if found is None:
        return None
    origin = found.origin if found.has_location else None
    folders = [pathlib.Path(folder) for folder in found.submodule_search_locations or ()]
    for part in rest:
        candidates = [place for folder in folders for place in (folder / part / "__init__.py", folder / f"{part}.py")]
        origin = next((str(place) for place in candidates if place.is_file()), None)
        folders = [folder / part for folder in folders if (folder / part).is_dir()]
    return pathlib.Path(origin).resolve() if origin is not None and origin.endswith(".py") else None


class Store:
    """The files of one function, as Numba asks a dispatcher's cache for them.

    Parameters
    ----------
    folder : pathlib.Path or None
        Of this version of the sources, in the cache; it may be one that cannot be written. None: nothing is kept.
    name : str
        Of the function.
    shown : str
        The same for messages.
    """

    def __init__(self, folder: pathlib.Path | None, name: str, shown: str) -> None:
        self.folder, self.name = folder, name
        self.cache_path = str(folder)
        self._shown = shown

    def enable(self) -> None:
        """For Numba; it always is."""

    def load_overload(self, signature: Any, context: Any) -> Any:
        """The compiled function for a signature; None, and a message: it will be compiled."""
        context.refresh()
        found = None
        if self.folder is not None:
            found = self._read(self.folder, self._file(self.folder, signature, context.codegen()))
        if found is not None:
            return CompileResult._rebuild(context, *found)
        if self.name in LARGE and multiprocessing.parent_process() is None:
            _warn_once(FIRST_USE)
        log.info(COMPILING, self._shown)
        return None

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Write the file; a folder that cannot be written is named, once."""
        if self.folder is None or compiled.library.has_dynamic_globals:
            return
        payload = dumps(compiled._reduce())
        try:
            file = self._file(self.folder, signature, compiled.codegen)
            write_atomically(file, _CHECKSUM(payload).digest() + payload)
        except OSError as error:
            _warn_once(
                f"{self.folder.parent}: compiled kernels cannot be kept there ({error.strerror or error}); "
                "they are compiled anew in each run"
            )

    def holds_any(self) -> bool:
        """Whether it has a function for this machine, of whatever signature."""
        if self.folder is None:
            return False
        codegen = numba.core.registry.cpu_target.target_context.codegen()
        return any(self.folder.glob(f"{self.name}-{_machine(codegen)}-*{SUFFIX}"))

    def _read(self, folder: pathlib.Path, file: pathlib.Path) -> Any:
        """What a file holds; None where there is none, and where it is damaged: then it is removed."""
        try:
            content = file.read_bytes()
        except OSError:
            return None
        checksum, payload = content[:CHECKSUM_SIZE], content[CHECKSUM_SIZE:]
        if _CHECKSUM(payload).digest() == checksum:
            return pickle.loads(payload)
        with contextlib.suppress(OSError):
            file.unlink()
        _warn_once(f"{folder.parent}: compiled kernels there are damaged; they are compiled anew")
        return None

    def _file(self, folder: pathlib.Path, signature: Any, codegen: Any) -> pathlib.Path:
        types = _CHECKSUM(repr(signature).encode()).hexdigest()[:16]
        return folder / f"{self.name}-{_machine(codegen)}-{types}{SUFFIX}"


def _machine(codegen: Any) -> str:
    """Digest of the processor and of what made the machine code."""
    known = (codegen.magic_tuple(), numba.__version__, sys.implementation.cache_tag, os.name)
    return _CHECKSUM(repr(known).encode()).hexdigest()[:8]


@cache
def _warn_once(text: str) -> None:
    log.warning(text)
