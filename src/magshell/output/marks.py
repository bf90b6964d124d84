"""Marks on the part in a picture of the problem: arrows, posts, balls, each with its name for the legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.geometry import centres, unit
from magshell.output.scene import polylines
from magshell.output.style import ACCENT, COLOURS, INK
from magshell.units import FLUX_DENSITY, HINGE_STIFFNESS, MAGNETIC_MOMENT, show

if TYPE_CHECKING:
    from magshell.model.model import Model

REMANENCE, LOAD, SUPPORTS = COLOURS[0], COLOURS[3], (COLOURS[2], COLOURS[4], COLOURS[6], COLOURS[5])
BODIES, HINGES = (COLOURS[1], COLOURS[7 % len(COLOURS)]), (ACCENT, INK)
MOST_ARROWS = 110
MOST_POSTS = 40
MOST_NAMES = 40
MOST_OF_A_LOAD = 12
EVENING = 8
LONGEST, SHORTEST = 0.11, 0.03
"""Length of an arrow over the size of the part."""
SAME = 1e-9
TIP = 0.11
"""Radius of an arrow's head, and of a coil, over its length."""
COIL_TURNS = 5
MOST_OF_A_TURN = np.radians(320.0)


class Solids(Enum):
    """How a mark looks in space, and in the legend."""

    ARROWS = ("$\\rightarrow$", 20.0)
    CUBES = ("s", 8.0)
    BALLS = ("o", 7.0)
    COILS = ("$\\wr$", 13.0)
    BARS = ("_", 16.0)
    TURNS = ("$\\circlearrowleft$", 15.0)

    @property
    def marker(self) -> str:
        """Of matplotlib."""
        return str(self.value[0])

    @property
    def size(self) -> float:
        """Points."""
        return float(self.value[1])


@dataclass(frozen=True, eq=False)
class Mark:
    """Equal things at places.

    Attributes
    ----------
    name : str
        In the legend; empty: not there.
    colour : str
    solids : Solids
    places : FloatArray, shape (n, 3)
        Middles of arrows, coils, bars, cubes, balls and turns, m.
    vectors : FloatArray, shape (n, 3)
        Of arrows, coils and bars, as long as they are drawn, m; of turns, the axis, as long as the radius.
    width : float
        Of cubes and balls, and how thick bars are, m.
    letters : list of (str, FloatArray (3,), (float, float))
        Text, its place, and in which direction of the picture it stands beside it; (0, 0): on it.
    start : FloatArray, shape (3,)
        Of turns: the direction, normal to the axis, in which the arc begins.
    angle : float
        Of turns, rad; more than `MOST_OF_A_TURN` is not drawn.
    """

    name: str
    colour: str
    solids: Solids
    places: FloatArray
    vectors: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    width: float = 0.0
    letters: Sequence[tuple[str, FloatArray, tuple[float, float]]] = ()
    start: FloatArray = field(default_factory=lambda: np.zeros(3))
    angle: float = 0.0

    @property
    def extent(self) -> FloatArray:
        """Points (m, 3) that the picture must hold."""
        if not len(self.vectors):
            return self.places
        if self.solids is Solids.TURNS:
            radius = 1.3 * float(np.linalg.norm(self.vectors, axis=1).max())
            return np.concatenate([self.places + side for side in radius * np.concatenate([np.eye(3), -np.eye(3)])])
        beyond = 0.7 if self.letters else 0.5
        ends = np.concatenate([self.places - 0.5 * self.vectors, self.places + beyond * self.vectors])
        aside = TIP * float(np.linalg.norm(self.vectors, axis=1).max(initial=0.0)) * np.eye(3)
        return np.concatenate([ends + side for side in (*aside, *-aside)])

    @property
    def covered(self) -> FloatArray:
        """Points (m, 3) all over what is drawn, for letters that keep clear of it."""
        if self.solids is Solids.TURNS:
            return np.concatenate([self.arc, self.places + np.linspace(-1.0, 1.0, 9)[:, None] * self.vectors])
        if not len(self.vectors):
            return self.places
        along = np.linspace(-0.5, 0.5, 9)[:, None, None]
        return (self.places + along * self.vectors).reshape(-1, 3)

    @property
    def arc(self) -> FloatArray:
        """Points (m, 3) of a turn, from its beginning to its end."""
        radius = float(np.linalg.norm(self.vectors[0]))
        across = np.cross(self.vectors[0] / radius, self.start)
        angle = np.linspace(0.0, np.clip(self.angle, -MOST_OF_A_TURN, MOST_OF_A_TURN), 65)[:, None]
        return self.places[0] + radius * (np.cos(angle) * self.start + np.sin(angle) * across)

    def place(self, plotter: Any) -> None:
        """Add it to a plotter."""
        import pyvista

        if not len(self.places):
            return
        points = pyvista.PolyData(self.places)
        if self.solids in (Solids.ARROWS, Solids.COILS):
            lengths = np.linalg.norm(self.vectors, axis=1)
            points["length"], points["vector"] = lengths, unit(self.vectors)
            slim = 0.8 if len(self.places) == 1 else 1.0
            solid = _coil() if self.solids is Solids.COILS else pyvista.Arrow(
                start=(-0.5, 0, 0), tip_length=0.34 * slim, tip_radius=TIP * slim, shaft_radius=0.04 * slim,
                tip_resolution=32, shaft_resolution=24,
            )  # fmt: skip
            body = points.glyph(orient="vector", scale="length", factor=1.0, geom=solid)
        elif self.solids is Solids.TURNS:
            body = self._turn()
        elif self.solids is Solids.BARS:
            ends = np.stack([self.places - 0.5 * self.vectors, self.places + 0.5 * self.vectors], axis=1)
            body = polylines(ends).tube(radius=0.5 * self.width, n_sides=12)
        else:
            cube = self.solids is Solids.CUBES
            geometry = pyvista.Cube() if cube else pyvista.Sphere(theta_resolution=24, phi_resolution=24)
            body = points.glyph(orient=False, scale=False, factor=self.width, geom=geometry)
        plotter.add_mesh(
            body, color=self.colour, smooth_shading=self.solids is Solids.BALLS, ambient=0.62, specular=0.08
        )

    def _turn(self) -> Any:
        """The arc with a head, and the axis."""
        import pyvista

        arc, axis = self.arc, self.vectors[0]
        radius = float(np.linalg.norm(axis))
        head = 0.3 * radius
        shaft = arc[: max(2, int(np.searchsorted(-np.linalg.norm(arc - arc[-1], axis=1), -0.8 * head)))]
        along = unit((arc[-1] - shaft[-1])[None])[0]
        cone = pyvista.Cone(
            center=arc[-1] - 0.5 * head * along, direction=along, height=head, radius=0.4 * head, resolution=32
        )
        ends = np.stack([self.places[0] - axis, self.places[0] + axis])
        parts = [polylines(shaft[None]).tube(radius=0.045 * radius, n_sides=16)]
        parts += [polylines(ends[None]).tube(radius=0.02 * radius, n_sides=12), cone]
        return pyvista.merge([part.extract_surface(algorithm=None) for part in parts])


