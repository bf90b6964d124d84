"""A sweep of three cells, and workers that are this process."""

from __future__ import annotations

import io
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest
from problem_files import STRIP
from rich.console import Console

from magshell.problem.alternatives import Setting, read_settings
from magshell.problem.reading import Source
from magshell.sweep.display import Display
from magshell.sweep.folder import SweepFolder
from magshell.sweep.grid import Cell, grid

SOURCE = Source("strip.toml", STRIP, Path())
SETTINGS = ["shell.thickness=0.8 mm:1.2 mm:3"]


class Here:
    """Workers that are this process; what was given to them is remembered."""

    places = 1

    def __init__(self) -> None:
        self.cells: list[str] = []

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.cells.append(Path(arguments[3]).name)
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future

    def close(self) -> None:
        pass


@pytest.fixture
def here() -> Here:
    return Here()


@pytest.fixture
def settings() -> list[Setting]:
    return read_settings(SETTINGS)


@pytest.fixture
def cells(settings: list[Setting]) -> list[Cell]:
    return grid(SOURCE, settings)


@pytest.fixture
def folder(tmp_path: Path) -> SweepFolder:
    folder = SweepFolder(tmp_path / "sweep")
    folder.path.mkdir()
    folder.begin(SOURCE, SETTINGS)
    return folder


@pytest.fixture
def shown() -> io.StringIO:
    return io.StringIO()


@pytest.fixture
def display(shown: io.StringIO) -> Display:
    return Display(Console(file=shown, width=300))
