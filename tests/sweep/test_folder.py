"""What a folder of a sweep remembers, and which folders are refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from problem_files import changed

from magshell.errors import InputError
from magshell.problem.reading import Source, parse
from magshell.sweep.folder import SweepFolder
from sweep.conftest import SETTINGS, SOURCE


def test_read_back(tmp_path: Path) -> None:
    texts = ['mesh.elements=[10, 2], ["é", "\\"]', "a=1\n2"]
    source = Source('an "odd" näme.toml', SOURCE.text, tmp_path / "with space")
    folder = SweepFolder(tmp_path)
    folder.begin(source, texts)
    assert folder.read() == (source, texts)
    folder.begin(source, texts)


def test_a_sweep_without_cells_is_replaced(folder: SweepFolder) -> None:
    """Left by a command that found no workers."""
    folder.begin(SOURCE, ["shell.thickness=1 mm"])
    assert folder.read()[1] == ["shell.thickness=1 mm"]


def test_another_sweep_is_left_alone(folder: SweepFolder) -> None:
    folder.cells.mkdir()
    with pytest.raises(InputError, match=r'holds another sweep \(--set "shell.thickness=0.8 mm:1.2 mm:3"\)'):
        folder.begin(SOURCE, ["shell.thickness=1 mm"])
    with pytest.raises(InputError, match=r"holds the sweep of another 'strip.toml'"):
        folder.begin(SOURCE._replace(text=SOURCE.text + "# changed"), SETTINGS)


@pytest.mark.parametrize("name", ["summary.json", "problem.toml"])
def test_a_run_is_left_alone(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("of a run")
    with pytest.raises(InputError, match="holds the results of a run; name another folder"):
        SweepFolder(tmp_path).begin(SOURCE, SETTINGS)
    assert [file.name for file in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("version = 2", "version = 3", "sweep.toml: version: is 3; this magshell reads versions 1 and 2"),
        ("version = 2", "", "sweep.toml: version: is None"),
        ("version = 2", "version = ", "sweep.toml: is damaged"),
        ("version = 2", "version = " + 9999 * "[", "sweep.toml: is damaged"),
        ("folder = ", "ordner = ", "sweep.toml: problem and folder"),
        ("set = [", "set = 3\n#", "sweep.toml: "),
        ("set = [", "set = [3,", "sweep.toml: set: is not a list of texts"),
        ("strip", "\x00", "sweep.toml: is damaged"),
    ],
)
def test_a_damaged_definition(old: str, new: str, words: str, folder: SweepFolder) -> None:
    text = folder.definition.read_text()
    assert old in text
    folder.definition.write_text(text.replace(old, new))
    with pytest.raises(InputError) as error:
        folder.read()
    assert words in str(error.value)
    assert str(error.value).startswith(str(folder.path))


def test_an_older_sweep_keeps_the_defaults_of_its_time(folder: SweepFolder) -> None:
    """Those of materials changed with version 2; what the file says, and shells without micro-rotation, have none."""
    former = 'coupling_modulus = "0.1 mu"\nlength_scale = "0.1 h"\n'
    bare = changed(SOURCE.text, (former, ""))
    folder.problem.write_text(bare)
    assert folder.read()[0].text == bare
    folder.definition.write_text(folder.definition.read_text().replace("version = 2", "version = 1"))
    material = parse(folder.read()[0].text, "strip.toml")["material"]
    assert (material["coupling_modulus"], material["length_scale"]) == ("0.1 mu", "0.1 h")
    classical = changed(bare, ('thickness = "1 mm"', 'thickness = "1 mm"\nmicro_rotation = false'))
    for text in (SOURCE.text, classical):
        folder.problem.write_text(text)
        assert folder.read()[0].text == text


def test_no_sweep(tmp_path: Path, folder: SweepFolder) -> None:
    with pytest.raises(InputError, match=r"sweep.toml: there is no such file, so this is no folder of a sweep"):
        SweepFolder(tmp_path).read()
    folder.definition.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"sweep.toml: is damaged"):
        folder.read()
    folder.definition.unlink()
    folder.definition.mkdir()
    with pytest.raises(InputError, match=r"sweep.toml: cannot be read: Is a directory"):
        folder.read()
