"""`--set KEY=VALUES`: what values are read, what they change in a file, what is said of those that make no sense."""

from __future__ import annotations

import tomllib
import typing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from problem_files import LOADED, STRIP, changed

from magshell.errors import InputError
from magshell.problem import examples, load, schema
from magshell.problem.alternatives import MOST_VALUES, read_changes, read_setting, read_settings, value_of
from magshell.problem.building import Problem, build
from magshell.problem.changes import changed as with_values
from magshell.problem.changes import put, vectors
from magshell.problem.fields import (
    AccelerationVector,
    FluxVector,
    ForceVector,
    MagneticMoment,
    MomentVector,
    NodalValue,
    RemanenceVector,
    StressVector,
)
from magshell.problem.reading import Source, check, find, parse

SOURCE = Source("strip.toml", STRIP, Path())


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("0 mT:50 mT:3", ["0 mT", "25 mT", "50 mT"]),
        ("0:50 mT:3", ["0 mT", "25 mT", "50 mT"]),
        ("50 mT:0.01 T:5", ["50 mT", "40 mT", "30 mT", "20 mT", "10 mT"]),
        ("0.1 mm:0.3 mm:3", ["0.1 mm", "0.2 mm", "0.3 mm"]),
        ("-1 mm:1 mm:4", ["-1 mm", "-0.333333333333333 mm", "0.333333333333333 mm", "1 mm"]),
        ("1:3:3", [1, 2, 3]),
        ("0:1:3", [0.0, 0.5, 1.0]),
        ("0.4,0.8 mm", ["0.4 mm", "0.8 mm"]),
        ("0.4 mm, 0.8", ["0.4 mm", "0.8 mm"]),
        ("400,500 um,1 mm", ["400 um", "500 um", "1 mm"]),
        ("1:2:2, 5 mm", ["1 mm", "2 mm", "5 mm"]),
        ("1/m,2 1/m", ["1 /m", "2 1/m"]),
        ("1 N mm", ["1 N mm"]),
        ("3", [3]),
        ("1e-8, .5", [1e-8, 0.5]),
        ("true,false", [True, False]),
        ("paper, quadratic", ["paper", "quadratic"]),
        ('[0, 0, "5 mT"], [0, "5 mT", 0]', [[0, 0, "5 mT"], [0, "5 mT", 0]]),
        ("[10, 2]", [[10, 2]]),
        ('"a,b", "c:d"', ["a,b", "c:d"]),
    ],
)
def test_values(text: str, data: list[Any]) -> None:
    found = [value.data for value in read_setting(f"some.key = {text}").values]
    assert found == data
    assert list(map(type, found)) == list(map(type, data))


