"""Tables of remanence and displacements damaged at random, and settings of the command line made of random words."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from problem_files import STRIP

import magshell as ms
from faults.damage import damaged
from faults.limits import bounded, located, share
from magshell.errors import InputError
from magshell.problem.alternatives import read_setting
from magshell.problem.reading import Source
from magshell.sweep.grid import grid

PLATE = ms.mesh.rectangle(20e-3, 5e-3, (4, 1))
CENTRES = PLATE.points[PLATE.elements].mean(axis=1)
MEASURED = "# a comment\nx1,x2,x3,b1,b2,b3\n" + "".join(
    f"{1e3 * x:g},{1e3 * y:g},{1e3 * z:g},100,-0.5,{number}e-1\n" for number, (x, y, z) in enumerate(CENTRES)
)
BY_ELEMENT = 'b3,name,b1,b2\n1,"a, b",2,3\n4,é,5,6\n7,,8,9\n10,x,11,12\n'
SPREADSHEET = MEASURED.replace(",", ";").replace(".", ",").replace("x1;x2", "X1 [mm];X2/mm")
DISPLACED = "x1,x2,x3,u1,u2,u3\n" + "".join(f"{x!r},{y!r},{z!r},0,0,{x!r}\n" for x, y, z in PLATE.points.tolist())


def array() -> bytes:
    """A `.npy` file with a vector for each element."""
    content = io.BytesIO()
    np.save(content, np.arange(12.0).reshape(4, 3))
    return content.getvalue()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tables")


def refused_or_vectors(content: bytes, file: Path, length_unit: str = "mm") -> None:
    file.write_bytes(content)
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            remanence = ms.remanence.from_file(file, "mT", length_unit)
        except InputError as error:
            located(error, file.name)
            return
        try:
            vectors = remanence(PLATE, CENTRES[:, None])
        except InputError as error:
            located(error, "remanence")
            return
    assert np.isfinite(vectors).all()


@share(0.05)
@given(content=st.sampled_from([MEASURED.encode(), BY_ELEMENT.encode(), SPREADSHEET.encode()]).flatmap(damaged))
def test_measured(content: bytes, folder: Path) -> None:
    refused_or_vectors(content, folder / "measured.csv")


@share(0.02)
@example(content=array().replace(b"(4, 3), }" + 18 * b" ", b"(9223372036854775808, 3), }"))
@given(content=damaged(array()))
def test_array(content: bytes, folder: Path) -> None:
    refused_or_vectors(content, folder / "measured.npy")


@share(0.03)
@example(content=DISPLACED.replace(",0.005\n", ",1e308\n", 1).encode())
@given(content=damaged(DISPLACED.encode()))
def test_displacements(content: bytes, folder: Path) -> None:
    file = folder / "displaced.csv"
    file.write_bytes(content)
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            template = ms.remanence.displaced_from_file(file, "m")
        except InputError as error:
            located(error, file.name)
            return
        try:
            placed = ms.remanence.template(template, 0.1, (0.0, 0.0, 1.0))(PLATE, CENTRES[:, None])
        except InputError as error:
            located(error, "remanence")
            return
    assert np.isfinite(placed).all()


WORDS = st.one_of(
    st.sampled_from(["0", "1", "-2", "3.5", "1e3", "1e400", "50", "11", "nan", "inf", "true", "false", "paper", "é"]),
    st.sampled_from(
        [" mm", " mT", "mT", " kPa", "/m", " N m", ":", ":", ":", ",", ",", "[", "]", "{", "}", '"', "'", "="]
    ),
    st.text(max_size=3),
)
KEYS = st.one_of(
    st.sampled_from(["shell.thickness", "field.flux_density", "remanence[0].vector", "mesh.elements", "probes.tip"]),
    st.sampled_from(["shell", "field.stops", "solver.tolerance", "mesh.edge_groups.far.x1", "title", "stages[0].name"]),
    st.text(alphabet="shel.[]0 9=", max_size=8),
)


def of_a_setting(text: str) -> None:
    assert text.startswith("--set")
    assert text.isprintable(), repr(text)
    assert len(text) < 300


@share(0.06)
@given(key=KEYS, words=st.lists(WORDS, min_size=1, max_size=8))
def test_settings(key: str, words: list[str]) -> None:
    """A setting is refused with its name, or its cells are refused with theirs, or they are problems."""
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            setting = read_setting(f"{key}={''.join(words)}")
        except InputError as error:
            of_a_setting(str(error))
            return
        try:
            cells = grid(Source("strip.toml", STRIP, Path()), [setting])
        except InputError as error:
            if str(error).startswith("--set"):
                of_a_setting(str(error))
            else:
                located(error, "strip.toml")
            return
    assert len(cells) == len(setting.values)
