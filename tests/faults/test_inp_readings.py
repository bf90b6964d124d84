"""Input files are read as they are meant: against meshes known beforehand, and against a second reader."""

from __future__ import annotations

import random
import warnings
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from faults.damage import damaged
from faults.inp_decks import Writer, decks
from faults.inp_model import Model, assert_same, of_contents
from faults.inp_reference import Unsure, reference
from faults.limits import bounded, located, share
from magshell.errors import InputError
from magshell.mesh.files.inp import read_inp

DATA = Path(__file__).parent.parent / "mesh" / "files" / "data" / "inp"
READ_BY_BOTH = [
    "caps.inp",
    "node_cylindrical.inp",
    "quad_dominant.inp",
    "system_offset.inp",
    "gmsh_q8.inp",
    "gmsh_t6.inp",
]


@share(0.3)
@given(deck=decks())
def test_files_made_at_random(deck: tuple[str, Model]) -> None:
    """Scopes, labels, coordinate systems, generators, moved instances: both readers see the mesh that was meant."""
    text, model = deck
    true = model.described()
    assert_same(of_contents(read_inp(text.encode(), "deck.inp")), true)
    assert_same(reference(text).described(), true)


@share(0.3)
@given(data=st.data(), seed=st.integers(0, 2**32 - 1))
def test_damaged_files_are_refused_or_read_alike(data: st.DataObject, seed: int) -> None:
    """What is damaged may still be a file, but then says the same to both readers."""
    content = data.draw(damaged(Writer(random.Random(seed)).deck()[0].encode()))
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found = read_inp(content, "deck.inp")
        except InputError as error:
            located(error, "deck.inp")
            return
    try:
        true = reference(content.decode("ascii")).described()
    except (Unsure, UnicodeDecodeError, KeyError, ValueError):
        return
    assert_same(of_contents(found), true)


@pytest.mark.parametrize("name", READ_BY_BOTH)
def test_files_of_other_programs(name: str) -> None:
    content = (DATA / name).read_bytes()
    assert_same(of_contents(read_inp(content, name)), reference(content.decode()).described())
