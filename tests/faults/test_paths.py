"""Every command with paths that are odd, wrong or in the way."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from problem_files import STRIP, with_mesh

import magshell as ms
from faults.limits import MUTATIONS, bounded
from magshell.cli import COMMANDS, main

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links, and names that Windows refuses")

HUGE = 1 << (30 if MUTATIONS else 28)


def missing(place: Path) -> None:
    pass


def a_folder(place: Path) -> None:
    place.mkdir()


def empty(place: Path) -> None:
    place.touch()


def blank(place: Path) -> None:
    place.write_text(" \n\t\n")


def huge(place: Path) -> None:
    with place.open("wb") as file:
        file.truncate(HUGE)


def noise(place: Path) -> None:
    place.write_bytes(bytes(range(256)) * 20)


def dangling(place: Path) -> None:
    place.symlink_to("nowhere")


def a_loop(place: Path) -> None:
    place.symlink_to(place.name)


def below_a_file(place: Path) -> None:
    place.parent.rmdir()
    place.parent.touch()


KINDS = [missing, a_folder, empty, blank, huge, noise, dangling, a_loop, below_a_file]
NAMES = ["a b", "é ü №", "q'u\"o", "new\nline", "-dash", "%s {} $x", "n" * 300, "nul\0", "~"]


class Use(NamedTuple):
    """A command and what it reads: {file} is the path in question."""

    arguments: tuple[str, ...]
    suffix: str


READING = {
    "check": Use(("check", "{file}"), ".toml"),
    "run": Use(("run", "{file}", "--out", "out"), ".toml"),
    "buckling": Use(("buckling", "{file}", "--out", "out"), ".toml"),
    "show": Use(("show", "{file}", "--out", "out.png"), ".toml"),
    "sweep": Use(("sweep", "{file}", "--set", "shell.thickness=1 mm", "--out", "out"), ".toml"),
    "mesh": Use(("mesh", "{file}", "--unit", "mm"), ".msh"),
    "mesh inp": Use(("mesh", "{file}", "--unit", "mm"), ".inp"),
    "mesh vtu": Use(("mesh", "{file}", "--unit", "mm"), ".vtu"),
    "mesh geo": Use(("mesh", "{file}", "--unit", "mm"), ".geo"),
    "view": Use(("view", "{file}"), ""),
    "plot": Use(("plot", "{file}"), ""),
    "export": Use(("export", "{file}", "--out", "body.stl"), ""),
    "resume": Use(("run", "--resume", "{file}"), ""),
    "resume sweep": Use(("sweep", "--resume", "{file}"), ""),
}
WRITING = {
    "run": ("run", "strip.toml", "--out", "{file}"),
    "buckling": ("buckling", "strip.toml", "--out", "{file}"),
    "sweep": ("sweep", "strip.toml", "--set", "shell.thickness=1 mm", "--out", "{file}"),
    "reproduce": ("reproduce", "strips", "--out", "{file}"),
}


def test_every_command_is_here() -> None:
    known = {use.arguments[0] for use in READING.values()} | {arguments[0] for arguments in WRITING.values()}
    assert known | {"examples"} == set(COMMANDS)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "here"
    (folder / "some").mkdir(parents=True)
    monkeypatch.chdir(folder)
    return folder


def refused(arguments: tuple[str, ...], path: str, capsys: pytest.CaptureFixture[str]) -> str:
    """What is said; it must be an error of bearable length that names the path."""
    with bounded():
        try:
            status = main([part.replace("{file}", path) for part in arguments])
        except SystemExit as refusal:  # argparse refuses what looks like an option
            status = int(refusal.code or 0)
    said = capsys.readouterr().err
    assert status in (1, 2), said
    assert "bug in magshell" not in said
    assert "Traceback" not in said
    assert 0 < len(said) < 2000, said
    return said


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("command", READING)
def test_what_is_no_file_to_read(
    command: str, kind: Callable[[Path], None], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    use = READING[command]
    place = here / "some" / f"thing{use.suffix}"
    kind(place)
    before = sorted(here.rglob("*"))
    said = refused(use.arguments, str(place.relative_to(here)), capsys)
    assert "thing" in said
    assert all(line.startswith("error: ") for line in said.splitlines()), said
    assert sorted(here.rglob("*")) == before, "something was written"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("command", READING)
def test_odd_names_of_nothing(command: str, name: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    refused(READING[command].arguments, f"{name}{READING[command].suffix}", capsys)
    assert [path.name for path in here.iterdir()] == ["some"], "something was written"


@pytest.mark.parametrize(
    "place", ["taken", "taken/below", "loop", "nul\0", "n" * 300, "/proc/nowhere", "/dev/null", "link/below"]
)
@pytest.mark.parametrize("command", WRITING)
def test_nowhere_to_write(command: str, place: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "strip.toml").write_text(STRIP)
    (here / "taken").write_text("my work")
    (here / "loop").symlink_to("loop")
    (here / "link").symlink_to("taken")
    said = refused(WRITING[command], place, capsys)
    assert said.startswith("error: --out "), said
    assert (here / "taken").read_text() == "my work"


@pytest.mark.parametrize("name", ["out", "picture"])
def test_a_file_in_the_way_of_a_picture(name: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of the one that is drawn before a solve: a folder in its place, or nowhere to write it."""
    (here / "strip.toml").write_text(STRIP)
    (here / "out.png").mkdir()
    place = {"out": "out.png", "picture": "/proc/nowhere/out.png"}[name]
    said = refused(("show", "strip.toml", "--out", "{file}"), place, capsys)
    assert place.removesuffix("/out.png") in said


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read and write anywhere")
@pytest.mark.parametrize("command", [*READING, *WRITING])
def test_what_may_not_be_read_or_written(command: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "strip.toml").write_text(STRIP)
    locked = here / "some" / f"thing{READING[command].suffix}" if command in READING else here / "some"
    if command in READING and READING[command].suffix:
        locked.touch(0o000)
    else:
        locked.mkdir(0o500, exist_ok=True)
        locked.chmod(0o500)
    arguments = READING[command].arguments if command in READING else WRITING[command]
    assert str(locked.relative_to(here)) in refused(arguments, str(locked.relative_to(here)), capsys)


