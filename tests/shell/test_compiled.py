"""Compiled kernels and laws, and where they are kept: a folder per version of the sources."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import importlib.util
import inspect
import json
import logging
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time
from dataclasses import replace
from typing import NamedTuple

import numba
import numpy as np
import pytest
from battery import COUPLINGS, MATERIAL, MATERIALS, TYPES, example, free_body, patch
from solver.models import rubber, strip

import magshell as ms
from magshell import compiled, kernel_cache
from magshell.equations import scatter
from magshell.equations.instant import Instant
from magshell.kernel_cache import digest, sources
from magshell.magnetics import law as coupling_laws
from magshell.materials import law as material_laws
from magshell.materials import neo_hookean
from magshell.shell import loops

PACKAGE = pathlib.Path(ms.__file__).parent


def twice(values):
    return 2.0 * values


def thrice(values):
    return 3.0 * values


class Halving(NamedTuple):
    """A law, as far as the cache is concerned."""


def halved(values, factor):
    return 0.5 * values[0] * factor


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


class OfKernel:
    """A kernel that this process has not used yet."""

    def __init__(self, function=twice):
        self.kept, self.function = compiled.Kernel(function), function

    def use(self):
        """Call it; whether it came from the cache."""
        factor = 2.0 if self.function is twice else 3.0
        assert self.kept(np.ones(3)).tolist() == [factor] * 3
        return sum(self.kept._compiled.stats.cache_hits.values()) == 1


class OfLaw:
    """A law that this process has not used yet."""

    def __init__(self):
        self.kept = compiled.Callback(halved, "pd", Halving, (halved,))

    def use(self):
        """Call it by its address; whether it came from the cache."""
        called = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_double)(self.kept.address)
        assert called(np.array([3.0]).ctypes.data, 4.0) == 6.0
        return self.kept._compiled.cache_hits == 1


each_kind = pytest.mark.parametrize(("kind", "name"), [(OfKernel, "the kernel twice"), (OfLaw, "the law Halving")])


def use(function=twice):
    return OfKernel(function).use()


def files(cache):
    return sorted(cache.rglob("*.kernel"))


# -- the sources -----------------------------------------------------------------------------------------------------


EDITS = {
    "shell/point.py": (True, False),
    "shell/section.py": (True, False),
    "shell/elements/definition.py": (True, False),
    "materials/law.py": (False, True),
    "magnetics/law.py": (True, False),
    "compiled.py": (True, True),
    "materials/tensors.py": (True, True),
    "materials/neo_hookean.py": (False, True),
    "materials/mooney_rivlin.py": (False, False),
    "magnetics/micropolar_couple.py": (False, False),
    "equations/scatter.py": (False, False),
    "solver/newton.py": (False, False),
    "output/vtu.py": (False, False),
}
"""Sources, and whether the digests of the kernels and of a law change with them."""
DIGESTS = """
import json, pathlib, sys
from magshell import kernel_cache
package, found = pathlib.Path(kernel_cache.__file__).parent, {}
*sources, edits = json.loads(sys.argv[1])
for edited in ("", *edits):
    for cached in (kernel_cache.digest, kernel_cache._imported, kernel_cache._source_of):
        cached.cache_clear()
    content = edited and (package / edited).read_text()
    if edited:
        (package / edited).write_text(content + "\\n# edited\\n")
    found[edited] = [kernel_cache.digest(package / source) for source in sources]
    if edited:
        (package / edited).write_text(content)
