"""What the two elements are compared on: models on sequences of meshes, and the displacements that are read off."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

import magshell as ms
from magshell import problem
from magshell.mesh import Mesh
from magshell.model.loads import Force
from magshell.problem.building import build

MEMBERS = ("quadratic", "paper")
Divisions = tuple[int, int]


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A displacement at one load.

    Attributes
    ----------
    name : str
        In tables and pictures.
    load : float
        Load factor.
    probe : str
    component : int
        1, 2 or 3.
    scale : float
        What the displacement is multiplied by for tables.
    unit : str
    independent : str
        Values of other theories or programs, with what they are; "" where there are none.
    """

    name: str
    load: float
    probe: str
    component: int
    scale: float
    unit: str
    independent: str = ""


@dataclasses.dataclass(frozen=True)
class Case:
    """A model on a sequence of meshes.

    Attributes
    ----------
    name, title : str
    model : callable
        From divisions and element type to a model.
    meshes : mapping of str to sequence of (int, int)
        Divisions for each member, coarse to fine.
    quantities : sequence of Quantity
        In the order of their loads.
    released : callable, optional
        The model to settle at the end of the path without the support that has led it there.
    """

    name: str
    title: str
    model: Callable[[Divisions, Any, Sequence[float]], ms.Model]
    meshes: Mapping[str, Sequence[Divisions]]
    quantities: Sequence[Quantity]
    released: Callable[[Divisions, Any, Sequence[float]], ms.Model] | None = None

    @property
    def stops(self) -> list[float]:
        """Load factors that a solve must hit, the end included."""
        return sorted({quantity.load for quantity in self.quantities})


# -- the built-in problems -------------------------------------------------------------------------------------------