def test_names_with_spaces_and_letters_of_any_kind(
    here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A problem, its mesh, its table and its results, all of them with such names, through the commands."""
    monkeypatch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
    monkeypatch.setattr("magshell.output.setup.DPI", 40)
    folder = here / "Ordner mit Lücke"
    folder.mkdir()
    ms.mesh.write(ms.mesh.rectangle(20e-3, 5e-3, (4, 1)), folder / "Teil №1 ü.msh", "mm")
    rows = "".join(f"{2.5 + 5 * i},2.5,0,143,0,0\n" for i in range(4))
    (folder / "gemessen à b.csv").write_text(f"x1,x2,x3,b1,b2,b3\n{rows}")
    text = with_mesh(STRIP, '[mesh]\nfile = "Teil №1 ü.msh"\n\n')
    table = 'kind = "file"\nfile = "gemessen à b.csv"\nflux_density_unit = "mT"\nlength_unit = "mm"'
    text = text.replace('kind = "constant"\nvector = ["143 mT", 0, 0]', table)
    problem = folder / "Ärmchen 'a' №3.toml"
    problem.write_text(text)
    out = folder / "Ergebnisse é" / "erste"
    for arguments in (
        ["check", str(problem)],
        ["show", str(problem), "--out", str(folder / "Bild ü.png")],
        ["run", str(problem), "--out", str(out)],
        ["run", "--resume", str(out)],
        ["view", str(out)],
        ["sweep", str(problem), "--set", "shell.thickness=0.9,1.1 mm", "--out", f"{out} Schar", "--workers", "1"],
    ):
        status = main(arguments)
        shown = capsys.readouterr()
        assert (status, shown.err) == (0, ""), arguments
    assert "Ergebnisse é" in shown.out
    assert (out / "view.html").stat().st_size > 10_000
