"""Files are whole or absent, and disk errors name the file."""

from __future__ import annotations

import errno

import pytest

from magshell.files import append_line, write_atomically


@pytest.fixture
def small_disk():
    """Files cannot grow beyond 100 bytes: a full disk, without filling one."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_write_makes_the_folder_and_replaces(tmp_path):
    file = tmp_path / "a" / "b.txt"
    write_atomically(file, b"old")
    write_atomically(file, b"new")
    assert file.read_bytes() == b"new"
    assert [item.name for item in file.parent.iterdir()] == ["b.txt"]


def test_full_disk_leaves_the_old_file_and_no_other(tmp_path, small_disk):
    file = tmp_path / "b.txt"
    write_atomically(file, b"old")
    with pytest.raises(OSError, match=r"b\.txt") as caught:
        write_atomically(file, bytes(1000))
    assert caught.value.errno == errno.EFBIG
    assert file.read_bytes() == b"old"
    assert [item.name for item in tmp_path.iterdir()] == ["b.txt"]


def test_line_that_does_not_fit_is_taken_back(tmp_path, small_disk):
    file = tmp_path / "rows.csv"
    append_line(file, "1" * 59 + "\n")
    with pytest.raises(OSError, match=r"rows\.csv") as caught:
        append_line(file, "2" * 59 + "\n")
    assert caught.value.errno == errno.EFBIG
    assert file.read_text() == "1" * 59 + "\n"


def test_folder_that_is_a_file_is_named(tmp_path):
    (tmp_path / "taken").touch()
    with pytest.raises(OSError, match="taken"):
        write_atomically(tmp_path / "taken" / "b.txt", b"")


def test_refused_replacement_names_the_file_not_the_one_beside_it(tmp_path):
    folder = tmp_path / "view.html"
    folder.mkdir()
    with pytest.raises(IsADirectoryError) as caught:
        write_atomically(folder, b"")
    assert (caught.value.filename, caught.value.filename2) == (str(folder), None)
    assert list(tmp_path.iterdir()) == [folder]