def built_in(name: str, divisions: Divisions, element: Any, stops: Sequence[float]) -> ms.Model:
    """A built-in problem on another mesh, with another element, up to the last of the stops (T)."""
    source, file = problem.read(name)
    if hasattr(file.mesh, "blocks"):
        centre = file.mesh.blocks["centre"].elements[0]
        blocks = {
            key: block.model_copy(update={"elements": tuple(n * divisions[0] // centre for n in block.elements)})
            for key, block in file.mesh.blocks.items()
        }
        mesh = file.mesh.model_copy(update={"blocks": blocks})
    else:
        mesh = file.mesh.model_copy(update={"elements": divisions})
    direction = np.array(file.field.flux_density) / np.linalg.norm(file.field.flux_density)
    field = file.field.model_copy(update={"flux_density": tuple(stops[-1] * direction), "stops": tuple(stops)})
    model = build(file.model_copy(update={"mesh": mesh, "field": field}), source).model
    return dataclasses.replace(model, shell=dataclasses.replace(model.shell, element=element))


def built_in_case(
    name: str, title: str, fields: Sequence[float], meshes: Mapping[str, Sequence[Divisions]],
    quantity: Callable[[float], Quantity],
) -> Case:  # fmt: skip
    """A case of a built-in problem, read at fields in mT."""
    stops = [1e-3 * field for field in fields]

    def model(divisions: Divisions, element: Any, wanted: Sequence[float]) -> ms.Model:
        return built_in(name, divisions, element, [factor * stops[-1] for factor in wanted])

    quantities = [dataclasses.replace(quantity(field), load=field / fields[-1]) for field in fields]
    return Case(name, title, model, meshes, quantities)


PUMP_END = 150e-3
"""T."""


def pump_at_its_end(divisions: Divisions, element: Any, _: Sequence[float]) -> ms.Model:
    """The pump at 150 mT."""
    return built_in("pump", divisions, element, [PUMP_END])


def pump_led(divisions: Divisions, element: Any, _: Sequence[float]) -> ms.Model:
    """The same, led there by a displacement of B: under the field alone the path turns back at 33 mT, and again."""
    free = pump_at_its_end(divisions, element, ())
    radius = free.shell.mesh.points[free.probe_nodes["B"], 0]
    shell = dataclasses.replace(free.shell, mesh=free.shell.mesh.select_nodes("side", x1=radius, x2=0.0, x3=0.0))
    return dataclasses.replace(free, shell=shell, supports=[*free.supports, ms.Prescribe("side", "u", 1, -16.6e-3)])


# -- problems of Sze, Liu and Lo -------------------------------------------------------------------------------------


def classical(young: float, poisson: float, thickness: float, length_scale: float) -> ms.MicropolarNeoHookean:
    """The law that is linear elasticity at small strains, but for its couple stress."""
    mu = young / (2.0 * (1.0 + poisson))
    lame = 2.0 * mu * poisson / (1.0 - 2.0 * poisson)
    return ms.MicropolarNeoHookean(mu, lame, mu / 10.0, length_scale * thickness)


def moved(mesh: Mesh, points: np.ndarray) -> Mesh:
    """The same mesh at other places."""
    return Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)


def cantilever(divisions: Divisions, element: Any, _: Sequence[float], length_scale: float = 0.1) -> ms.Model:
    """Strip of length 10, width 1 and thickness 0.1 under a shear force at its end."""
    mesh = ms.mesh.rectangle(10.0, 1.0, divisions)
    shell = ms.Shell(mesh, 0.1, classical(1.2e6, 0.0, 0.1, length_scale), element=element)
    loads = [Force("right", (0.0, 0.0, 4.0))]
    return ms.Model(shell, [ms.Clamp("left")], probes={"tip": (10.0, 0.0, 0.0)}, loads=loads)


def hemisphere(divisions: Divisions, element: Any, _: Sequence[float], length_scale: float = 0.1) -> ms.Model:
    """Quarter of a hemisphere with a hole of 18°, pulled outward along X1 and pushed inward along X2."""
    radius, force = 10.0, 200.0
    mesh = ms.mesh.sphere_patch(radius, (18, 90), (0, 90), divisions)
    mesh = mesh.select_nodes("out", x1=radius).select_nodes("in", x2=radius)
    shell = ms.Shell(mesh, 0.04, classical(6.825e7, 0.3, 0.04, length_scale), element=element)
    supports = [
        ms.SymmetryPlane("left", (0, 1, 0)),
        ms.SymmetryPlane("right", (1, 0, 0)),
        ms.Prescribe("out", "u", 3, 0.0),
    ]
    loads = [Force("out", (force, 0.0, 0.0)), Force("in", (0.0, -force, 0.0))]
    probes = {"out": (radius, 0.0, 0.0), "in": (0.0, radius, 0.0)}
    return ms.Model(shell, supports, probes=probes, loads=loads)


def annulus(divisions: Divisions, element: Any, _: Sequence[float], length_scale: float = 0.1) -> ms.Model:
    """Ring plate, slit along a radius; one side of the slit is clamped, the other lifted by a line force.

    The slit is 1e-3 rad wide, so that its sides are seen to be two.
    """
    inner, outer, slit = 6.0, 10.0, 1e-3
    plain = ms.mesh.rectangle(1.0, 1.0, divisions)
    turn = (2.0 * np.pi - slit) * plain.points[:, 0]
    radius = outer - (outer - inner) * plain.points[:, 1]
    mesh = moved(plain, np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros_like(turn)]))
    shell = ms.Shell(mesh, 0.03, classical(21e6, 0.0, 0.03, length_scale), element=element)
    loads = [Force("right", (0.0, 0.0, 0.8 * (outer - inner)))]
    end = np.array([np.cos(slit), -np.sin(slit), 0.0])
    return ms.Model(shell, [ms.Clamp("left")], probes={"A": inner * end, "B": outer * end}, loads=loads)


# -- all of them -----------------------------------------------------------------------------------------------------


def multiples(one: Divisions, *factors: int) -> list[Divisions]:
    """Divisions along both directions times each factor."""
    return [(one[0] * factor, one[1] * factor) for factor in factors]


STRIPS = {
    "strip-10": (10, 11e-3, ".0886, .3769, .7543"),
    "strip-17": (17.5, 19.2e-3, ".2594, .6728, .8652"),
    "strip-20": (20.5, 17.2e-3, ".3342, .7265, .8833"),
    "strip-41": (41, 17.2e-3, ".6783, .8659, .9394"),
}
"""Length over thickness; length, m; tip deflection over length at 2, 10, 50 mT by a 3D micropolar program."""


