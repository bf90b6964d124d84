"""A problem file damaged at random is refused with its place or still a problem; nothing else happens."""

from __future__ import annotations

import copy
import re
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from problem.loaded import EVERY_LOAD
from problem.magnetised import FIELDS, SURFACES, TEMPLATES
from problem.test_staged_problems import STAGED
from problem.with_sources import EVERY_FIELD, EVERY_SOURCE, write_field_files
from problem_files import JOINTED, LOADED, MIURA, PROFILE, STRIP, with_mesh

import magshell as ms
from faults.limits import bounded, located, share
from magshell.errors import InputError
from magshell.problem import examples
from magshell.problem.building import Problem, build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe

WORDS = re.compile(r"[\w.+-]+|\S")
NEW_WORDS = st.one_of(
    st.sampled_from(
        [
            "0",
            "-1",
            "1e9",
            "1e-9",
            "nan",
            "inf",
            "mm",
            "kPa",
            "mT",
            "deg",
            "true",
            '""',
            "[",
            "]",
            "{",
            "}",
            "=",
            "#",
        ]
    ),
    st.sampled_from(["left", "group", "kind", "clamp", "prescribe", "elements", "mesh", "field", "[[supports]]"]),
    st.integers(-3, 3000).map(str),
    st.floats().map(repr),
    st.text(max_size=5),
)
EXAMPLES = map(examples.text, ("strip-10", "gripper", "pump", "thin-cross"))
FILES = with_mesh(
    STRIP.replace(
        'kind = "constant"\nvector = ["143 mT", 0, 0]',
        'kind = "file"\nfile = "measured.csv"\nflux_density_unit = "mT"\nlength_unit = "mm"',
    ),
    '[mesh]\nfile = "part.msh"\nsecond_order = false\n\n[mesh.edge_groups]\nfar = { x1 = "20 mm" }\n\n',
)
TEXTS = st.sampled_from(
    [
        LOADED,
        EVERY_LOAD,
        STAGED,
        FIELDS,
        SURFACES,
        TEMPLATES,
        FILES,
        PROFILE,
        MIURA,
        EVERY_SOURCE,
        EVERY_FIELD,
        JOINTED,
        *EXAMPLES,
    ]
)


@st.composite
def damaged(draw: Callable[[st.SearchStrategy[Any]], Any]) -> str:
    """An example with one to three words or lines replaced, removed, repeated or exchanged, or cut short."""
    text = draw(TEXTS)
    text = "\n".join(line.split("#")[0].rstrip() for line in text.splitlines() if line.split("#")[0].strip())
    for _ in range(draw(st.integers(1, 3))):
        kind = draw(st.sampled_from(["word", "word", "word", "lines", "remove", "repeat", "cut", "character"]))
        lines = text.splitlines() or [""]
        i, j = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
        if kind == "word":
            words = list(WORDS.finditer(text)) or [re.match("", text)]
            word = draw(st.sampled_from(words))
            text = text[: word.start()] + str(draw(NEW_WORDS)) + text[word.end() :]
        elif kind == "character":
            at = draw(st.integers(0, len(text)))
            text = text[:at] + str(draw(st.characters(codec="utf-8"))) + text[at + 1 :]
        elif kind == "cut":
            text = text[: draw(st.integers(0, len(text)))]
        else:
            if kind == "lines":
                lines[i], lines[j] = lines[j], lines[i]
            elif kind == "remove":
                del lines[i]
            else:
                lines.insert(j, lines[i])
            text = "\n".join(lines)
    return text


VALUES = st.one_of(
    st.sampled_from(
        [0, 1, -1, 2, 1e-12, 1e300, True, None, "", "left", "top", "D", [], {}, [0, 0, 0], [0, 0], "u", "phi"]
    ),
    st.sampled_from(
        ["clamp", "simple", "symmetry", "prescribe", "constant", "circumferential", "meridional", "blocks"]
    ),
    st.sampled_from(["force", "moment", "traction", "pressure", "gravity"]),
    st.sampled_from(["cylinder", "dipole", "halbach", "loop", "solenoid", "helmholtz", "grid.csv", "coils.csv"]),
    st.sampled_from(["radial", "tangential", "along-curve", "profile", "file", "rolled", "folded", "deformed"]),
    st.integers(-2, 60),
    st.builds(
        "{} {}".format,
        st.one_of(st.floats(), st.integers(-200, 200), st.sampled_from([0, 3, 15, 90, 360])),
        st.sampled_from(["mm", "m", "kPa", "GPa", "mT", "T", "deg", "rad", "1/m", "m/s^2", "kg/m^3", "mN", ""]),
    ),
)


@st.composite
def altered(draw: Callable[[st.SearchStrategy[Any]], Any]) -> dict[str, Any]:
    """The data of an example with one to four entries replaced, removed, repeated or exchanged."""
    data = parse(draw(TEXTS), "altered.toml")
    for _ in range(draw(st.integers(1, 4))):
        holder, key = draw(st.sampled_from(list(places(data))))
        kind = draw(st.sampled_from(["replace", "replace", "replace", "exchange", "remove", "repeat"]))
        if kind == "replace":
            holder[key] = copy.deepcopy(draw(VALUES))
        elif kind == "exchange":
            other, place = draw(st.sampled_from(list(places(data))))
            holder[key], other[place] = copy.deepcopy(other[place]), copy.deepcopy(holder[key])
        elif kind == "remove":
            del holder[key]
        elif isinstance(holder, list):
            holder.append(copy.deepcopy(holder[key]))
    return data


def places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Every entry of nested lists and tables, as holder and key."""
    for key in range(len(data)) if isinstance(data, list) else data:
        yield data, key
        if isinstance(data[key], list | dict):
            yield from places(data[key])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the files that a problem names."""
    folder = tmp_path_factory.mktemp("problem")
    mesh = ms.mesh.rectangle(20e-3, 5e-3, (4, 1))
    ms.mesh.write(mesh, folder / "part.msh", "mm")
    rows = "".join(f"{2.5 + 5 * i},2.5,0,100,0,{i}\n" for i in range(4))
    (folder / "measured.csv").write_text(f"x1,x2,x3,b1,b2,b3\n{rows}")
    write_field_files(folder)
    return folder


def refused_or_a_problem(data: dict[str, Any] | str, name: str, folder: Path) -> None:
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            problem = build(check(parse(data, name) if isinstance(data, str) else data, name), name, folder=folder)
        except InputError as error:
            located(error, name)
            return
        assert isinstance(problem, Problem)
        said = [text for lines in describe(problem).sections.values() for label, text in lines if label != "title"]
        words = re.findall(r"\w+", " ".join(said))
        assert not {"nan", "inf"} & set(words) - set(problem.file.probes) - set(problem.model.shell.mesh.node_groups), (
            said
        )


@pytest.mark.parametrize(("text", "elements"), [(FILES, 4), (EVERY_FIELD, 4)])
def test_the_problems_with_files_are_some(text: str, elements: int, folder: Path) -> None:
    problem = build(check(parse(text, "files.toml"), "files.toml"), "files.toml", folder=folder)
    assert len(problem.model.shell.mesh.elements) == elements
    assert describe(problem).sections


@share(0.25)
@given(text=damaged())
def test_damaged_text(text: str, folder: Path) -> None:
    refused_or_a_problem(text, "damaged.toml", folder)


@share(0.35)
@given(data=altered())
def test_altered_data(data: dict[str, Any], folder: Path) -> None:
    refused_or_a_problem(data, "altered.toml", folder)
