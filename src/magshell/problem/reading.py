"""From a file, or the name of a built-in problem, to checked data; every error says file, key and remedy."""

from __future__ import annotations

import os
import pathlib
import re
import tomllib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

from magshell.errors import InputError, suggest
from magshell.nearest import nearest
from magshell.problem import examples
from magshell.problem.unknown import meant, not_a_table, unknown_key
from magshell.units import quoted, shortened

if TYPE_CHECKING:
    from pydantic import ValidationError

    from magshell.problem.schema import ProblemFile

MOST_ERRORS = 10
MOST_BYTES = 16 * 2**20
LISTS_OF_TABLES = ("supports", "loads", "remanence", "stages", "regions", "layers", "magnets", "coils")


class Source(NamedTuple):
    """A problem as text, its name for messages, and the folder where the paths in it start."""

    name: str
    text: str
    folder: pathlib.Path


def read(source: str | os.PathLike[str]) -> tuple[str, ProblemFile]:
    """Read a problem file or a built-in problem.

    Parameters
    ----------
    source : path or str
        A TOML file, or the name of a built-in problem where no such file exists.

    Returns
    -------
    str
        The file's name, for messages.
    ProblemFile
        Its content in SI.

    Raises
    ------
    InputError
        No such file, not a text file, not TOML, or not a problem: one line per error with file and key.
    """
    found = find(source)
    return found.name, check(parse(found.text, found.name), found.name)


def parse(text: str, name: str) -> dict[str, Any]:
    """TOML to plain data; a syntax error names line and column."""
    if not text.strip():
        raise InputError(f"{name}: the file is empty. See a problem that works with: magshell examples --copy strip-10")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name}: not valid TOML: {_explained(str(error), text)}") from None
    except RecursionError:
        raise InputError(f"{name}: not valid TOML: lists or tables are nested too deeply") from None
    except ValueError as error:  # integers of thousands of digits
        raise InputError(f"{name}: not valid TOML: {error}") from None


def check(data: Mapping[str, Any], name: str) -> ProblemFile:
    """Plain data to a problem in SI.

    Parameters
    ----------
    data : mapping
        As TOML gives it.
    name : str
        What messages call the file.

    Raises
    ------
    InputError
        One line per error, each with file and key.
    """
    from pydantic import ValidationError

    from magshell.problem.schema import problem_file

    try:
        return problem_file().model_validate(data)
    except ValidationError as error:
        raise InputError("\n".join(_lines(error, name))) from None


def find(source: str | os.PathLike[str]) -> Source:
    """The text of a problem file or of a built-in problem.

    Raises
    ------
    InputError
        No such file, or not a text file.
    """
    path = pathlib.Path(source)
    try:
        if not path.is_file() and os.fspath(source) in examples.names():
            return Source(f"{source}.toml", examples.text(os.fspath(source)), pathlib.Path())
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    except FileNotFoundError:
        raise InputError(_not_found(path)) from None
    except IsADirectoryError:
        raise InputError(f"{source}: is a folder; name a problem file (.toml) in it") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{source}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if len(content) > MOST_BYTES:
        raise InputError(f"{path.name}: has more than {MOST_BYTES // 2**20} MiB; a problem is a short TOML file")
    try:
        return Source(path.name, content.decode("utf-8-sig"), path.parent)
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path.name}: is not a text file in UTF-8 (byte {error.start} is 0x{content[error.start]:02x}); "
            "a problem is a TOML file"
        ) from None


def _not_found(path: pathlib.Path) -> str:
    here = [file.name for file in path.parent.glob("*.toml")] if path.parent.is_dir() else []
    return f"{path}: there is no such file or built-in problem. {suggest(path.name, [*here, *examples.names()])}"


def _explained(error: str, text: str) -> str:
    for marker in ("Cannot overwrite a value", "Cannot declare", "Cannot mutate"):
        if error.startswith(marker):
            return f"a key or table is written twice: {error}"
    place = re.search(r"at line ([0-9]+)", error)
    return error + (_unquoted(text.splitlines()[int(place[1]) - 1]) if place else "")


def _unquoted(line: str) -> str:
    """A remedy, as an addition, for a line with a quantity or a name without quotes; empty for others."""
    found = re.fullmatch(r"\s*([\w.\"'-]+)\s*=\s*([\w.+-][^\"'#\[\]{}=]*?)\s*(#.*)?", line)
    if found is None:
        bare = re.sub(r"\"[^\"]*\"|'[^']*'|#.*", "", line)
        listed = "[" in bare and re.search(r"[0-9]\s*[A-Za-z\u00b5\u03bc\u00b0]", bare.partition("=")[2])
        return '. Quantities with a unit are in quotes, also in a list: [0, "2 mT"]' if listed else ""
    value = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", found[2])
    return f'. Quantities with a unit, and names, are in quotes: {shortened(found[1])} = "{shortened(value)}"'


