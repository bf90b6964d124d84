"""Which keyword belongs to which part, instance or the assembly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from magshell.errors import InputError, suggest
from magshell.mesh.files.contents import Contents
from magshell.mesh.files.inp.blocks import read_elements, read_nodes, read_set, read_surface
from magshell.mesh.files.inp.flattening import flattened
from magshell.mesh.files.inp.frames import frame, move
from magshell.mesh.files.inp.generators import copy_elements, copy_nodes, fill_nodes, generate_elements, generate_nodes
from magshell.mesh.files.inp.keywords import Keyword, key, keywords, lookup, parameters, reals, shown
from magshell.mesh.files.inp.numbering import Placed
from magshell.mesh.files.inp.scope import Scope
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

_IN_SCOPE: Mapping[str, Callable[[Lines, Keyword, Scope], None]] = {
    "NODE": read_nodes,
    "ELEMENT": read_elements,
    "NGEN": generate_nodes,
    "NFILL": fill_nodes,
    "NCOPY": copy_nodes,
    "ELGEN": generate_elements,
    "ELCOPY": copy_elements,
}
_REFUSED = {
    "INCLUDE": "other files are not read: put the included text in its place, or name the file with the mesh itself",
    "NMAP": "nodes are not mapped: write their coordinates",
    "IMPERFECTION": "imperfections are not read: write the coordinates of the imperfect shell",
    "IMPORT": "models of other analyses are not read: write the nodes and elements themselves",
    "SYMMETRICMODELGENERATION": "models are not generated of others: write the nodes and elements themselves",
}
"""What would change the mesh."""
_SECTIONS = ("SHELLSECTION", "SHELLGENERALSECTION", "MEMBRANESECTION")
_CONSTRAINTS = {
    "TIE", "MPC", "EQUATION", "COUPLING", "KINEMATICCOUPLING", "DISTRIBUTINGCOUPLING", "RIGIDBODY", "EMBEDDEDELEMENT",
    "SHELLTOSOLIDCOUPLING", "FASTENER", "CYCLICSYMMETRYMODEL",
}  # fmt: skip
"""What joins nodes to each other and is not read."""
_READ = {
    *_IN_SCOPE, *_REFUSED, "NSET", "ELSET", "SURFACE", "SYSTEM", "PART", "INSTANCE", "ASSEMBLY", "ENDPART",
    "ENDINSTANCE", "ENDASSEMBLY",
}  # fmt: skip
_SHORTEST = 3


@dataclass
class _Deck:
    """The scopes of a file, as they are read."""

    lines: Lines
    parts: dict[str, Scope] = field(default_factory=dict)
    instances: dict[str, Placed] = field(default_factory=dict)
    assembly: Placed = field(default_factory=lambda: Placed(Scope("")))
    used: set[str] = field(default_factory=set)
    """Parts that have an instance."""
    inside: Keyword | None = None
    """The `*PART` or `*INSTANCE` that is not ended yet."""
    notes: list[str] = field(default_factory=list)
    constraints: dict[str, int] = field(default_factory=dict)
    """Keywords, and the line of the first."""

    def __post_init__(self) -> None:
        self.scope = self.assembly.scope

    def read(self, keyword: Keyword) -> None:
        """Take in a keyword."""
        lines, name = self.lines, keyword.name
        match name:
            case "NSET" | "ELSET":
                seen = {key: each.scope for key, each in self.instances.items()}
                read_set(lines, keyword, self.scope, seen if self.scope is self.assembly.scope else {})
            case "SURFACE":
                read_surface(lines, keyword, self.scope, self.notes)
            case "SYSTEM":
                self._system(keyword)
            case "PART":
                self._begin(keyword, self._part(keyword))
            case "INSTANCE":
                self._begin(keyword, self._instance(keyword))
            case "ASSEMBLY" | "ENDASSEMBLY":
                self._ended(keyword)
            case "ENDPART" | "ENDINSTANCE":
                self.inside, self.scope = None, self.assembly.scope
            case _ if name in _IN_SCOPE:
                _IN_SCOPE[name](lines, keyword, self.scope)
            case _ if name in _REFUSED:
                lines.fail(keyword.line, f"*{name}: {_REFUSED[name]}")
            case _ if name in _SECTIONS:
                self._section(keyword)
            case _ if name in _CONSTRAINTS:
                self.constraints.setdefault(name, keyword.line)
            case _ if len(name) >= _SHORTEST and any(known.startswith(name) for known in _READ) and name != "END":
                full = " or ".join(f"*{known}" for known in sorted(_READ) if known.startswith(name))
                lines.fail(keyword.line, f"*{name} is not read; write {full}")

    def _begin(self, keyword: Keyword, scope: Scope) -> None:
        self._ended(keyword)
        self.inside, self.scope = keyword, scope

    def _ended(self, keyword: Keyword) -> None:
        if self.inside is not None:
            self.lines.fail(
                keyword.line,
                f"*{keyword.name} stands in the *{self.inside.name} of line {self.inside.line + 1}, which has no "
                f"*END {self.inside.name}",
            )

    def _part(self, keyword: Keyword) -> Scope:
        label = parameters(self.lines, keyword, ("NAME",)).get("NAME", "")
        if not label or key(label) in self.parts:
            fault = f"there is a part '{shortened(shown(label))}' above" if label else "the part has no name"
            self.lines.fail(keyword.line, f"{fault}: write *PART, NAME=a name of its own")
        self.parts[key(label)] = Scope(shown(label))
        return self.parts[key(label)]

    def _instance(self, keyword: Keyword) -> Scope:
        lines = self.lines
        given = parameters(lines, keyword, ("NAME", "PART"))
        label = given.get("NAME", "")
        part = lookup({name: name for name in self.parts}, given.get("PART", ""))
        if not label or key(label) in self.instances:
            fault = f"there is an instance '{shortened(shown(label))}' above" if label else "the instance has no name"
            lines.fail(keyword.line, f"{fault}: write *INSTANCE, NAME=a name of its own, PART=the part")
        if part is None:
            known = suggest(
                shortened(shown(given.get("PART", ""))), (shortened(each.name) for each in self.parts.values())
            )
            lines.fail(keyword.line, f"there is no part '{shortened(shown(given.get('PART', '')))}' above. {known}")
        what = "a translation, then two points of an axis and an angle"
        moved = move(reals(lines, keyword, 0, 3, what), reals(lines, keyword, 1, 7, what))
        if moved is None or len(keyword.rows) > 2:
            lines.fail(keyword.line, f"the instance is placed by {what}, on two lines")
        self.used.add(part)
        self.instances[key(label)] = Placed(self.parts[part].instance(shown(label)), moved)
        return self.instances[key(label)].scope

    def _system(self, keyword: Keyword) -> None:
        what = "the origin and a point on the first axis, then one in the plane of the first and second axes"
        first, second = (reals(self.lines, keyword, row, most, what) for row, most in ((0, 6), (1, 3)))
        self.scope.frame = frame(first, second) if first else None
        if len(keyword.rows) > 2 or (first and self.scope.frame is None):
            self.lines.fail(keyword.line, f"these points define no axes; there must be {what}")

    def _section(self, keyword: Keyword) -> None:
        """The nodes are on the mid-surface, or else the mesh is not that of the deck."""
        offset = next((value for name, value in keyword.parameters if name == "OFFSET"), "0")
        try:
            there = float(offset.upper().replace("D", "E")) != 0.0
        except ValueError:
            there = not ("MIDDLE".startswith(offset.upper()) and offset)
        if there:
            self.lines.fail(
                keyword.line,
                f"OFFSET={shortened(offset)} puts the mid-surface off the nodes; here the nodes are on it: write the "
                "coordinates of the mid-surface, and no OFFSET",
            )

    def contents(self) -> Contents:
        """All of it as one mesh."""
        placed = self.instances or {name: Placed(part) for name, part in self.parts.items()}
        if self.instances:
            self.notes += [
                f"part '{shortened(part.name)}' left out, as it has no instance"
                for name, part in self.parts.items()
                if name not in self.used
            ]
        if self.constraints:
            listed = ", ".join(f"*{name} (line {line + 1})" for name, line in self.constraints.items())
            self.notes.append(f"constraints are not read: {listed}")
        return flattened(self.lines, placed, self.assembly, self.notes)


def read_inp(content: bytes, name: str) -> Contents:
    """Read the mesh of an Abaqus or CalculiX input file.

    Sets become groups: of elements, of edges (where they hold lines), of nodes. So do surfaces: of elements, or of
    edges (E1, E2, ...). A group of the assembly, or of a file without parts, has the name of the set; one of an
    instance too, if no other set of the file has it, and is else called `instance.set`, as in Abaqus.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        What is wrong, or changes the mesh and is not read, with file and line.
    """
    lines = Lines(name, content.removeprefix(b"\xef\xbb\xbf"))
    lines.every = [line.strip() for line in lines.every]
    deck = _Deck(lines)
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused in the end
        for keyword in keywords(lines):
            deck.read(keyword)
        found = deck.contents()
    if not np.isfinite(found.points).all():
        raise InputError(f"{name}: coordinates are not finite in their coordinate system, or where their instance is")
    if not len(found.points):
        raise InputError(f"{name}: has no *NODE block with nodes; it is not an Abaqus input file, or it has no mesh")
    return found
