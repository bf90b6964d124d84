"""Compiled kernels and where they are kept: a folder per version of the sources and per law."""

from __future__ import annotations

import errno
import importlib.util
import inspect
import logging
import pathlib
import shutil
import subprocess
import sys
import threading
import time
from typing import NamedTuple

import numpy as np
import pytest
from battery import MATERIAL

import magshell
from magshell import compiled, kernel_cache
from magshell.kernel_cache import digest, sources
from magshell.materials import MicropolarMooneyRivlin
from magshell.shell import loops

RUBBER = MATERIAL(1.0, 2.0, 3.0, 4.0)


def twice(material, values):
    return 2.0 * material.shear_modulus * values


def thrice(material, values):
    return 3.0 * material.shear_modulus * values


@pytest.fixture
def cache(tmp_path, monkeypatch, caplog):
    """An empty cache, and a process that has said nothing yet."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    kernel_cache._warn_once.cache_clear()
    caplog.set_level(logging.INFO, "magshell.kernels")
    yield tmp_path / "cache"
    assert not list((tmp_path / "temporary").iterdir()), "something is left in the temporary folder"


def use(function=twice):
    """Call a kernel that this process has not used yet; whether it came from the cache."""
    kernel = compiled.Kernel(function)
    factor = 2.0 if function is twice else 3.0
    assert kernel(RUBBER, np.ones(3)).tolist() == [factor] * 3
    return sum(kernel._compiled[MATERIAL,].stats.cache_hits.values()) == 1


def files(cache):
    return sorted(cache.rglob("*.kernel"))


# -- the sources -----------------------------------------------------------------------------------------------------


def digest_of_copy(folder):
    """Digest of the kernels' sources in a process that has this copy of the package."""
    script = (
        "from magshell import kernel_cache as k; print(k.digest(k.pathlib.Path(k.__file__).parent/'shell/loops.py'))"
    )
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, env={"PYTHONPATH": str(folder)}, cwd=folder, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    """A copy of the package, and its digest."""
    folder = tmp_path_factory.mktemp("copied")
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(pathlib.Path(magshell.__file__).parent, folder / "magshell", ignore=ignored)
    return folder, digest_of_copy(folder)


@pytest.mark.parametrize(
    ("source", "matters"),
    [
        ("shell/unknowns.py", True),
        ("shell/section.py", True),
        ("shell/elements/definition.py", True),
        ("materials/tensors.py", True),
        ("compiled.py", True),
        ("solver/newton.py", False),
        ("output/vtu.py", False),
        ("materials/mooney_rivlin.py", False),
    ],
)
def test_an_edit_of_what_kernels_are_made_of_changes_the_digest(copied, source, matters):
    """A law has a digest of its own."""
    folder, before = copied
    content = (folder / "magshell" / source).read_text()
    (folder / "magshell" / source).write_text(content + "\n# edited\n")
    after = digest_of_copy(folder)
    (folder / "magshell" / source).write_text(content)
    assert (after != before) is matters


def test_no_source_of_the_kernels_is_missed():
    """Every function, class and module that a source of the kernels knows by name stands in one of them."""
    found = sources(pathlib.Path(loops.__file__))
    package = pathlib.Path(magshell.__file__).parent
    for module in [m for m in list(sys.modules.values()) if pathlib.Path(getattr(m, "__file__", None) or "") in found]:
        for name, value in vars(module).items():
            value = getattr(value, "py_func", value)
            try:
                file = pathlib.Path(inspect.getfile(value))
            except (TypeError, OSError):
                continue
            if package in file.parents:
                assert file in found, f"{module.__name__}.{name}"


def test_imports_are_followed_as_python_follows_them(tmp_path, monkeypatch):
    """Folders, relative imports, modules in packages, imports of imports; not what is installed."""
    contents = {
        "laws/__init__.py": "from laws.unused import nothing\n",
        "laws/unused.py": "nothing = 0\n",
        "laws/ogden.py": "import numpy\nfrom . import powers\nfrom .deep.roots import root\nimport beside, absent\n",
        "laws/powers.py": "",
        "laws/deep/__init__.py": "",
        "laws/deep/roots.py": "from laws.deep import constants\n",
        "laws/deep/constants.py": "def late():\n    import lately\n",
        "beside.py": "from laws import powers, ogden\nif TYPE_CHECKING:\n    import typed\nelse:\n    import untyped\n",
        "typed.py": "",
        "untyped.py": "",
        "lately.py": "",
    }
    for name, content in contents.items():
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(content)
    monkeypatch.syspath_prepend(tmp_path)
    expected = {"laws/ogden.py", "laws/powers.py", "laws/deep/roots.py", "laws/deep/constants.py", "beside.py"}
    found = {str(file.relative_to(tmp_path)) for file in sources(tmp_path / "laws" / "ogden.py")}
    assert found == expected | {"lately.py", "untyped.py"}


def test_what_a_law_is_made_of_enters_its_digest(cache, tmp_path, monkeypatch):
    """The file of its class and those of its functions, with what they import."""
    law = "from typing import NamedTuple\nclass Law(NamedTuple):\n    shear_modulus: float = 1.0\n"
    contents = {
        "a_law.py": law,
        "its_function.py": "import its_helper\ndef stress(material, U, P, C):\n    pass\n",
        "its_helper.py": "",
    }
    for name, content in contents.items():
        (tmp_path / name).write_text(content)
    monkeypatch.syspath_prepend(tmp_path)
    law = importlib.import_module("a_law").Law
    monkeypatch.setitem(compiled._chosen[0], law, importlib.import_module("its_function").stress)
    folders = set()
    for edited in (None, *contents):
        if edited:
            (tmp_path / edited).write_text(f"{contents[edited]}\n# edited\n")
        digest.cache_clear()
        folders.add(compiled.Kernel(twice)._store((law,)).folder)
    assert len(folders) == 4