print(json.dumps(found))
"""
KERNELS, LAW = "shell/loops.py", "materials/neo_hookean.py"


@pytest.fixture(scope="module")
def digests(tmp_path_factory):
    """Of the kernels and of a law in a copy of the package, by what is edited there, in a process of its own."""
    folder = tmp_path_factory.mktemp("copied")
    shutil.copytree(PACKAGE, folder / "magshell", ignore=shutil.ignore_patterns("__pycache__"))
    command = [sys.executable, "-c", DIGESTS, json.dumps([KERNELS, LAW, list(EDITS)])]
    done = subprocess.run(command, env={"PYTHONPATH": str(folder)}, cwd=folder, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("source", EDITS)
def test_an_edit_of_what_it_is_made_of_changes_the_digest(digests, source):
    """A law has a digest of its own: neither does an edit of it concern the kernels, nor one of theirs the law."""
    assert tuple(after != before for after, before in zip(digests[source], digests[""], strict=True)) == EDITS[source]


@pytest.mark.parametrize(
    "module",
    [loops, scatter, *(sys.modules[type(law).__module__] for law in (*MATERIALS, *COUPLINGS))],
    ids=lambda module: module.__name__,
)
def test_no_source_is_missed(module):
    """Every function, class and module that a source knows by name stands in one of the sources."""
    found = sources(pathlib.Path(module.__file__))
    for module in [m for m in list(sys.modules.values()) if pathlib.Path(getattr(m, "__file__", None) or "") in found]:
        for name, value in vars(module).items():
            value = getattr(value, "py_func", value)
            try:
                file = pathlib.Path(inspect.getfile(value))
            except (TypeError, OSError):
                continue
            if PACKAGE in file.parents:
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


USERS = {
    "ogden.py": """
from typing import NamedTuple
from its_function import law
from magshell.materials.law import material_law

@material_law(law)
class UsersLaw(NamedTuple):
    shear_modulus: float
    lame_lambda: float
    coupling_modulus: float
    length_scale: float

    @property
    def couple_modulus(self):
        return self.shear_modulus * self.length_scale**2

    def problems(self):
        return []
""",
    "its_function.py": """
from its_helper import neo_hookean

def law(material, U, P, C):
    return neo_hookean(material, U, P, C)
""",
    "its_helper.py": """
import numba
from magshell.materials.neo_hookean import _law

neo_hookean = numba.extending.register_jitable(_law)
""",
}
"""A law in a user's own files: the neo-Hookean one."""


@pytest.fixture
def users(tmp_path, monkeypatch, registry):
    """Class of that law; its files are in `folder`."""
    for name, content in USERS.items():
        (tmp_path / name).write_text(content)
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("ogden").UsersLaw
    for name in USERS:
        sys.modules.pop(name.removesuffix(".py"), None)
    kernel_cache._source_of.cache_clear()
    kernel_cache._imported.cache_clear()


def test_what_a_law_is_made_of_enters_its_digest(cache, tmp_path, users):
    """The file of its class and those of its functions, with what they import."""
    folders = set()
    for edited in (None, *USERS):
        if edited:
            (tmp_path / edited).write_text(f"{USERS[edited]}\n# edited\n")
        digest.cache_clear()
        folders.add(material_laws.callbacks[users]._store().folder)
    assert len(folders) == 4


# -- the cache -------------------------------------------------------------------------------------------------------


def test_it_is_the_users(monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    assert compiled.user_cache() == tmp_path / "magshell"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "elsewhere"))
    assert compiled.user_cache() == tmp_path / "elsewhere"


@each_kind
def test_what_is_compiled_is_read_the_next_time(cache, caplog, kind, name):
    """Whatever is compiled is told."""
    assert not kind().kept.is_compiled()
    assert not kind().use()
    assert caplog.messages == [f"compiling {name} ..."]
    assert kind().kept.is_compiled()
    assert kind().use()
    assert len(caplog.messages) == 1
    assert not use(thrice), "of a half-filled cache the rest is compiled"
    assert caplog.messages[1:] == ["compiling the kernel thrice ..."]


@each_kind
@pytest.mark.parametrize("place", [0, 10, 40, 2000, -1])
@pytest.mark.parametrize("damage", ["cut", "changed"])
def test_a_damaged_file_is_replaced(cache, caplog, damage, place, kind, name):
    kind().use()
    (file,) = files(cache)
    content = bytearray(file.read_bytes())
    if damage == "cut":
        file.write_bytes(content[:place])
    else:
        content[place] ^= 0x10
        file.write_bytes(content)
    caplog.clear()
    assert not kind().use()
    assert len(caplog.messages) == 2
    assert "damaged" in caplog.messages[0]
    assert str(cache) in caplog.messages[0]
    assert caplog.records[0].levelname == "WARNING"
    assert kind().use()


