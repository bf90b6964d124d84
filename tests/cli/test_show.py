"""`magshell show`: the file it writes, and what it says where it cannot."""

from __future__ import annotations

from pathlib import Path

import pytest
from problem.magnetised import TEMPLATES

from magshell import cli
from magshell.output import rendering, setup
from magshell.problem import examples


@pytest.fixture
def can_draw() -> None:
    """Skip the test, saying why, where nothing three-dimensional can be drawn."""
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, str, bool]]:
    """What would be drawn: file, title, whether the template."""
    calls: list[tuple[str, str, bool]] = []

    def draw(model: object, file: Path, title: str, template: bool) -> None:
        calls.append((str(file), title, template))

    monkeypatch.setattr(setup, "draw_setup", draw)
    return calls


def test_settings(drawn: list[tuple[str, str, bool]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["show", "strip-10", "--set", "shell.thickness=0.5 mm"]) == 0
    assert drawn[0][1].endswith("(shell.thickness = 0.5 mm)")


def test_names_of_pictures(
    drawn: list[tuple[str, str, bool]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mein Blatt.toml").write_text(examples.text("strip-10"))
    for arguments in (["strip-10"], ["mein Blatt.toml"], ["pump", "--out", "a.png"], ["pump", "--template"]):
        assert cli.main(["show", *arguments]) == 0
    files = ["strip-10-show.png", "mein Blatt-show.png", "a.png", "pump-template.png"]
    assert [file for file, *_ in drawn] == files
    assert [template for *_, template in drawn] == [False, False, False, True]
    assert capsys.readouterr().out.splitlines() == [f"picture: {file}" for file in files]


def test_picture_is_written(
    can_draw: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.toml").write_text(TEMPLATES)
    assert cli.main(["show", "part.toml", "--template"]) == 0
    assert (tmp_path / "part-template.png").read_bytes().startswith(b"\x89PNG")
    assert cli.main(["show", "strip-10", "--template"]) == 2
    assert "no part of it has a template" in capsys.readouterr().err
    assert sorted(file.name for file in tmp_path.iterdir()) == ["part-template.png", "part.toml"]


def test_without_a_way_to_draw(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(rendering, "_trial_failure", lambda: "it died of signal 11")
    assert cli.main(["show", "strip-10"]) == 1
    error = capsys.readouterr().err
    for package in ("libegl1", "libgl1-mesa-dri", "libosmesa6"):
        assert package in error
    assert list(tmp_path.iterdir()) == []


def test_a_picture_where_none_can_be(
    drawn: list[tuple[str, str, bool]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").touch()
    (tmp_path / "folder.png").mkdir()
    for out, words in (
        ("taken/a.png", "is a file, or lies below one"),
        ("a.jpg", "name a picture that ends in .png"),
        ("folder.png", "name a picture that ends in .png"),
    ):
        assert cli.main(["show", "strip-10", "--out", f"{tmp_path}/{out}"]) == 2
        assert words in capsys.readouterr().err
    assert drawn == []