def cases() -> list[Case]:
    """Everything that is compared."""
    solid = "3D micropolar {}"
    gripper = built_in_case(
        "gripper", "gripper, $u_3$ at B", (0.02, 1.0, 4.0, 10.0),
        {"quadratic": multiples((4, 1), 2, 3, 4, 6, 8), "paper": multiples((4, 1), 2, 4, 6, 8, 12, 16)},
        lambda field: Quantity(
            f"{field:g} mT", field, "B", 3, 1e3, "mm", solid.format(".3647") if field == 0.02 else "",
        ),
    )  # fmt: skip
    pump_meshes = {"quadratic": multiples((6, 5), 1, 2, 3, 4), "paper": multiples((6, 5), 1, 2, 4, 8)}
    pump = built_in_case(
        "pump", "pump, $u_1$ at B", (1.0, 20.0), pump_meshes,
        lambda field: Quantity(
            f"{field:g} mT", field, "B", 1, -1e3, "mm", "analytic linear shell .2057" if field == 1.0 else "",
        ),
    )  # fmt: skip
    pump_end = Case(
        "pump-150", pump.title, pump_led,
        {"quadratic": multiples((6, 5), 1, 2, 3, 4), "paper": multiples((6, 5), 1, 2, 4, 6)},
        [Quantity("150 mT", 1.0, "B", 1, -1e3, "mm")], released=pump_at_its_end,
    )  # fmt: skip
    strips = [
        built_in_case(
            name, f"strip of aspect ratio {ratio:g}, tip", (2.0, 10.0, 50.0),
            {"quadratic": multiples((2, 1), 1, 2, 4, 8), "paper": multiples((2, 1), 1, 2, 4, 8, 16)},
            lambda field, length=length, values=values: Quantity(
                f"{field:g} mT", field, "tip", 3, 1.0 / length, "L",
                solid.format(values.split(", ")[(2.0, 10.0, 50.0).index(field)]),
            ),
        )
        for name, (ratio, length, values) in STRIPS.items()
    ]  # fmt: skip
    cross = built_in_case(
        "thin-cross", "thin cross, $u_3$ at A", (2.0, 40.0),
        {"quadratic": multiples((1, 4), 1, 2, 3, 4, 6), "paper": multiples((1, 4), 1, 2, 4, 6, 9)},
        lambda field: Quantity(
            f"{field:g} mT", field, "A", 3, 1e3, "mm", solid.format("9.301" if field == 2.0 else "22.720"),
        ),
    )  # fmt: skip
    published = [
        Case(
            "cantilever", "cantilever with end shear, $u_3$ at the tip", cantilever,
            {"quadratic": multiples((4, 1), 1, 2, 3, 4), "paper": multiples((4, 1), 1, 2, 4, 6, 10)},
            [Quantity("tip", 1.0, "tip", 3, 1.0, "", "Sze et al. 6.698")],
        ),
        Case(
            "hemisphere", "hemisphere with a hole, $-u_2$ where it is pushed", hemisphere,
            {"quadratic": multiples((4, 4), 1, 2, 3, 4), "paper": multiples((4, 4), 1, 2, 3, 4, 6)},
            [Quantity("pushed point", 1.0, "in", 2, -1.0, "", "Sze et al. 8.178")],
        ),
        Case(
            "annulus", "slit annulus, $u_3$ at the outer corner", annulus,
            {"quadratic": multiples((10, 2), 1, 2, 3), "paper": multiples((10, 2), 1, 2, 3, 4)},
            [Quantity("outer corner", 1.0, "B", 3, 1.0, "", "Sze et al. 17.528")],
        ),
    ]  # fmt: skip
    return [gripper, pump, pump_end, *strips, cross, *published]


SMALL_LENGTH_SCALE = {name: partial(model, length_scale=0.01) for name, model in (
    ("cantilever", cantilever), ("hemisphere", hemisphere), ("annulus", annulus),
)}  # fmt: skip
"""The published problems with a tenth of the length scale, h/100: next to no couple stress."""