def test_of_a_cache_full_of_damaged_files_one_warning_is_enough(cache, caplog):
    made = [OfKernel, lambda: OfKernel(thrice), OfLaw]
    for kind in made:
        kind().use()
    for file in files(cache):
        file.write_bytes(b"")
    caplog.clear()
    assert not any(kind().use() for kind in made)
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
    for kind in (lambda: OfKernel(thrice), OfLaw):
        assert not kind().use()
        assert not kind().use()
    warnings = [record.message for record in caplog.records if record.levelname == "WARNING"]
    assert warnings == [f"{cache}: compiled kernels cannot be kept there (refused); they are compiled anew in each run"]
    after = {file: file.read_bytes() for file in cache.rglob("*") if file.is_file()}
    assert {file: content for file, content in after.items() if file.suffix != ".lock"} == {
        file: content for file, content in before.items() if file.suffix != ".lock"
    }


@each_kind
def test_a_cache_that_cannot_be_made(cache, caplog, kind, name):
    """A file in its place: not even the superuser can make a folder there."""
    cache.write_text("in the way")
    assert not kind().use()
    (warning,) = [record.message for record in caplog.records if record.levelname == "WARNING"]
    assert str(cache) in warning


@each_kind
def test_a_user_without_a_home(cache, monkeypatch, kind, name):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    for variable in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr(pathlib.Path, "home", lambda: (_ for _ in ()).throw(RuntimeError("no home")))
    assert not kind().use()
    assert not kind().kept.is_compiled()


@pytest.mark.skipif(importlib.util.find_spec("fcntl") is None, reason="no locks of files")
@each_kind
def test_of_processes_that_need_the_same_one_compiles(cache, caplog, monkeypatch, kind, name):
    """The other waits, says so, and reads the cache. Two threads play the processes, which share no lock of threads."""
    monkeypatch.setattr(compiled, "_one_thread", contextlib.nullcontext())
    first, second, hits = kind(), kind(), []
    with first.kept._one_process():
        other = threading.Thread(target=lambda: hits.append(second.use()))
        other.start()
        time.sleep(0.2)
        assert other.is_alive()
        assert caplog.messages == [f"waiting for another process that compiles {name} ..."]
        monkeypatch.setattr(first.kept, "_one_process", contextlib.nullcontext)
        assert not first.use()
    other.join()
    assert hits == [True]


