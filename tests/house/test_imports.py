"""Imports point down: no circle of modules and no arrow upward, imports in functions and for typing included."""

from __future__ import annotations

import ast
import pathlib
from collections.abc import Iterator, Mapping

import pytest

import magshell
from magshell.drawing import HOMES, drawing

SOURCES = pathlib.Path(magshell.__file__).parent

# Lowest first; a module belongs to the longest name that it begins with, "" is the package itself.
LAYERS = (
    "version", "keys", "remembered", "nearest", "errors", "units", "wording", "arrays", "arguments", "multipliers",
    "files", "tables", "drawing", "kernel_cache", "compiled", "processes", "openblas", "mesh", "materials", "magnetics",
    "shell", "magnetics.remanence", "model", "linalg", "equations", "evaluation", "solver", "output", "kernel_messages",
    "progress", "problem", "results", "sweep", "reproduction", "cli", "__main__", "",
)  # fmt: skip
# The one module that finds others upward, by name: from objects to their pictures.
DOOR = "magshell.drawing"
MOST_ARGUMENTS = 8

Graph = Mapping[str, frozenset[str]]


def graph_of(root: pathlib.Path, package: str) -> Graph:
    """Which modules of a package each of them names, wherever it does: in imports, or whole in a string."""
    files = {".".join((package, *file.relative_to(root).with_suffix("").parts)): file for file in root.rglob("*.py")}
    files = {name.removesuffix(".__init__"): file for name, file in files.items()}
    return {
        name: frozenset(_named(ast.parse(file.read_text()), name, file.name == "__init__.py", files)) - {name}
        for name, file in files.items()
    }


def _named(tree: ast.AST, name: str, is_package: bool, known: Mapping[str, pathlib.Path]) -> Iterator[str]:
    for node in ast.walk(tree):
        match node:
            case ast.Import(names):
                yield from (alias.name for alias in names if alias.name in known)
            case ast.ImportFrom(module, names, level):
                parts = name.split(".")
                above = parts[: len(parts) - level + is_package] if level else []
                origin = ".".join([*above, *([module] if module else [])])
                if origin in known:
                    for alias in names:
                        inside = f"{origin}.{alias.name}"
                        yield inside if inside in known else origin
            case ast.Constant(str(text)) if text in known and "." in text:
                yield text


def circles(graph: Graph) -> list[list[str]]:
    """Modules that reach one another, by the algorithm of Tarjan."""
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(module: str) -> None:
        number[module] = lowest[module] = len(number)
        stack.append(module)
        for other in sorted(graph[module]):
            if other not in number:
                visit(other)
                lowest[module] = min(lowest[module], lowest[other])
            elif other in stack:
                lowest[module] = min(lowest[module], number[other])
        if lowest[module] == number[module]:
            circle = stack[stack.index(module) :]
            del stack[-len(circle) :]
            if len(circle) > 1:
                found.append(sorted(circle))

    for module in sorted(graph):
        if module not in number:
            visit(module)
    return found


def upward(graph: Graph, layers: tuple[str, ...]) -> set[tuple[str, str]]:
    """Arrows from a layer to a higher one."""

    def height(module: str) -> int:
        parts = module.split(".")[1:]
        return next(layers.index(name) for k in range(len(parts), -1, -1) if (name := ".".join(parts[:k])) in layers)

    homeless = [module for module in graph if "." in module and layers[height(module)] == ""]
    assert not homeless, "modules without a layer"
    return {(module, other) for module, others in graph.items() for other in others if height(other) > height(module)}


@pytest.fixture(scope="module")
def graph() -> Graph:
    found = dict(graph_of(SOURCES, "magshell"))
    assert found[DOOR], "the door names the modules that draw"
    found[DOOR] = frozenset()
    return found


def test_there_is_no_circle(graph: Graph) -> None:
    assert len(graph) > 250
    assert circles(graph) == []


def test_the_door_opens() -> None:
    for name in HOMES:
        assert callable(drawing(name)), name


def test_no_arrow_points_upward(graph: Graph) -> None:
    assert upward(graph, LAYERS) == set()


@pytest.mark.parametrize(
    ("low", "circle", "arrow"),
    [
        ("from house.high import roof", True, True),
        ("import house.high", True, True),
        ("from house import high", True, True),
        ("from .high import roof", True, True),
        ("from . import high", True, True),
        ("def f():\n    from house.high import roof", True, True),
        ("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from house.high import roof", True, True),
        ('from importlib import import_module\nroof = import_module("house.high")', True, True),
        ("from house import name", False, True),
        ("from house.mid import wall", False, False),
        ("text = 'house'", False, False),
    ],
)
def test_the_graph_sees_every_kind_of_import(tmp_path: pathlib.Path, low: str, circle: bool, arrow: bool) -> None:
    (tmp_path / "__init__.py").write_text("name = 1")
    (tmp_path / "low.py").write_text(low)
    (tmp_path / "mid").mkdir()
    (tmp_path / "mid" / "__init__.py").write_text("wall = 1")
    (tmp_path / "high.py").write_text("from house.low import cellar\nfrom house.mid import wall")
    order = ("mid", "low", "high", "")
    graph = graph_of(tmp_path, "house")
    assert circles(graph) == ([["house.high", "house.low"]] if circle else [])
    assert bool(upward(graph, order)) == arrow


def arguments(root: pathlib.Path) -> dict[str, int]:
    """Number of arguments of every function, self and cls apart."""
    found = {}
    for file in root.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
                given = node.args
                names = [one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
                count = len(names) - (names[:1] in (["self"], ["cls"])) + bool(given.vararg) + bool(given.kwarg)
                name = f"{file.relative_to(root).as_posix()}: {getattr(node, 'name', 'lambda')}"
                found[name] = max(count, found.get(name, 0))
    return found


def test_no_function_has_more_than_eight_arguments() -> None:
    assert not {name for name, count in arguments(SOURCES).items() if count > MOST_ARGUMENTS}


def test_arguments_are_counted(tmp_path: pathlib.Path) -> None:
    (tmp_path / "a.py").write_text(
        "class A:\n    def f(self, a, b, /, c, *args, d=1, **more): ...\ng = lambda a, b: a\ndef h(): ..."
    )
    assert arguments(tmp_path) == {"a.py: f": 6, "a.py: lambda": 2, "a.py: h": 0}