# -- the cache -------------------------------------------------------------------------------------------------------


def test_it_is_the_users(monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    assert compiled.user_cache() == tmp_path / "magshell"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "elsewhere"))
    assert compiled.user_cache() == tmp_path / "elsewhere"


def test_what_is_compiled_is_read_the_next_time(cache, caplog):
    """For each combination of laws by itself; whatever is compiled is told."""
    kernel = compiled.Kernel(twice)
    assert not kernel.is_compiled(MATERIAL)
    assert not use()
    assert caplog.messages == ["compiling the kernel twice for MicropolarNeoHookean (up to a minute) ..."]
    assert kernel.is_compiled(MATERIAL)
    assert not kernel.is_compiled(MicropolarMooneyRivlin)
    assert use()
    assert len(caplog.messages) == 1
    assert not use(thrice), "of a half-filled cache the rest is compiled"
    assert "compiling the kernel thrice" in caplog.messages[1]


@pytest.mark.parametrize("place", [0, 10, 40, 2000, -1])
@pytest.mark.parametrize("damage", ["cut", "changed"])
def test_a_damaged_file_is_replaced(cache, caplog, damage, place):
    use()
    (file,) = files(cache)
    content = bytearray(file.read_bytes())
    if damage == "cut":
        file.write_bytes(content[:place])
    else:
        content[place] ^= 0x10
        file.write_bytes(content)
    caplog.clear()
    assert not use()
    assert len(caplog.messages) == 2
    assert "damaged" in caplog.messages[0]
    assert str(file.parents[1]) in caplog.messages[0]
    assert caplog.records[0].levelname == "WARNING"
    assert use()


def test_of_a_cache_full_of_damaged_files_one_warning_is_enough(cache, caplog):
    use()
    use(thrice)
    for file in files(cache):
        file.write_bytes(b"")
    caplog.clear()
    use()
    use(thrice)
    assert [record.levelname for record in caplog.records].count("WARNING") == 1


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EROFS, errno.EACCES])
def test_a_cache_that_cannot_be_written_is_read(cache, caplog, monkeypatch, error):
    """A full disk, an image of a container: the rest is compiled in memory, and the folder is named once."""
    use()
    before = {file: file.read_bytes() for file in cache.rglob("*") if file.is_file()}

    def refuse(path, content, durably=False):
        raise OSError(error, "refused", str(path))

    monkeypatch.setattr(kernel_cache, "write_atomically", refuse)
    caplog.clear()
    assert use()
    assert not caplog.messages
    assert not use(thrice)
    assert not use(thrice)
    warnings = [record.message for record in caplog.records if record.levelname == "WARNING"]
    root = files(cache)[0].parents[1]
    assert warnings == [f"{root}: compiled kernels cannot be kept there (refused); they are compiled anew in each run"]
    after = {file: file.read_bytes() for file in cache.rglob("*") if file.is_file()}
    assert {file: content for file, content in after.items() if file.suffix != ".lock"} == {
        file: content for file, content in before.items() if file.suffix != ".lock"
    }


def test_a_cache_that_cannot_be_made(cache, caplog):
    """A file in its place: not even the superuser can make a folder there."""
    cache.write_text("in the way")
    assert not use()
    (warning,) = [record.message for record in caplog.records if record.levelname == "WARNING"]
    assert str(cache) in warning


def test_a_user_without_a_home(cache, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(pathlib.Path, "home", lambda: (_ for _ in ()).throw(RuntimeError("no home")))
    assert not use()
    assert not compiled.Kernel(twice).is_compiled(MATERIAL)


@pytest.mark.skipif(importlib.util.find_spec("fcntl") is None, reason="no locks of files")
def test_of_processes_that_need_the_same_kernel_one_compiles(cache, caplog):
    """The other waits, says so, and reads the cache."""
    first, second = compiled.Kernel(twice), compiled.Kernel(twice)
    with first._one_process((MATERIAL,)):
        other = threading.Thread(target=second, args=(RUBBER, np.ones(3)))
        other.start()
        first._compiled[MATERIAL,] = first._compile((MATERIAL,))
        time.sleep(0.2)
        assert other.is_alive()
        assert caplog.messages == ["waiting for another process that compiles the kernel twice ..."]
        assert not first.is_compiled(MATERIAL)
        first(RUBBER, np.ones(3))
    other.join()
    assert [sum(kernel._compiled[MATERIAL,].stats.cache_hits.values()) for kernel in (first, second)] == [0, 1]


class FromThePrompt(NamedTuple):
    """A law whose class may belong to no file."""

    shear_modulus: float = 1.0


def test_a_law_without_a_source_file_is_compiled_without_a_cache(cache, monkeypatch):
    monkeypatch.setattr(FromThePrompt, "__module__", "__main__")
    monkeypatch.setattr("inspect.getfile", lambda law: (_ for _ in ()).throw(OSError("source code not available")))
    kernel = compiled.Kernel(twice)
    assert kernel(FromThePrompt(2.0), np.ones(2)).tolist() == [4.0, 4.0]
    assert not kernel.is_compiled(FromThePrompt)
    assert not cache.exists()