def _coil() -> Any:
    """A spring of length 1 along X1 about its middle."""
    import pyvista

    s = np.linspace(0.0, 1.0, 16 * COIL_TURNS + 1)
    radius = TIP * np.clip(10.0 * np.minimum(s, 1.0 - s), 0.0, 1.0)
    angle = 2.0 * np.pi * COIL_TURNS * s
    points = np.column_stack([s - 0.5, radius * np.cos(angle), radius * np.sin(angle)])
    return pyvista.Spline(points, 4 * len(points)).tube(radius=0.25 * TIP, n_sides=12)


def remanence_marks(model: Model, shown: FloatArray, axes: FloatArray, template: bool) -> list[Mark]:
    """Arrows of the remanence at the middles of some elements, on the side of the surface that is seen.

    Parameters
    ----------
    shown : FloatArray, shape (elements, 8, 3)
        Where the nodes of the elements are drawn, m.
    axes : FloatArray, shape (3, 3)
        Of the view.
    template : bool
        The remanence carried by the template instead of that of the undeformed part.
    """
    from magshell.magnetics.remanence.template import carried

    mesh = model.shell.mesh
    middle = centres(mesh.points, mesh.elements)[:, None]
    vectors = (carried if template else _released)(model.shell.overall_remanence, mesh, middle)[:, 0]
    sizes = np.linalg.norm(vectors, axis=1)
    if not sizes.any():
        return []
    middles = 0.5 * shown[:, 4:].sum(axis=1) - 0.25 * shown[:, :4].sum(axis=1)
    normals = np.cross(shown[:, 2] - shown[:, 0], shown[:, 3] - shown[:, 1])
    area = 0.5 * np.linalg.norm(normals, axis=1)
    normals = unit(normals) * np.where(normals @ axes[2] < 0.0, -1.0, 1.0)[:, None]
    bearing = np.flatnonzero(sizes > SAME * sizes.max())
    chosen = bearing[spread_out(middles[bearing], MOST_ARROWS)]
    size = float(np.linalg.norm(np.ptp(shown.reshape(-1, 3), axis=0)))
    length = np.clip(0.78 * np.sqrt(area[bearing].sum() / len(chosen)), SHORTEST * size, LONGEST * size)
    drawn = length * vectors[chosen] / sizes.max()
    out = np.abs((drawn * normals[chosen]).sum(axis=1))
    lifted = 0.5 * out + 0.12 * length * (1.0 - out / length)
    if not (template or model.shell.plain):
        heights = np.abs(model.shell.faces_at_nodes).max(axis=(1, 2))
        lifted += heights[chosen]
    name = show(float(sizes.max()), FLUX_DENSITY)
    if np.ptp(sizes[bearing]) > 1e-6 * sizes.max():
        name = f"up to {name}"
    return [
        Mark(f"remanence, {name}", REMANENCE, Solids.ARROWS, middles[chosen] + lifted[:, None] * normals[chosen], drawn)
    ]