@pytest.mark.parametrize(
    ("text", "number", "unit"), [("5 mT", 5e-3, "T"), ("90 deg", 1.5707963267948966, "rad"), ("2 /mm", 2e3, "1/m")]
)
def test_numbers_are_si(text: str, number: float, unit: str) -> None:
    value = value_of(text)
    assert value.number == number
    assert next(iter(value.dimension.units)) == unit


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("thickness", "--set thickness: write KEY=VALUES"),
        ("=3", "write KEY=VALUES"),
        ("a=", "write KEY=VALUES"),
        ("a=1,,2", "empty value"),
        ("a=1:2", "first:last:count"),
        ("a=x:2:3", "first:last:count"),
        ("a=1:2:1", "asks for '1' values"),
        ("a=1:2:2.5", "asks for '2.5' values"),
        (f"a=1:2:{MOST_VALUES + 1}", f"2 to {MOST_VALUES}"),
        ("a=1 mm:2 kPa:3", "from 'mm' to 'kPa'"),
        ("a=0.4,0.4 mm", "'0.4 mm' is listed twice"),
        ("a=1:1:3", "twice"),
        ("a=[1, 2", "not a list of values as TOML writes them"),
        ("a=1e999 mm", "--set a: '1e999 mm' is not"),
        ("a=1e999:2e999:3", "--set a: "),
        (f"a={'[' * 5000}", "not a list of values"),
    ],
)
def test_values_that_make_no_sense(text: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        read_setting(text)
    assert words in str(error.value)
    assert str(error.value).startswith("--set")
    assert len(str(error.value)) < 200


def test_all_faults_are_listed() -> None:
    with pytest.raises(InputError) as error:
        read_settings(["a=1", "b", "a=2", "c=1:2"])
    assert [line.split(":")[0] for line in str(error.value).splitlines()] == ["--set b", "--set a", "--set c"]


def load_text(text: str) -> Problem:
    return build(check(parse(text, "text.toml"), "text.toml"), "text.toml")


def set_in(source: Source, **changes: Any) -> dict[str, Any]:
    values = {key.replace("__", "."): value_of(data) for key, data in changes.items()}
    return tomllib.loads(with_values(source, values).text)


def test_a_magnitude_keeps_the_direction() -> None:
    assert set_in(SOURCE, field__flux_density="-7 mT")["field"]["flux_density"] == [0, 0, "-7 mT"]
    assert set_in(SOURCE, field__flux_density="0 mT")["field"]["flux_density"] == [0, 0, 0]
    assert set_in(SOURCE, field__flux_density=[1, 2, 3])["field"]["flux_density"] == [1, 2, 3]
    oblique = SOURCE._replace(text=changed(STRIP, ('[0, 0, "2 mT"]', '["3 mT", 0, "-0.4 G"]')))
    found = check(set_in(oblique, field__flux_density="10 mT"), "oblique.toml").field.flux_density
    length = (3e-3**2 + 0.04e-3**2) ** 0.5
    assert found == pytest.approx((3e-5 / length, 0.0, -0.04e-5 / length), rel=1e-14)


def test_a_magnitude_and_a_direction() -> None:
    """A field or remanence is changed under either name, whichever the file has."""
    polar = SOURCE._replace(
        text=changed(
            STRIP,
            ('flux_density = [0, 0, "2 mT"]', 'magnitude = "2 mT"\ndirection = [3, 0, 4]'),
            ('vector = ["143 mT", 0, 0]', 'magnitude = "143 mT"\ndirection = [1, 0, 0]'),
        )
    )
    for key in ("field.magnitude", "field.flux_density"):
        text = with_values(polar, {key: value_of("1 mT")}).text
        file = check(parse(text, "polar.toml"), "polar.toml")
        assert file.field.vector == pytest.approx((0.6e-3, 0.0, 0.8e-3), rel=1e-15)
        assert file.field.stops == (1e-3,)
    assert set_in(SOURCE, field__magnitude="7 mT")["field"]["flux_density"] == [0, 0, "7 mT"]
    for source in (SOURCE, polar):
        for key in ("remanence[0].magnitude", "remanence[0].vector"):
            text = with_values(source, {key: value_of("50 mT")}).text
            vectors_of = load_text(text).model.shell.remanence_at_points
            assert np.abs(vectors_of - [50e-3, 0, 0]).max() < 1e-15


def test_a_magnitude_of_a_load() -> None:
    source = SOURCE._replace(text=LOADED)
    values = {"loads[0].total": value_of("1 N"), "loads[1].total": value_of("2 N mm")}
    file = check(parse(with_values(source, values).text, "loaded.toml"), "loaded.toml")
    assert [load.total for load in file.loads] == [(0.0, 0.0, 1.0), (0.0, 2e-3, 0.0)]


def test_every_vector_with_a_unit_takes_a_magnitude() -> None:
    kinds = {FluxVector, RemanenceVector, ForceVector, MomentVector, StressVector, AccelerationVector, NodalValue}
    kinds |= {MagneticMoment}
    tables = [getattr(schema, name) for name in schema.__all__]
    for described in (schema.load_tables, schema.remanence_tables, schema.support_tables):
        tables += described().values()
    tables = [table for table in tables if hasattr(table, "__annotations__") and hasattr(table, "model_fields")]
    found = {
        key
        for table in tables
        for key, kind in typing.get_type_hints(table, include_extras=True).items()
        if kind in kinds or any(part in kinds for part in typing.get_args(kind))
    }
    assert found == vectors()


def test_stops_beyond_the_end_are_left_out() -> None:
    assert set_in(SOURCE, field__flux_density="1.5 mT")["field"]["stops"] == ["1 mT"]
    assert set_in(SOURCE, field__flux_density="-1 mT")["field"]["stops"] == ["1 mT"]
    assert set_in(SOURCE, field__flux_density="50 mT")["field"]["stops"] == ["1 mT", "2 mT"]
    assert set_in(SOURCE, shell__thickness="2 mm")["field"]["stops"] == ["1 mT", "2 mT"]
    assert set_in(SOURCE, field__flux_density="1 mT", field__stops=["3 mT"])["field"]["stops"] == ["3 mT"]


def test_the_title_says_what_was_changed() -> None:
    titled = SOURCE._replace(text=f'title = "An arm"\n{STRIP}')
    assert set_in(titled, shell__thickness="2 mm")["title"] == "An arm (shell.thickness = 2 mm)"
    assert set_in(SOURCE, shell__thickness="2 mm")["title"] == "(shell.thickness = 2 mm)"
    assert set_in(SOURCE, title="Mine")["title"] == "Mine"
    assert with_values(SOURCE, {}) == SOURCE


@pytest.mark.parametrize("name", examples.names())
def test_nothing_else_changes(name: str) -> None:
    """The rewritten text means what the same change to the data means, and keeps its comments."""
    source = find(name)
    for key, data in (
        ("shell.thickness", "0.25 mm"),
        ("solver.tolerance", 1e-8),
        ("supports[0].group", "x y"),
        ("stages", [{"control": "load"}]),
        ("probes.new", [0, 0, "1 mm"]),
        ("mesh.edge_groups.of.mine", {"x1": 0}),
        ("material.law", 'é"\\'),
    ):
        wanted = tomllib.loads(source.text)
        put(wanted, key, value_of(data))
        text = with_values(source, {key: value_of(data)}).text
        found = tomllib.loads(text)
        assert found.pop("title").startswith(wanted.pop("title"))
        assert found == wanted, key
        assert key == "stages" or text.count("#") == source.text.count("#"), "a comment is lost"


@pytest.mark.parametrize(
    ("key", "data", "words"),
    [
        ("shell.thicknes", "1 mm", "strip.toml: shell.thicknes: is an unknown key. Did you mean 'thickness'"),
        ("shel.thickness", "1 mm", "strip.toml: shel: is an unknown key. Did you mean 'shell'"),
        ("remanence[1].vector", "1 mT", "strip.toml: remanence[1].vector: there is no entry [1]"),
        ("loads[0].total", "1 N", "strip.toml: loads[0].total: the file has no list 'loads'"),
        ("shell[0]", 1, "strip.toml: shell[0]: there is no entry [0]: what it names is not a list"),
        ("shell.thickness.mm", 1, "strip.toml: shell.thickness.mm: there is no 'mm'"),
        ("shell..thickness", 1, "strip.toml: shell..thickness: is not a key"),
        ("[0]", 1, "strip.toml: [0]: is not a key"),
        ("shell.thickness", "1 kPa", "strip.toml: shell.thickness: '1 kPa' is a stress where a length"),
        ("shell.element", "papr", "strip.toml: shell.element: 'papr' is not one of"),
        ("field.flux_density", "5 mm", "strip.toml: field.flux_density[2]: '5 mm' is a length"),
        ("field.flux_density", 5, "has no unit where a magnetic flux density"),
    ],
)
def test_keys_that_do_not_exist_and_values_of_another_kind(key: str, data: Any, words: str) -> None:
    with pytest.raises(InputError) as error:
        check(parse(with_values(SOURCE, {key: value_of(data)}).text, "strip.toml"), "strip.toml")
    assert words in str(error.value)


def test_a_vector_without_direction() -> None:
    source = SOURCE._replace(text=changed(STRIP, ('[0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]', "[0, 0, 0]")))
    with pytest.raises(InputError, match=r"strip.toml: field.flux_density: is the zero vector, .* give a vector"):
        with_values(source, {"field.flux_density": value_of("5 mT")})


def test_a_name_with_dots() -> None:
    source = SOURCE._replace(text=changed(STRIP, ("far = {", '"far.away" = {')))
    found = tomllib.loads(with_values(source, {"mesh.edge_groups.far.away.x1": value_of("1 mm")}).text)
    assert found["mesh"]["edge_groups"] == {"far.away": {"x1": "1 mm"}}


def test_a_problem_is_loaded_with_changes() -> None:
    changes = read_changes(["shell.thickness=0.5 mm", "field.flux_density=-5 mT", "mesh.elements=[4, 1]"])
    problem = load("strip-10", changes)
    assert problem.model.shell.thickness == 0.5e-3
    assert problem.model.field.vector.tolist() == [0.0, 0.0, -5e-3]
    assert len(problem.model.shell.mesh.elements) == 4
    assert "-5 mT" in problem.text
    with pytest.raises(InputError, match=r"--set shell.thickness: has 2 values \(1 mm, 2 mm, …\); a run takes one"):
        read_changes(["shell.thickness=1,2 mm"])
