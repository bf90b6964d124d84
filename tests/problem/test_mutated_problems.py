"""A problem file damaged at random is refused with its place or still a problem; nothing else happens."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from problem_files import LOADED

from magshell.errors import InputError
from magshell.problem import examples
from magshell.problem.building import Problem, build
from magshell.problem.reading import check, parse
from problem.loaded import EVERY_LOAD
from problem.magnetised import FIELDS, SURFACES, TEMPLATES
from problem.test_staged_problems import STAGED

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
TEXTS = st.sampled_from([LOADED, EVERY_LOAD, STAGED, FIELDS, SURFACES, TEMPLATES, *EXAMPLES])


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


def refused_or_a_problem(data: dict[str, Any] | str, name: str) -> None:
    try:
        problem = build(check(parse(data, name) if isinstance(data, str) else data, name), name)
    except InputError as error:
        lines = str(error).splitlines()
        assert lines
        assert all(line.startswith(f"{name}: ") for line in lines), lines
    else:
        assert isinstance(problem, Problem)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(text=damaged())
def test_damaged_text(text: str) -> None:
    refused_or_a_problem(text, "damaged.toml")


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(data=altered())
def test_altered_data(data: dict[str, Any]) -> None:
    refused_or_a_problem(data, "altered.toml")
