"""Where compiled kernels are kept: a folder per version of the sources and per law, or a temporary one."""

from __future__ import annotations

import importlib.util
import shutil
import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from battery import MATERIAL

import magshell
from magshell import compiled
from magshell.materials import MicropolarMooneyRivlin


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A copy of the package's sources, with a cache of its own."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    folder = tmp_path / "magshell"
    shutil.copytree(Path(magshell.__file__).parent, folder, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def cache_of(package):
    """The cache folder that a process with this copy of the package would use."""
    spec = importlib.util.spec_from_file_location("copy_of_compiled", package / "compiled.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.cache_directory()


def test_the_folder_is_in_the_users_cache(package, tmp_path):
    folder = cache_of(package)
    assert folder.is_dir()
    assert folder.parent == tmp_path / "cache" / "magshell"
    assert cache_of(package) == folder


@pytest.mark.parametrize(
    "source", ["shell/section.py", "materials/tensors.py", "magnetics/micropolar_couple.py", "compiled.py"]
)
def test_another_version_of_a_kernels_source_has_another_folder(package, source):
    """Numba would not notice: it looks at the file of the outermost function only."""
    before = cache_of(package)
    with (package / source).open("a") as file:
        file.write("\n# edited\n")
    assert cache_of(package) != before


def test_a_new_kernel_source_has_another_folder(package):
    before = cache_of(package)
    (package / "materials" / "ogden.py").write_text('"""A new law."""\n')
    assert cache_of(package) != before


@pytest.mark.parametrize("source", ["cli.py", "solver/newton.py", "output/vtu.py"])
def test_other_sources_do_not_matter(package, source):
    before = cache_of(package)
    with (package / source).open("a") as file:
        file.write("\n# edited\n")
    assert cache_of(package) == before


def test_numbas_own_setting_is_obeyed(package, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "elsewhere"))
    assert cache_of(package).parent == tmp_path / "elsewhere"


def test_without_a_writable_cache_the_temporary_folder_is_used(package, tmp_path, monkeypatch):
    """A file in the place of the cache's parent: not even the superuser can make a folder there."""
    (tmp_path / "cache").write_text("in the way")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    folder = cache_of(package)
    assert folder.is_dir()
    assert (tmp_path / "temporary") in folder.parents


class FromThePrompt(NamedTuple):
    """A law whose class belongs to no file."""

    shear_modulus: float = 1.0


def test_kernels_know_whether_they_are_compiled(monkeypatch, tmp_path):
    """For each combination of laws by itself."""
    monkeypatch.setattr(compiled, "cache_directory", lambda: tmp_path)
    kernel = compiled.Kernel(twice)
    assert not kernel.is_compiled(MATERIAL)
    assert kernel(MATERIAL(1.0, 2.0, 3.0, 4.0), np.ones(3)).tolist() == [2.0, 2.0, 2.0]
    assert kernel.is_compiled(MATERIAL)
    assert not kernel.is_compiled(MicropolarMooneyRivlin)


@pytest.mark.skipif(importlib.util.find_spec("fcntl") is None, reason="no locks of files")
def test_of_processes_that_need_the_same_kernel_one_compiles(monkeypatch, tmp_path):
    """The other waits, and reads the cache."""
    monkeypatch.setattr(compiled, "cache_directory", lambda: tmp_path)
    first, second = compiled.Kernel(twice), compiled.Kernel(twice)
    arguments = MATERIAL(1.0, 2.0, 3.0, 4.0), np.ones(3)
    with first._one_process((MATERIAL,)):
        other = threading.Thread(target=second, args=arguments)
        other.start()
        first._compiled[MATERIAL,] = first._compile((MATERIAL,))
        time.sleep(0.2)
        assert other.is_alive()
        assert not first.is_compiled(MATERIAL)
        first(*arguments)
    other.join()
    assert [sum(kernel._compiled[MATERIAL,].stats.cache_hits.values()) for kernel in (first, second)] == [0, 1]


def twice(material, values):
    return 2.0 * material.shear_modulus * values


def test_a_law_without_a_source_file_is_compiled_without_a_cache(monkeypatch, tmp_path):
    monkeypatch.setattr(compiled, "cache_directory", lambda: tmp_path)
    monkeypatch.setattr(FromThePrompt, "__module__", "__main__")
    monkeypatch.setattr("inspect.getfile", lambda law: (_ for _ in ()).throw(OSError("source code not available")))
    kernel = compiled.Kernel(twice)
    assert kernel(FromThePrompt(2.0), np.ones(2)).tolist() == [4.0, 4.0]
    assert not kernel.is_compiled(FromThePrompt)
    assert not any(tmp_path.iterdir())