def _released(remanence: Any, mesh: Any, points: FloatArray) -> FloatArray:
    return np.asarray(remanence(mesh, points))


def spread_out(points: FloatArray, most: int) -> IntArray:
    """Numbers of at most so many of the points (n, 3), evenly over all of them.

    One after the other as far from the rest as can be; then each moves into the middle of those nearest to it.
    """
    from scipy.spatial import cKDTree

    if len(points) <= most:
        return np.arange(len(points))
    chosen = [int(np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    distance = np.linalg.norm(points - points[chosen[0]], axis=1)
    while len(chosen) < most:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    seeds = points[chosen]
    tree = cKDTree(points)
    for _ in range(EVENING):
        owner = np.asarray(cKDTree(seeds).query(points)[1])
        count = np.bincount(owner, minlength=len(seeds))[:, None]
        total = np.stack([np.bincount(owner, points[:, axis], len(seeds)) for axis in range(3)], axis=1)
        seeds = np.where(count > 0, total / np.maximum(count, 1), seeds)
    return np.unique(np.asarray(tree.query(seeds)[1]))


def field_marks(model: Model, extent: FloatArray, axes: FloatArray) -> list[Mark]:
    """The field at the end of each stage, one arrow for each direction, to the left of everything."""
    ends = [model.course(stage).at(1.0).flux_density for stage in range(len(model.stages))]
    fields: list[tuple[int, FloatArray]] = []
    for stage, flux in enumerate(ends):
        new = all(np.abs(flux - other).max() > SAME * np.abs(other).max() for _, other in fields)
        if np.any(flux) and new:
            fields.append((stage, flux))
    if not fields:
        return []
    seen = extent @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = float(np.linalg.norm(high - low))
    strongest = max(float(np.linalg.norm(flux)) for _, flux in fields)
    vectors = np.array([0.2 * size * flux / strongest for _, flux in fields])
    across = float(np.max(vectors @ axes[0], initial=0.0))
    tail = np.array([low[0] - 0.06 * size - across, (low[1] + high[1]) / 2, high[2]]) @ axes
    tail = tail - 0.5 * vectors.mean(axis=0)
    several = len(fields) > 1
    where = "" if model.field.is_uniform else " at the centre"
    marks = []
    for (stage, flux), vector in zip(fields, vectors, strict=True):
        letter = f"$B_{{{stage + 1}}}$" if several else "$B$"
        name = f"field{f' {stage + 1}' if several else ''}{where}, {show(float(np.linalg.norm(flux)), FLUX_DENSITY)}"
        head = tail + 1.12 * vector
        marks.append(
            Mark(
                name, ACCENT, Solids.ARROWS, (tail + 0.5 * vector)[None], vector[None], letters=[(letter, head, (0, 0))]
            )
        )
    return marks


def support_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """Cubes or balls along the groups."""
    marks = []
    mesh = model.shell.mesh
    for number, support in enumerate(model.supports):
        nodes = model.shell.nodes_of(support.group)
        nodes = nodes[spread_out(mesh.points[nodes], MOST_POSTS)]
        width = min(0.016 * size, 0.7 * _closest(mesh.points[nodes]))
        solids = Solids[support.mark.upper()]
        wider = width if solids is Solids.CUBES else 0.85 * width
        name = f"{support.group}: {support.legend}"
        colour = SUPPORTS[number % len(SUPPORTS)]
        marks.append(Mark(name, colour, solids, mesh.points[nodes] + 0.3 * width * axes[2], width=wider))
    return marks


def spring_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """Coils that hang on the group, along the springs' direction or down in the picture."""
    marks, mesh = [], model.shell.mesh
    for number, spring in enumerate(model.springs, start=len(model.supports)):
        nodes = model.shell.nodes_of(spring.group)
        nodes = nodes[spread_out(mesh.points[nodes], MOST_OF_A_LOAD)]
        along = axes[1] if spring.along is None else unit(spring.along[None])[0]
        vectors = np.tile(0.09 * size * along, (len(nodes), 1))
        name, colour = f"{spring.group}: {spring.legend}", SUPPORTS[number % len(SUPPORTS)]
        marks.append(Mark(name, colour, Solids.COILS, mesh.points[nodes] - 0.56 * vectors, vectors))
    return marks


def body_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """Balls on the nodes of rigid bodies, and an arrow of its magnetic moment at each that has one."""
    marks, mesh, turned = [], model.shell.mesh, {one.group for one in model.supports}
    for number, body in enumerate(model.shell.rigid):
        nodes, colour = mesh.nodes_of(body.group), BODIES[number % len(BODIES)]
        if body.name not in turned:
            nodes = nodes[spread_out(mesh.points[nodes], MOST_POSTS)]
            width = min(0.014 * size, 0.7 * _closest(mesh.points[nodes]))
            places = mesh.points[nodes] + 0.3 * width * axes[2]
            marks.append(Mark(f"{body.name}: rigid body", colour, Solids.BALLS, places, width=width))
        strength = float(np.linalg.norm(body.moment))
        if strength:
            arrow = 0.13 * size * np.asarray(body.moment) / strength
            place = body.reference_point(mesh) + 0.5 * arrow + 0.02 * size * axes[2]
            name = f"{body.name}: magnetic moment, {show(strength, MAGNETIC_MOMENT)}"
            marks.append(Mark(name, REMANENCE, Solids.ARROWS, place[None], arrow[None]))
    return marks


def hinge_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """Bars along the edges."""
    marks = []
    for number, hinge in enumerate(model.shell.hinges):
        ends = model.shell.mesh.points[hinge.edges(model.shell.mesh)][:, [[0, 2], [2, 1]]].reshape(-1, 2, 3)
        name = f"{hinge.group}: hinge" + (f", {show(hinge.stiffness, HINGE_STIFFNESS)}" if hinge.stiffness else "")
        places, width = ends.mean(axis=1) + 0.003 * size * axes[2], 0.006 * size
        marks.append(Mark(name, HINGES[number % 2], Solids.BARS, places, ends[:, 1] - ends[:, 0], width))
    return marks


def repeated_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """Bars along the sides at which a repeated part meets its neighbours."""
    marks, mesh = [], model.shell.mesh
    for number, one in enumerate(model.shell.repeated):
        edges = [mesh.edge_groups[name] for name in (one.group, one.image) if name in mesh.edge_groups]
        if edges:
            ends = mesh.points[np.concatenate(edges)][:, [[0, 2], [2, 1]]].reshape(-1, 2, 3)
            places, width = ends.mean(axis=1) + 0.003 * size * axes[2], 0.007 * size
            name = f"{one.group}, {one.image}: {one.kind}"
            marks.append(Mark(name, HINGES[(number + 1) % 2], Solids.BARS, places, ends[:, 1] - ends[:, 0], width))
    return marks


def _closest(points: FloatArray) -> float:
    """Distance of a point (n, 3) to the next, in the mean over all; infinite for one alone."""
    from scipy.spatial import cKDTree

    return float(np.asarray(cKDTree(points).query(points, k=2)[0])[:, 1].mean()) if len(points) > 1 else np.inf


def load_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """One arrow for forces, moments and weight, several for what is spread; away from the eye they end on the part."""
    marks = []
    for load, forces in zip(model.loads, model.forces_at_rest, strict=True):
        places, vector, name = load.arrows(model.shell, forces)
        chosen = spread_out(places, MOST_OF_A_LOAD)
        places, vector = places[chosen], vector[chosen]
        longest = float(np.linalg.norm(vector, axis=1).max(initial=0.0))
        if longest == 0.0:
            continue
        drawn = (0.14 if len(places) == 1 else 0.07) * size * vector / longest
        away = drawn @ axes[2] < 0.0
        tails = places - np.where(away[:, None], drawn, 0.0)
        letter_at = tails[0] - 0.2 * drawn[0] if away[0] else tails[0] + 1.2 * drawn[0]
        marks.append(
            Mark(name, LOAD, Solids.ARROWS, tails + 0.5 * drawn, drawn, letters=[(load.letter, letter_at, (0, 0))])
        )
    return marks


def probe_marks(model: Model, size: float, axes: FloatArray) -> list[Mark]:
    """A ball at each probe, and a name at each of up to `MOST_NAMES`."""
    nodes = list(model.probe_nodes.values())
    if not nodes:
        return []
    places = model.shell.mesh.points[nodes]
    centre = model.shell.mesh.points.mean(axis=0)
    letters = []
    names = list(model.probe_nodes)
    for name, place in ((names[i], places[i]) for i in spread_out(places, MOST_NAMES)):
        away = (place - centre) @ axes[:2].T
        length = float(np.linalg.norm(away))
        direction = away / length if length > 1e-3 * size else np.array([0.0, 1.0])
        text = name.replace("$", r"\$")
        letters.append((text, place, (float(direction[0]), float(direction[1]))))
    return [Mark("probes", INK, Solids.BALLS, places + 0.01 * size * axes[2], width=0.016 * size, letters=letters)]
