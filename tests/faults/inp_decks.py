"""Input files made at random, of which the mesh is known without reading them."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field

import numpy as np
from hypothesis import strategies as st

from faults.inp_model import CORNERS, NODES, Model, Named

_LABELS = (
    "Left",
    "left",
    "LEFT",
    "Set-1",
    "SET-1",
    "set - 1",
    "all nodes",
    "_Picked7",
    '"Left"',
    '"tip, edge"',
    '"left"',
)
_NAMES = ("Part-1", "plate", "Arm_2")


@dataclass
class Grid:
    """The nodes and elements of a part: number and position, number and type and nodes."""

    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    node_sets: dict[str, tuple[str, set[int]]] = field(default_factory=dict)
    """By label without capitals and blanks: as it is shown, and its members."""
    element_sets: dict[str, tuple[str, set[int]]] = field(default_factory=dict)
    edges: dict[str, tuple[str, set[tuple[int, int]]]] = field(default_factory=dict)


def decks() -> st.SearchStrategy[tuple[str, Model]]:
    """Text of a file, and what it says."""
    return st.integers(0, 2**32 - 1).map(lambda seed: Writer(random.Random(seed)).deck())


class Writer:
    """Writes a file in one of the many ways in which it may be written."""

    def __init__(self, chance: random.Random) -> None:
        self.chance = chance
        self.lines: list[str] = []

    def deck(self) -> tuple[str, Model]:
        """A whole file and its model."""
        self.keyword("Heading")
        self.lines.append(" a strip, with *no* meaning")
        model = Model()
        if self.chance.random() < 0.4:
            self.add(model, "", self.part(), np.zeros(3), None)
            return self.text(), model
        parts = {}
        for name in _NAMES[: self.chance.randint(1, 2)]:
            self.keyword("Part", f"name={self.case(name)}")
            parts[name] = self.part()
            self.keyword("End Part")
        self.keyword("Assembly", "name=Assembly")
        for number in range(self.chance.randint(1, 3)):
            self.instance(model, f"Inst-{number}", *self.chance.choice(list(parts.items())))
        for _ in range(self.chance.randint(0, 4)):
            self.assembly_set(model)
        self.keyword("End Assembly")
        return self.text(), model

    def text(self) -> str:
        """With comments, empty lines and blanks at random, and one kind of line ends."""
        noisy = []
        for line in self.lines:
            noisy += [self.chance.choice(["** a comment, 1, 2", "", "   "])] * (self.chance.random() < 0.05)
            noisy.append(" " * self.chance.choice([0, 0, 0, 2]) + line + " " * self.chance.choice([0, 0, 0, 1]))
        return self.chance.choice(["\n", "\r\n"]).join([*noisy, ""])

    def case(self, text: str) -> str:
        return self.chance.choice([str, str, str.upper, str.lower])(text)

    def keyword(self, name: str, *parameters: str) -> None:
        """A keyword line, over two lines at times."""
        words = [
            self.case(name),
            *(self.case(p.partition("=")[0]) + "=" * ("=" in p) + p.partition("=")[2] for p in parameters),
        ]
        joint = self.chance.choice([",", ", ", " , "])
        if len(words) > 1 and self.chance.random() < 0.1:
            self.lines += [f"*{joint.join(words[:-1])},", words[-1]]
        else:
            self.lines.append("*" + joint.join(words))

    def rows(self, rows: list[list[object]]) -> None:
        self.lines += [
            self.chance.choice([", ", ",", " ,  "]).join(map(str, row)) + self.chance.choice(["", "", ","])
            for row in rows
        ]

    def real(self, x: float) -> str:
        """Exactly this number."""
        return self.chance.choice([repr(x), repr(x), f"{x:.17e}", f"{x:.17E}".replace("E", "D")])

    def part(self) -> Grid:
        """Nodes, elements, sets and surfaces of a part."""
        grid = Grid()
        nx, ny = self.chance.randint(1, 3), self.chance.randint(1, 2)
        step, base = self.chance.choice([1, 2, 5]), self.chance.choice([1, 8, 1000])
        row = step * (2 * nx + 1) + self.chance.choice([0, 3, 90])
        lattice = {(i, j): base + step * i + row * j for j in range(2 * ny + 1) for i in range(2 * nx + 1)}
        self.nodes(grid, lattice, nx, ny, step, row)
        self.elements(grid, lattice, nx, ny, step, row)
        for _ in range(self.chance.randint(0, 4)):
            self.node_set(grid) if self.chance.random() < 0.5 else self.element_set(grid)
        if self.chance.random() < 0.5:
            self.surface(grid)
        return grid

    def nodes(self, grid: Grid, lattice: dict[tuple[int, int], int], nx: int, ny: int, step: int, row: int) -> None:
        place, polar = self.system(), self.chance.random() < 0.4
        raw = {
            number: (4.0 + 0.5 * j, 15.0 * i, 0.25 * i) if polar else (1.5 * i, 0.75 * j, 0.125 * j)
            for (i, j), number in lattice.items()
        }
        for number, (a, b, c) in raw.items():
            local = (a * math.cos(math.radians(b)), a * math.sin(math.radians(b)), c) if polar else (a, b, c)
            grid.nodes[number] = tuple((place[0] + place[1:].T @ np.array(local)).tolist())
        given = ["system=" + self.chance.choice("Cc")] if polar else self.chance.choice([[], ["system=R"]])
        if polar or self.chance.random() < 0.6:
            numbers = list(raw)
            self.chance.shuffle(numbers)
            cut = self.chance.randint(0, len(numbers))
            for some in (numbers[:cut], numbers[cut:]):
                named = [f"nset={self.label(grid.node_sets, set(some))}"] if some and self.chance.random() < 0.5 else []
                self.keyword("Node", *self.shuffled([*given, *named]))
                self.rows([[number, *map(self.real, raw[number])] for number in some])
        else:
            corners = [lattice[i, j] for j in (0, 2 * ny) for i in (0, 2 * nx)]
            self.keyword("Node", *given)
            self.rows([[number, *map(self.real, raw[number])] for number in corners])
            for label, j in (("low-line", 0), ("high-line", 2 * ny)):
                inside = {lattice[i, j] for i in range(2 * nx + 1)}
                grid.node_sets[label.upper()] = (label, inside)
                self.keyword("Ngen", f"nset={label}")
                self.rows([[lattice[0, j], lattice[2 * nx, j], step]])
            named = [f"nset={self.label(grid.node_sets, set(raw))}"] if self.chance.random() < 0.5 else []
            self.keyword("Nfill", *named)
            self.rows([["LOW-line", "high-LINE", 2 * ny, row]])
        self.keyword("System")
        if self.chance.random() < 0.3:
            grid.nodes[99999] = (1.0, 2.0, 3.0)
            self.keyword("Node")
            self.rows([[99999, 1, "2.", 3.0]])

    def system(self) -> np.ndarray:
        """Origin and axes (4, 3) of a system that is written, or of none."""
        kind = self.chance.random()
        if kind < 0.4:
            return np.vstack([np.zeros(3), np.eye(3)])
        origin = np.array([self.chance.uniform(-9, 9) for _ in range(3)])
        self.keyword("System")
        if kind < 0.6:
            self.rows([[self.real(float(x)) for x in origin]])
            return np.vstack([origin, np.eye(3)])
        axes = np.linalg.qr(np.random.default_rng(self.chance.randrange(999)).normal(size=(3, 3)))[0]
        axes[2] *= np.linalg.det(axes)
        on_x, in_plane = origin + 3.0 * axes[0], origin + 2.0 * axes[1] - 0.7 * axes[0]
        self.rows([[self.real(float(x)) for x in (*origin, *on_x)], [self.real(float(x)) for x in in_plane]])
        return np.vstack([origin, axes])

    def elements(self, grid: Grid, lattice: dict[tuple[int, int], int], nx: int, ny: int, step: int, row: int) -> None:
        kind = self.chance.choice(["S4", "CPS4", "S8R", "CPS8", "S3", "S6", "STRI65"])
        base, increment = self.chance.choice([1, 50]), self.chance.choice([1, 3])
        cells = [(2 * i, 2 * j) for j in range(ny) for i in range(nx)]
        rows: dict[int, tuple[int, ...]] = {}
        for i, j in cells:
            a, b, c, d = lattice[i, j], lattice[i + 2, j], lattice[i + 2, j + 2], lattice[i, j + 2]
            ab, bc, cd, da = lattice[i + 1, j], lattice[i + 2, j + 1], lattice[i + 1, j + 2], lattice[i, j + 1]
            ac = lattice[i + 1, j + 1]
            every = {
                "4": [(a, b, c, d)],
                "8": [(a, b, c, d, ab, bc, cd, da)],
                "3": [(a, b, c), (a, c, d)],
                "6": [(a, b, c, ab, bc, ac), (a, c, d, ac, cd, da)],
            }
            for nodes in every[{3: "3", 4: "4", 6: "6", 8: "8"}[NODES[kind]]]:
                rows[base + increment * len(rows)] = nodes
        grid.elements |= {number: (kind, nodes) for number, nodes in rows.items()}
        label = f"elset={self.label(grid.element_sets, set(rows))}" if self.chance.random() < 0.6 else None
        if CORNERS[kind] == 4 and self.chance.random() < 0.4:
            self.keyword("Element", f"type={self.case(kind)}")
            self.rows([[base, *rows[base]]])
            self.keyword("Elgen", *([label] if label else []))
            self.rows([[base, nx, 2 * step, increment, ny, 2 * row, nx * increment]])
        else:
            numbers = list(rows)
            self.chance.shuffle(numbers)
            self.keyword("Element", *self.shuffled([f"type={self.case(kind)}", *([label] if label else [])]))
            for number in numbers:
                fields = [str(n) for n in (number, *rows[number])]
                cut = self.chance.choice([0, 0, 0, len(fields) // 2])
                self.lines += [", ".join(fields[:cut]) + ","] * bool(cut) + [", ".join(fields[cut:])]
        top = max(rows) + 1
        if self.chance.random() < 0.4:
            line = "T3D3" if NODES[kind] > 4 else "T3D2"
            nodes = (lattice[0, 0], lattice[1, 0], lattice[2, 0]) if line == "T3D3" else (lattice[0, 0], lattice[2, 0])
            grid.elements[top] = (line, nodes)
            self.keyword("Element", f"type={line}", f"elset={self.label(grid.element_sets, {top})}")
            self.rows([[top, *nodes]])
        if self.chance.random() < 0.3:
            grid.elements[top + 7] = ("MASS", (lattice[2, 2],))
            self.keyword("Element", "type=MASS", f"elset={self.label(grid.element_sets, {top + 7})}")
            self.rows([[top + 7, lattice[2, 2]]])

    def label(self, sets: dict[str, tuple[str, set[int]]], members: set[int]) -> str:
        """A label for more members; they join a set that is called so but for capitals and blanks."""
        text = self.chance.choice(_LABELS)
        key = text[1:-1] if text.startswith('"') else text.replace(" ", "").upper()
        shown = text.strip('"')
        if any(key != other and shown == name for other, (name, _) in sets.items()):
            return self.label(sets, members)  # two groups that are shown alike: another test
        sets.setdefault(key, (shown, set()))[1].update(members)
        return text

    def node_set(self, grid: Grid) -> None:
        if grid.element_sets and self.chance.random() < 0.4:
            key = self.chance.choice(list(grid.element_sets))
            inside = {node for element in grid.element_sets[key][1] for node in grid.elements[element][1]}
            of = self.written(grid.element_sets, key)
            self.keyword("Nset", f"nset={self.label(grid.node_sets, inside)}", f"elset={of}")
            return
        self.any_set("Nset", grid.node_sets, sorted(grid.nodes))

    def element_set(self, grid: Grid) -> None:
        self.any_set("Elset", grid.element_sets, sorted(grid.elements))

    def any_set(self, word: str, sets: dict[str, tuple[str, set[int]]], there: list[int]) -> None:
        """Of a range, or of numbers and other sets."""
        if self.chance.random() < 0.4:
            first, step, count = self.chance.choice(there), self.chance.randint(1, 4), self.chance.randint(0, 6)
            label = self.label(sets, set(range(first, first + step * count + 1, step)) & set(there))
            self.keyword(word, f"{word.lower()}={label}", self.chance.choice(["generate", "GENERATE", "gen"]))
            self.rows([[first, first + step * count, *([step] if step > 1 or self.chance.random() < 0.5 else [])]])
            return
        numbers = set(self.chance.sample(there, self.chance.randint(1, len(there))))
        others = self.chance.sample(list(sets), self.chance.randint(0, min(2, len(sets))))
        fields: list[object] = [*map(str, numbers), *(self.written(sets, key) for key in others)]
        self.chance.shuffle(fields)
        inside = numbers.union(*(sets[key][1] for key in others))
        self.keyword(
            word, f"{word.lower()}={self.label(sets, inside)}", *self.chance.choice([[], ["unsorted"], ["internal"]])
        )
        self.rows([fields[k : k + 5] for k in range(0, len(fields), 5)])

    def written(self, sets: dict[str, tuple[str, set[int]]], key: str) -> str:
        """The label of a set that is there."""
        shown = sets[key][0]
        return (
            self.case(shown)
            if key == shown.replace(" ", "").upper() and '"' + shown + '"' not in _LABELS
            else self.exact(shown, key)
        )

    def exact(self, shown: str, key: str) -> str:
        return f'"{key}"' if key != shown.replace(" ", "").upper() or "," in key else shown

    def surface(self, grid: Grid) -> None:
        """Edges of sets and of single elements."""
        kinds = {number: kind for number, (kind, _) in grid.elements.items() if kind in CORNERS}
        rows: list[list[object]] = []
        chosen = set()
        for number in self.chance.sample(sorted(kinds), self.chance.randint(1, len(kinds))):
            side = self.chance.randrange(CORNERS[kinds[number]])
            rows.append([number, self.case(f"E{side + 1}")])
            chosen.add((number, side))
        for key, (_, members) in grid.element_sets.items():
            if members and members <= set(kinds) and self.chance.random() < 0.5:
                rows.append([self.written(grid.element_sets, key), "E2"])
                chosen |= {(number, 1) for number in members}
        grid.edges["RIM"] = ("Rim", chosen)
        self.keyword("Surface", "name=Rim", *self.chance.choice([[], ["type=ELEMENT"], ["type=element"]]))
        self.rows(rows)

    def instance(self, model: Model, name: str, part_name: str, part: Grid) -> None:
        """A part where it is, with a set of its own at times."""
        self.keyword("Instance", *self.shuffled([f"name={name}", f"part={self.case(part_name)}"]))
        shift, turn = np.zeros(3), None
        if self.chance.random() < 0.8:
            shift = np.array([self.chance.uniform(-99, 99) for _ in range(3)])
            self.rows([[self.real(float(x)) for x in shift]])
            if self.chance.random() < 0.6:
                turn = np.array([self.chance.uniform(-5, 5) for _ in range(6)] + [self.chance.uniform(-180, 180)])
                self.rows([[self.real(float(x)) for x in turn]])
        own = Grid(
            part.nodes,
            part.elements,
            {key: (shown, set(members)) for key, (shown, members) in part.node_sets.items()},
            {key: (shown, set(members)) for key, (shown, members) in part.element_sets.items()},
            part.edges,
        )
        if self.chance.random() < 0.4:
            self.node_set(own)
        self.keyword("End Instance")
        self.add(model, name, own, shift, turn)

    def add(self, model: Model, name: str, grid: Grid, shift: np.ndarray, turn: np.ndarray | None) -> None:
        """A part in the model."""
        model.scopes += [name] if name else []
        for number, point in grid.nodes.items():
            model.nodes[name, number] = tuple(_moved(np.array(point) + shift, turn).tolist())
        model.elements |= {(name, number): each for number, each in grid.elements.items()}
        for into, sets in ((model.node_sets, grid.node_sets), (model.element_sets, grid.element_sets)):
            for key, (shown, members) in sets.items():
                into[name, key] = Named(name, shown, {(name, number) for number in members})
        for key, (shown, edges) in grid.edges.items():
            model.edges[name, key] = (shown, {(name, *edge) for edge in edges})

    def assembly_set(self, model: Model) -> None:
        """Numbers of an instance, or members of several."""
        instance = self.chance.choice(model.scopes)
        own = [key for scope, key in model.node_sets if scope == instance]
        there = sorted(number for scope, number in model.nodes if scope == instance)
        numbers = self.chance.sample(there, self.chance.randint(1, 4))
        key = self.chance.choice(own) if own and self.chance.random() < 0.5 else None
        inside = {(instance, number) for number in numbers}
        label = self.chance.choice(["Left", "left", "Set-1", "of the assembly"])
        found = model.node_sets.setdefault(("", label.replace(" ", "").upper()), Named("", label))
        if key is not None:
            inside |= model.node_sets[instance, key].members
        written = (
            self.written({k: (n.shown, set()) for (s, k), n in model.node_sets.items() if s == instance}, key)
            if key
            else ""
        )
        if self.chance.random() < 0.5:
            self.keyword("Nset", f"nset={label}", f"instance={self.case(instance)}")
            self.rows([[*numbers, *([written] if key else [])]])
        else:
            self.keyword("Nset", f"nset={label}")
            dotted = [] if not key or written.startswith('"') else [f"{self.case(instance)}.{written}"]
            if key and not dotted:
                inside = {(instance, number) for number in numbers}
            self.rows([[*(f"{instance}.{number}" for number in numbers), *dotted]])
        found.members |= inside

    def shuffled(self, items: list[str]) -> list[str]:
        self.chance.shuffle(items)
        return items


def _moved(point: np.ndarray, turn: np.ndarray | None) -> np.ndarray:
    """Turned about an axis by a product of unit quaternions."""
    if turn is None:
        return point
    axis = (turn[3:6] - turn[:3]) / np.linalg.norm(turn[3:6] - turn[:3])
    w, v = math.cos(math.radians(turn[6]) / 2), math.sin(math.radians(turn[6]) / 2) * axis
    arm = point - turn[:3]
    return turn[:3] + arm + 2.0 * np.cross(v, np.cross(v, arm) + w * arm)
