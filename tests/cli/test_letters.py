"""Terminals that cannot show é or ³: every command says what it has to say, readably, and ends as elsewhere."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from problem_files import STRIP, changed, with_mesh

import magshell as ms
from magshell.cli import COMMANDS, main
from magshell.cli.letters import NAME, readable, write_readably

ENCODINGS = ["ascii", "cp932", "cp1251", "cp437", "utf-8"]
TITLE = "Ärmchen № 3 µ μ ³ ± 10² 漢字 😀"
HELP = [[name, "--help"] for name in COMMANDS]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A problem whose letters few code pages have, its mesh, and its results."""
    here = tmp_path_factory.mktemp("é")
    ms.mesh.write(ms.mesh.rectangle(20e-3, 5e-3, (4, 1)), here / "Flügel ³.msh", "mm")
    text = with_mesh(STRIP, '[mesh]\nfile = "Flügel ³.msh"\n\n')
    text = changed(text, ("\ntip =", '\n"Spitzé" ='), ('stops = ["1 mT", "2 mT"]', 'stops = ["1 mT"]'))
    (here / "Ärmchen.toml").write_text(f'title = "{TITLE}"\n{text}', encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
        assert main(["run", str(here / "Ärmchen.toml"), "--out", str(here / "Fertig é")]) == 0
    return here


USES = {
    "check": ["check", "Ärmchen.toml"],
    "check pump": ["check", "pump"],
    "show": ["show", "Ärmchen.toml", "--out", "Bild é.png"],
    "run": ["run", "Ärmchen.toml", "--out", "Läufe ³"],
    "resume": ["run", "--resume", "Fertig é"],
    "examples": ["examples"],
    "mesh": ["mesh", "Flügel ³.msh"],
    "plot": ["plot", "Fertig é", "--steps", "1", "--out", "Bilder é"],
    "view": ["view", "Fertig é"],
    "export": ["export", "Fertig é", "--out", "Körper é/Körper.stl"],
    "sweep": ["sweep", "Ärmchen.toml", "--set", "shell.thickness=1 mm", "--workers", "1", "--out", "Schar é"],
    "buckling": ["buckling", "Ärmchen.toml", "--modes", "1", "--out", "Beulen é"],
}
ERRORS = {
    "check": ["check", "Käse ³.toml"],
    "run": ["run", "strip-10", "--set", "shell.thickness=1 µé", "--out", "x"],
    "reproduce": ["reproduce", "é"],
    "sweep": ["sweep", "strip-10", "--set", "é=1", "--out", "x"],
    "mesh": ["mesh", "Fl³.msh"],
    "view": ["view", "Käse"],
    "export": ["export", "Käse", "--out", "Körper.obj"],
    "plot": ["plot", "Käse ³"],
    "show": ["show", "Käse.toml"],
    "buckling": ["buckling", "Käse.toml", "--out", "x"],
    "examples": ["examples", "--copy", "Käse"],
}


def said(arguments: list[str], encoding: str, monkeypatch: pytest.MonkeyPatch) -> tuple[int, str]:
    """Exit status, and all that a terminal with this code page gets."""
    terminals = [io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2)]
    for name, terminal in zip(("stdout", "stderr"), terminals, strict=True):
        monkeypatch.setattr(sys, name, terminal)
    try:
        status = main(arguments)
    except SystemExit as ended:
        status = int(ended.code or 0)
    for terminal in terminals:
        terminal.flush()
    return status, "".join(terminal.buffer.getvalue().decode(encoding) for terminal in terminals)  # type: ignore[attr-defined]


def test_every_command_is_here() -> None:
    assert {use[0] for use in (*USES.values(), ["reproduce"])} == set(COMMANDS)
    assert {use[0] for use in ERRORS.values()} == set(COMMANDS)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_help(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for arguments in [["--help"], *HELP]:
        status, text = said(arguments, encoding, monkeypatch)
        assert status == 0
        assert "examples:" in text


SOLVING = {"run", "sweep", "buckling", "plot", "show", "view", "export"}
MEETINGS = [
    pytest.param(use, encoding, marks=pytest.mark.verify if use in SOLVING and encoding != "ascii" else ())
    for use in USES
    for encoding in (["ascii", "cp932"] if use in SOLVING else ENCODINGS)
]
"""Those that solve or draw meet the second code page in `make verify`."""


@pytest.mark.parametrize(("use", "encoding"), MEETINGS)
def test_every_command(use: str, encoding: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setattr("magshell.output.pictures.draw_pictures", lambda path, directory: [])
    status, text = said(USES[use], encoding, monkeypatch)
    assert status == 0, text
    assert "bug in magshell" not in text
    if use == "check":
        assert ("Lamé" if encoding not in ("ascii", "cp932", "cp1251") else "Lame") + " constant lambda" in text
        assert ("10³ |B|" in text) == (encoding == "utf-8")
        assert (TITLE in text) == (encoding == "utf-8")
    if use == "check" and encoding == "ascii":
        assert "Armchen No 3 u u ^3 ? 10^2 ?? ?" in text
        assert "10^3 |B| |Brem| / (mu mu0)" in text
        assert "Spitze" in text


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("use", ERRORS)
def test_every_error(use: str, encoding: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    status, text = said(ERRORS[use], encoding, monkeypatch)
    assert status == 2, text
    assert "error: " in text
    assert "Traceback" not in text


C = {"LANG": "C", "LC_ALL": "C"}
IN_A_PROCESS = [
    ({"PYTHONIOENCODING": "ascii"}, ["check", "Ärmchen.toml"], 0),
    (C, ["check", "Ärmchen.toml"], 0),
    (C | {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, ["check", "pump"], 0),
    (C | {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, ["run", "--help"], 0),
    ({"PYTHONIOENCODING": "utf-8"}, ["check", b"\xe9.toml"], 2),
]


@pytest.mark.skipif(sys.platform != "linux", reason="code pages are set otherwise")
@pytest.mark.parametrize(("environment", "arguments", "status"), IN_A_PROCESS)
def test_in_a_process(environment: dict[str, str], arguments: list[str], status: int, folder: Path) -> None:
    """As the system sets it; also with a name that is no text in any code page."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("LC_", "LANG", "PYTHONUTF8"))}
    line = [sys.executable, "-m", "magshell", *arguments]
    done = subprocess.run(line, cwd=folder, env=clean | environment, capture_output=True, check=False)
    assert done.returncode == status, done.stderr
    assert b"Traceback" not in done.stderr
    assert b"codec" not in done.stderr


@given(st.text())
def test_any_text_can_be_shown(text: str) -> None:
    write_readably()
    shown = text.encode("ascii", NAME)
    assert shown.isascii()
    assert "".join(letter if letter.isascii() else readable(letter) for letter in text).encode() == shown
