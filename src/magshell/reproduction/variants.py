"""The problem files that are solved: the built-in ones with the paper's element, and changes of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from magshell.problem import read
from magshell.reproduction.catalogue import Example

if TYPE_CHECKING:
    from magshell.problem.schema import Blocks, ProblemFile, Selection

Stretch: TypeAlias = Literal["linear", "plane-stress", "none"]
LARGER = 1.02
"""Ratio of the in-plane dimensions of the hollow cross in its second solve."""
OTHER_ELEMENT = "gripper, default element"
"""The gripper with the element that problem files have by themselves."""
LOCKING = ("strip-10", "strip-20", "strip-41")
"""Strips that are also solved without the thickness stretch."""
STRETCHES: tuple[Stretch, ...] = ("linear", "plane-stress", "none")


def variants(example: Example) -> dict[str, ProblemFile]:
    """What is solved for an example, by name; its own problems first."""
    files = {name: paper_file(name) for name in example.problems}
    if example.name == "hollow-cross":
        files["hollow-cross, larger"] = scaled(files["hollow-cross"], LARGER)
    if example.name == "gripper":
        files[OTHER_ELEMENT] = read("gripper")[1]
    if example.name == "strips":
        for name in LOCKING:
            for stretch in STRETCHES:
                files[stretched(name, stretch)] = _changed(files[name], thickness_stretch=stretch)
    return files


def paper_file(name: str) -> ProblemFile:
    """A built-in problem with the element of the paper."""
    return _changed(read(name)[1], element="paper")


def stretched(name: str, stretch: Stretch) -> str:
    """The name of a problem with this kind of thickness stretch; "linear" is the problem itself."""
    return name if stretch == "linear" else f"{name}, {stretch}"


def _changed(file: ProblemFile, **keys: str) -> ProblemFile:
    """A problem with other keys in its table [shell]."""
    return file.model_copy(update={"shell": file.shell.model_copy(update=keys)})


def scaled(file: ProblemFile, ratio: float) -> ProblemFile:
    """A problem of flat blocks with all its lengths in the plane multiplied; not its thickness."""
    mesh: Blocks = file.mesh  # type: ignore[assignment]
    blocks = {
        name: block.model_copy(update={"corners": tuple(_times(corner, ratio) for corner in block.corners)})
        for name, block in mesh.blocks.items()
    }
    groups = {
        kind: {name: _selection(selection, ratio) for name, selection in getattr(mesh, kind).items()}
        for kind in ("edge_groups", "node_groups")
    }
    probes = {name: _times(position, ratio) for name, position in file.probes.items()}
    return file.model_copy(update={"mesh": mesh.model_copy(update={"blocks": blocks, **groups}), "probes": probes})


def _selection(selection: Selection, ratio: float) -> Selection:
    given = {name: value for name in ("x1", "x2", "x3") if (value := getattr(selection, name)) is not None}
    return selection.model_copy(update={name: value * ratio for name, value in given.items()})


def _times(position: tuple[float, ...], ratio: float) -> tuple[float, ...]:
    return tuple(x * ratio for x in position)