def test_two_processes_that_start_together_compile_once(tmp_path):
    """A kernel and the laws: each process has them right, and each is compiled by one."""
    script = """
import logging, sys
import numpy as np
from magshell.materials import MicropolarNeoHookean
from magshell.materials.law import evaluate
logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
print(float(evaluate(MicropolarNeoHookean(1.0, 1.7, 0.3, 0.2), np.diag([1.1, 1.2, 0.9]))[0]).hex())
"""
    environment = dict(os.environ, NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    command = [sys.executable, "-c", script]
    both = [subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    said = [one.communicate()[0].splitlines() for one in both]
    assert [one.returncode for one in both] == [0, 0]
    assert said[0][-1] == said[1][-1]
    for name in ("the kernel _at_points", "the law MicropolarNeoHookean"):
        assert sum(lines.count(f"compiling {name} ...") for lines in said) == 1, said


# -- laws of users ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def solved():
    """The strip of built-in laws; whatever it needs is compiled and in use from now on."""
    return ms.solve(strip(field=(0.0, 0.0, 5e-3)))


def test_a_law_in_a_users_file_needs_nothing_else_compiled(solved, cache, caplog, users):
    """It is the neo-Hookean one: the same path, bit for bit."""
    before = [len(kernel._compiled.signatures) for kernel in (loops.fill, scatter.add_matrices)]
    path = ms.solve(strip(field=(0.0, 0.0, 5e-3), material=users(*rubber())))
    assert caplog.messages == ["compiling the law UsersLaw ..."]
    assert [file.name.split("-")[0] for file in files(cache)] == ["UsersLaw"]
    assert [len(kernel._compiled.signatures) for kernel in (loops.fill, scatter.add_matrices)] == before
    assert [step.load_factor for step in path.steps] == [step.load_factor for step in solved.steps]
    for step, other in zip(path.steps, solved.steps, strict=True):
        assert np.array_equal(step.state.u, other.state.u)


def test_kernels_are_compiled_once_for_all_elements():
    """Whatever the element type, arrays have the same types; levels that stretch by themselves are a second one."""
    for element in TYPES.values():
        for stretch in ("linear", "none", "plane-stress"):
            d = free_body(patch((2, 2)), element=element, stretch=stretch)
            state = d.undeformed()
            for prediction in (None, d.predicted(Instant(state, d.model.loading(1.0)))):
                d.assemble(Instant(state, d.model.loading(1.0), prediction))
    assert [len(kernel._compiled.signatures) for kernel in (loops.fill, scatter.add_matrices)] == [2, 1]


PROMPT = (
    USERS["its_helper.py"]
    + USERS["its_function.py"].partition("\n\n")[2]
    + USERS["ogden.py"]
    + """
import numpy as np
from magshell.materials.law import callbacks, evaluate
print(float(evaluate(UsersLaw(1.0, 1.7, 0.3, 0.2), np.diag([1.1, 1.2, 0.9]))[0]).hex())
print(callbacks[UsersLaw].is_compiled())
"""
)


def test_a_law_typed_at_a_prompt_is_compiled_without_a_cache(tmp_path):
    """Neither its class nor its function has a source file."""
    script = "\n".join(line for line in PROMPT.splitlines() if not line.startswith(("from its_", "from ogden")))
    environment = dict(os.environ, NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    done = subprocess.run([sys.executable], input=script, env=environment, cwd=tmp_path, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    energy = float(material_laws.evaluate(example(MATERIAL), np.diag([1.1, 1.2, 0.9]))[0])
    assert done.stdout.split() == [energy.hex(), "False"]
    assert not list((tmp_path / "cache").rglob("*UsersLaw*"))


def test_a_law_whose_file_is_gone_is_compiled_without_a_cache(cache, monkeypatch):
    monkeypatch.setattr("inspect.getfile", lambda law: (_ for _ in ()).throw(OSError("source code not available")))
    for kind in (OfKernel, OfLaw):
        assert not kind().use()
        assert not kind().kept.is_compiled()
    assert not cache.exists()


def _refusing(material, U, P, C):
    energy = _neo_hookean(material, U, P, C)
    if U[0, 0] > 1.0 + 1e-5:
        raise ValueError("the law holds for no such stretch")
    return energy


_neo_hookean = numba.extending.register_jitable(neo_hookean._law)


class Refusing(MATERIAL):
    """The neo-Hookean law, which raises an error beyond a small stretch, when all is filled."""


def _losing(coupling, m, n, B, gradients, forces, tangent):
    if n[2] != 0.0:
        raise ValueError("the law holds for no such direction")
    return 0.0


class Losing(NamedTuple):
    """A law without forces, which raises an error where the remanence has turned."""

    vacuum_permeability: float = 4e-7 * np.pi


def test_a_material_law_that_raises_an_error_is_not_solved(solved, cache, registry):
    material_laws.material_law(_refusing)(Refusing)
    with pytest.raises(ms.SolveError, match="the residual is not finite"):
        ms.solve(strip(material=Refusing(*rubber())))


def test_a_coupling_law_that_raises_an_error_is_not_solved(solved, cache, registry):
    """Its forces are zero, before and after: without a word that would be a wrong answer."""
    coupling_laws.coupling_law(_losing, has_energy=True)(Losing)
    energy, forces, _ = coupling_laws.evaluate(
        Losing(), np.ones((2, 3)), np.array([[1.0, 0, 0], [0, 0, 1]]), np.ones(3)
    )
    assert np.isfinite(energy).tolist() == np.isfinite(forces).all(axis=1).tolist() == [True, False]
    model = replace(strip(coupling=Losing()), loads=(ms.Force("right", (0.0, 0.0, 1e-3)),))
    with pytest.raises(ms.SolveError, match="the residual is not finite"):
        ms.solve(model)