def _lines(error: ValidationError, name: str) -> list[str]:
    lines = []
    for details in error.errors(include_url=False):
        key, message = _located(details)
        lines.append(f"{name}: {key}: {message}" if key else f"{name}: {message}")
    if len(lines) > MOST_ERRORS:
        lines[MOST_ERRORS:] = [f"{name}: and {len(lines) - MOST_ERRORS} more errors"]
    return lines


def _located(details: Mapping[str, Any]) -> tuple[str, str]:
    """Key as a user would write it, and what is wrong with it."""
    found = [part for part in details["loc"] if part != "[key]"]
    context = details.get("ctx", {})
    if found[:1] == ["mesh"]:
        of_file = found[1:2] == ["file"]
        del found[1:2]  # file or generator
        where, place, choice = (found, "", "") if of_file else _without_choices(found)
    else:
        where, place, choice = _without_choices(found)
    match details["type"]:
        case "key_error":
            where.append(context["key"])
            message = context["message"]
        case "unknown_key":
            where.append(context["key"])
            message = unknown_key(context["key"], context["known"], at_the_top=len(where) == 1)
        case "value_error":
            message = str(context["error"])
        case "missing":
            message = "is missing"
        case "union_tag_not_found":
            where.append(choice)
            message = f"is missing{_in_its_place(choice, details['input'])}. {suggest('', _kinds(place))}"
        case "union_tag_invalid":
            where.append(choice)
            tag = str(context["tag"])
            message = f"{quoted(tag)} is not known. {suggest(tag, _kinds(place))}"
        case "literal_error":
            written, expected = details["input"], context["expected"]
            message = f"{quoted(written)} is not one of {expected}{meant(written, expected)}"
        case "model_attributes_type" | "dict_type":
            message = not_a_table(_pattern(where), details["input"])
        case "tuple_type" | "list_type":
            message = (
                f"is not a list: write [[{_pattern(where).replace('[]', '')}]]"
                if where[-1] in LISTS_OF_TABLES
                else "is not a list"
            )
        case "string_type":
            message = f"{quoted(details['input'])} is not text; write it in quotes"
        case "bool_type":
            message = f"{quoted(details['input'])} is neither true nor false"
        case _:
            message = str(details["msg"])
    return _written(where), message


def _in_its_place(key: str, table: object) -> str:
    """Which key of a table stands for one that is missing, as an addition; empty: none does."""
    found = [f"'{shortened(one)}'" for one in table if nearest(one, [key])] if isinstance(table, dict) else []
    return f"; there is {' and '.join(found)} in its place" if found else ""


def _without_choices(found: Sequence[str | int]) -> tuple[list[str | int], str, str]:
    """The path of an error without what pydantic puts into it where a table is one of several kinds.

    Returns
    -------
    list
        The path.
    str, str
        The last part of it where kinds are chosen among, and the key that chooses there; empty if it has none.
    """
    from magshell.problem.schema import ProblemFile

    where: list[str | int] = []
    place = choice = ""
    parts = iter(found)
    for part in parts:
        where.append(part)
        if (pattern := _pattern(where)) in ProblemFile.chosen_by:
            place, choice = pattern, ProblemFile.chosen_by[pattern]
            next(parts, None)
    return where, place, choice


def _pattern(where: Sequence[str | int]) -> str:
    """A path in which any number of an entry is `[]`."""
    return "".join("[]" if isinstance(part, int) else f".{part}" for part in where).lstrip(".")


def _kinds(place: str) -> list[str]:
    """What the key that chooses the kind of a table at this place may say."""
    from magshell.magnetics.fields import COILS, MAGNETS
    from magshell.magnetics.remanence import REMANENCES
    from magshell.materials import MATERIALS, names_of
    from magshell.model.loads import LOADS
    from magshell.model.repeated import REPEATED
    from magshell.model.springs import SPRINGS
    from magshell.model.supports import SUPPORTS
    from magshell.problem import schema

    table = place.split(".")[-1].removesuffix("[]")
    if table == "mesh":
        fields = [kind.model_fields.get("generator") for kind in get_args(schema.Mesh)]
        return [get_args(field.annotation)[0] for field in fields if field is not None]
    if table == "material":
        return [name for law in MATERIALS for name in names_of(law)]
    registries: dict[str, Mapping[str, Any]] = {
        "remanence": REMANENCES,
        "supports": SUPPORTS,
        "springs": SPRINGS,
        "repeated": REPEATED,
        "loads": LOADS,
        "magnets": MAGNETS,
        "coils": COILS,
    }
    return list(registries[table])


def _written(where: Sequence[str | int]) -> str:
    key = ""
    for part in where:
        key += f"[{part}]" if isinstance(part, int) else f"{'.' if key else ''}{shortened(part)}"
    return key
