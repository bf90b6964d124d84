"""The folder of a sweep: its definition, and where its cells are.

`sweep.toml` says how to go on, `problem.toml` is the file that is varied, `cells/0001/` and so on are folders of
results, `sweep.csv` is the table, `sweep-history.csv` has all steps, `sweep.png` is a picture.
"""

from __future__ import annotations

import os
import pathlib
import tomllib
from collections.abc import Sequence

from magshell.errors import InputError
from magshell.files import read_at_most, refuse_somebodys, write_atomically
from magshell.problem.building.material import WRITTEN
from magshell.problem.reading import MOST_BYTES, Source

# Version 1: of a time when materials had another coupling modulus and length scale by default.
_VERSION = 2


class SweepFolder:
    """Paths in the folder of a sweep.

    Parameters
    ----------
    path : path
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(path)
        self.definition = self.path / "sweep.toml"
        self.problem = self.path / "problem.toml"
        self.table = self.path / "sweep.csv"
        self.histories = self.path / "sweep-history.csv"
        self.picture = self.path / "sweep.png"
        self.cells = self.path / "cells"
        self.stop = self.cells / "stop"

    def begin(self, source: Source, settings: Sequence[str]) -> None:
        """Note what the sweep is, or go on with one that is the same; one that has no cells yet is replaced.

        Raises
        ------
        InputError
            The folder holds another sweep, or the results of a run.
        """
        if self.definition.exists():
            found, others = self.read()
        if self.definition.exists() and self.cells.exists():
            if (found.text, found.name) != (source.text, source.name):
                raise InputError(f"--out {self.path}: holds the sweep of another '{found.name}'; name another folder")
            if list(settings) != others:
                listed = " ".join(f'--set "{text}"' for text in others)
                raise InputError(f"--out {self.path}: holds another sweep ({listed}); name another folder")
            return
        if not self.definition.exists() and ((self.path / "summary.json").exists() or self.problem.exists()):
            raise InputError(f"--out {self.path}: holds the results of a run; name another folder")
        refuse_somebodys(
            self.path, self.definition.exists(), ("sweep.csv", "sweep-history.csv", "sweep.png", "cells/*")
        )
        write_atomically(self.problem, source.text.encode())
        write_atomically(self.definition, _definition(source, settings).encode())

    def read(self) -> tuple[Source, list[str]]:
        """The problem file that is varied, and the settings as they were written.

        Raises
        ------
        InputError
            There is no sweep, or its files are damaged.
        """
        try:
            definition = tomllib.loads(read_at_most(self.definition, MOST_BYTES).decode())
            text = read_at_most(self.problem, MOST_BYTES).decode()
        except (FileNotFoundError, NotADirectoryError) as error:
            raise InputError(f"{error.filename}: there is no such file, so this is no folder of a sweep") from None
        except OSError as error:
            raise InputError(f"{error.filename}: cannot be read: {error.strerror}") from None
        except (ValueError, RecursionError) as error:
            raise InputError(f"{self.definition}: is damaged: {error}; start the sweep again") from None
        if (version := definition.get("version")) not in (1, _VERSION):
            raise InputError(
                f"{self.definition}: version: is {version!r}; this magshell reads versions 1 and {_VERSION}"
            )
        name, folder, settings = (definition.get(key) for key in ("problem", "folder", "set"))
        if not isinstance(name, str) or not isinstance(folder, str):
            raise InputError(f"{self.definition}: problem and folder: are not both text; start the sweep again")
        if not isinstance(settings, list) or not all(isinstance(text, str) for text in settings):
            raise InputError(f"{self.definition}: set: is not a list of texts; start the sweep again")
        return Source(name, text if version == _VERSION else _as_it_was(text), pathlib.Path(folder)), settings

    def cell(self, name: str) -> pathlib.Path:
        """Folder of the results of a cell."""
        return self.cells / name


def _as_it_was(text: str) -> str:
    """A problem file with the defaults of version 1 written out."""
    import tomlkit

    document = tomlkit.parse(text)
    material, shell = document.get("material", {}), document.get("shell", {})
    if shell.get("micro_rotation", True):
        for key, value in WRITTEN.items():
            material.setdefault(key, value)
    return tomlkit.dumps(document)


def _definition(source: Source, settings: Sequence[str]) -> str:
    import tomlkit

    document = tomlkit.document()
    document.add(tomlkit.comment("A sweep. To go on, or to solve again what failed: magshell sweep --resume DIR"))
    document["version"] = _VERSION
    document["problem"] = tomlkit.string(source.name).comment("what problem.toml is a copy of")
    document["folder"] = tomlkit.string(str(source.folder.resolve())).comment("where the paths in it start")
    document["set"] = tomlkit.item(list(settings)).multiline(True)
    return tomlkit.dumps(document)
