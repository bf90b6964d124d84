"""The problem as immutable data: shell, supports, field, loads and their stages, probes; validated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import instance, on_groups, several
from magshell.arrays import AnyArray, FloatArray, IntArray, three_finite
from magshell.drawing import drawing
from magshell.errors import InputError, NothingLoads, suggest
from magshell.magnetics.deformation_gradient_energy import DeformationGradientEnergy
from magshell.magnetics.fields import Field, FieldUnknown, UniformField
from magshell.magnetics.fields.own import has_own
from magshell.magnetics.law import laws
from magshell.magnetics.micropolar_couple import MicropolarCouple
from magshell.model import coupling_limit, doubts, own_field_limit, symmetry
from magshell.model.constraints import Constraints, resolve
from magshell.model.course import Amounts, Course, Loading
from magshell.model.doubts.mesh_error import expected_error
from magshell.model.elastic import Anchored, ElasticSupport, check_names, reaction_name
from magshell.model.hinge_springs import hinge_springs
from magshell.model.linkage import check_linkage
from magshell.model.loads import Applied, Load
from magshell.model.loads.distribution import nodal_areas
from magshell.model.loads.mass import Mass, whole_mass
from magshell.model.named_supports import NamedSupport, named_supports
from magshell.model.parts import REST, Part
from magshell.model.places import Places
from magshell.model.rigid import FreeTurn, direction, free_turns
from magshell.model.rows import Rows, rows_of
from magshell.model.shell import Shell
from magshell.model.stages import Stage
from magshell.model.support import Support
from magshell.model.supports import mirror_planes
from magshell.model.turn import turned_bodies
from magshell.multipliers import amplitudes, numbers
from magshell.shell.state import State
from magshell.wording import place

NO_FIELD = UniformField((0.0, 0.0, 0.0))


@dataclasses.dataclass(frozen=True, eq=False)
class Model:
    """A shell, held by supports, in a field and under loads.

    Parameters
    ----------
    shell : Shell
    supports : sequence of Support
        `Clamp`, `SimpleSupport`, `SymmetryPlane`, `Prescribe`.
    field : Field, optional
        By default none.
    coupling : Coupling, optional
        Magnetic coupling law; by default the couple of the micropolar theory, or without micro-rotation the energy of
        the deformation gradient.
    probes : mapping of str to (3,) array_like, optional
        Reference positions of nodes to follow, m.
    loads : sequence of Load
        `Force`, `Moment`, `Traction`, `Pressure`, `Gravity`.
    stages : sequence of Stage, optional
        Parts of the load path in sequence; by default one under load control, or as many as the longest history has.
    local_axis : (3,) array_like, optional
        Direction whose projection on the undeformed surface is the first local axis of strains, stresses and
        resultants.
    outputs : sequence of str, optional
        Outputs of `magshell.evaluation.outputs` that files and pages hold beside those that they always do.
    springs : sequence of Spring or TorsionSpring, optional
        Elastic supports.

    Attributes
    ----------
    rows : Rows
        Rows of the nodal arrays.
    constraints : Constraints
        The supports, row by row.
    applied : tuple of Applied
        The loads, node by node.
    elastic : tuple of Anchored
        The springs, node by node.
    probe_nodes : mapping of str to int
    named_supports : tuple of NamedSupport
        The supports by the names of their reactions.
    turns : tuple of FreeTurn
        What supports let turn and the field alone holds, as a compass needle.

    Raises
    ------
    InputError
        Unknown groups, contradicting supports, a free rigid motion (named), probes that are not nodes, loads that make
        no sense, histories that do not fit the stages, or nothing that loads the shell.
    """

    shell: Shell
    supports: Sequence[Support]
    field: Field = NO_FIELD
    coupling: Any = None
    probes: Mapping[str, ArrayLike] = dataclasses.field(default_factory=dict)
    loads: Sequence[Load] = ()
    stages: Sequence[Stage] = ()
    local_axis: ArrayLike = (1.0, 0.0, 0.0)
    outputs: Sequence[str] = ()
    springs: Sequence[ElasticSupport] = ()
    rows: Rows = dataclasses.field(init=False, repr=False)
    constraints: Constraints = dataclasses.field(init=False, repr=False)
    applied: tuple[Applied, ...] = dataclasses.field(init=False, repr=False)
    elastic: tuple[Anchored, ...] = dataclasses.field(init=False, repr=False)
    probe_nodes: Mapping[str, int] = dataclasses.field(init=False, repr=False)
    named_supports: tuple[NamedSupport, ...] = dataclasses.field(init=False, repr=False)
    turns: tuple[FreeTurn, ...] = dataclasses.field(init=False, repr=False)
    _ends: tuple[Amounts, ...] = dataclasses.field(init=False, repr=False)

    def __post_init__(self) -> None:
        instance("model: shell", self.shell, Shell, "a Shell")
        mesh = self.shell.mesh
        put = object.__setattr__
        if not isinstance(self.field, Field):
            flux_density = "[…]" if three_finite(self.field) is None else self.field
            instance("model: field", self.field, Field, f"a field, for instance ms.UniformField({flux_density})")
        if self.coupling is None:
            put(self, "coupling", MicropolarCouple() if self.shell.micro_rotation else DeformationGradientEnergy())
        instance("model: coupling", self.coupling, tuple(laws()), "a coupling law, as ms.MicropolarCouple()")
        put(self, "supports", on_groups("model: supports", self.supports, Support, "a support, as ms.Clamp(…)"))
        put(self, "loads", on_groups("model: loads", self.loads, Load, "a load, as ms.Force(…)"))
        bodies = turned_bodies(self.shell.rigid, self.supports)
        if len(bodies) > len(self.shell.rigid):
            put(self, "shell", dataclasses.replace(self.shell, rigid=bodies))
        put(
            self,
            "stages",
            several("model: stages", self.stages, Stage, "a Stage") or (Stage(),) * self._longest_history(),
        )
        put(self, "local_axis", _direction("local_axis", self.local_axis))
        put(self, "outputs", several("model: outputs", self.outputs, str, "the name of an output"))
        put(self, "rows", rows_of(self.shell, mirror_planes(self.supports, self.shell.rigid)))
        places = Places(mesh, self.rows.carriers, tuple(self.shell.rigid), self.shell.periodic, self.shell.images)
        constraints = resolve(places, self.supports, len(self.stages))
        put(self, "constraints", self.rows.constraints(constraints))
        put(self, "named_supports", named_supports(self.shell, places, self.supports))
        put(self, "springs", on_groups("model: springs", self.springs, ElasticSupport, "a Spring or TorsionSpring"))
        put(self, "elastic", tuple(spring.applied(self.shell, places) for spring in self.springs))
        check_names(self.springs, [support.name for support in self.named_supports])
        put(self, "applied", tuple(load.applied(self.shell, self.rows) for load in self.loads))
        instance("model: probes", self.probes, Mapping, 'a mapping of names to positions, as {"tip": (x, y, z)}')
        nodes = {}
        for name, position in self.probes.items():
            try:
                nodes[name] = mesh.node_at(np.asarray(position, dtype=float))
            except InputError as error:
                raise InputError(f"probe '{name}': {error}") from None
        put(self, "probe_nodes", MappingProxyType(nodes))
        put(self, "_ends", self._amounts_at_the_ends())
        self._check_targets()
        normals, turned = self.rows.normals[: places.number], self._is_turned_from_the_start
        put(self, "turns", free_turns(places, normals, constraints, self.elastic, turned))
        self._check_turns()
        check_linkage(self.shell, self.rows, self.constraints, self.elastic, hinge_springs(self.shell, self.rows))
        self._check_the_micro_rotation_matters()
        self._check_something_loads()
        for fault in symmetry.broken(self):
            symmetry.logger.warning("%s", fault)
        for fault in coupling_limit.reached(self.shell, self.coupling, self.largest_field):
            coupling_limit.logger.warning("%s", fault)
        for fault in own_field_limit.reached(self.shell, self.field):
            own_field_limit.logger.warning("%s", fault)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "probe_nodes": dict(self.probe_nodes)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, probe_nodes=MappingProxyType(state["probe_nodes"]))

    def __repr__(self) -> str:
        parts = (self.shell, self.field, self.coupling, *self.loads, *self.supports, *self.springs)
        return "\n  ".join([f"Model({len(self.stages)} stages, {len(self.probes)} probes)", *map(repr, parts)])

    def _repr_html_(self) -> str:
        return str(drawing("model_html")(self))

    def doubts(self) -> list[str]:
        """Likely slips, a sentence each, as `magshell check` prints them; an empty list if none is found."""
        return doubts.doubts(self)

    @property
    def expected_error(self) -> float | None:
        """Relative discretisation error of the largest displacement, by a rule of thumb (0.01: about 1 %).

        None for element types that the rule does not hold for (`magshell.model.doubts.mesh_error`). It is an upper
        estimate; to know the error, solve on a mesh with elements of half the size.
        """
        return expected_error(self)

    @property
    def _is_turned_from_the_start(self) -> bool:
        """Whether a field acts on magnets in the first stage."""
        magnetised = self.shell.magnetised or any(np.any(body.moment) for body in self.shell.rigid)
        return magnetised and bool(np.any(self._ends[1].drives)) and self.largest_field > 0.0

    def _check_turns(self) -> None:
        """Refuse rotations about a uniform field, which it does not resist."""
        for number in range(len(self.stages)) if self.turns and isinstance(self.field, UniformField) else ():
            B = self.course(number).at(1.0).flux_density
            along = max(float(np.linalg.norm(turn.axes @ B)) for turn in self.turns)
            if np.any(B) and along > (1.0 - 1e-9) * np.linalg.norm(B):
                at_the_end = f" at the end of stage {number + 1}" if len(self.stages) > 1 else ""
                raise InputError(
                    f"supports: the body can turn about {direction(B)}, the direction of the field{at_the_end}, "
                    "and the field does not resist that. Hold this rotation by a support or a spring; the field holds "
                    "the others"
                )

    def _check_targets(self) -> None:
        for stage in self.stages:
            if stage.probe is None or stage.component is None:
                continue
            where = f"stage '{stage.name}'"
            if stage.probe not in self.probe_nodes:
                raise InputError(f"{where}: probe '{stage.probe}' is unknown. {suggest(stage.probe, self.probe_nodes)}")
            if self.constraints.fixed[self.probe_nodes[stage.probe], stage.component - 1]:
                raise InputError(f"{where}: u{stage.component} of probe '{stage.probe}' is held by a support")

    def _check_the_micro_rotation_matters(self) -> None:
        mesh = self.shell.mesh
        tied = self.shell.mean_of("coupling_modulus") > 0.0
        if tied.all():
            return
        loose = np.ones(len(mesh.points), dtype=bool)
        loose[mesh.elements[tied]] = False
        for part in self.shell.parts:
            elements = part.elements[~tied[part.elements]]
            if not elements.size or not (worker := self._works_on_micro_rotation(part, elements, loose)):
                continue
            if not self.shell.micro_rotation:
                raise InputError(f"shell: {worker} works on the micro-rotation, which this shell does not have")
            where = "material" if part.name == REST else f"region '{part.name}': material"
            raise InputError(
                f"{where}: coupling_modulus is 0, so the micro-rotation that {worker} works on "
                "never reaches the deformation; leave it out (it is then the shear modulus), or write a larger one"
            )

    def _works_on_micro_rotation(self, part: Part, elements: IntArray, loose: AnyArray) -> str:
        """What works on the micro-rotation of a part at nodes where nothing ties it to the deformation; or nothing."""
        nodes = np.zeros(len(self.shell.mesh.points), dtype=bool)
        nodes[self.shell.mesh.elements[elements]] = True
        nodes &= loose
        pairs = [one for applied in self.applied for one in applied.pairs]
        if any(one.row_field == "omega" and nodes[one.rows].any() for one in pairs):
            return "a moment"
        if any(one.column_field == "omega" and nodes[one.columns].any() for one in pairs):
            return "a follower"
        field = self.fields_act and not isinstance(self.coupling, DeformationGradientEnergy)
        if field and (len(self.shell.parts) == 1 or np.any(part.remanence)):
            return type(self.coupling).__name__
        return ""

    def _check_something_loads(self) -> None:
        if any(np.any(amounts.held) or np.any(amounts.loads) for amounts in self._ends):
            return
        otherwise = "and no support moves, nor is there a load: nothing loads the shell"
        if not self.fields_act:
            raise NothingLoads(f"field: flux_density is zero {otherwise}")
        if not self.shell.magnetised and not any(np.any(body.moment) for body in self.shell.rigid):
            raise NothingLoads(f"remanence: it is zero everywhere {otherwise}")

    @cached_property
    def forces_at_rest(self) -> tuple[FloatArray, ...]:
        """Forces (nodes, 11) of each load on the undeformed shell, at multiplier 1."""
        nodes = len(self.rows.of)
        state = State.undeformed(nodes, len(self.shell.mesh.elements), self.shell.element.vectors)
        return tuple(applied.forces(state) for applied in self.applied)

    @cached_property
    def mass(self) -> Mass:
        """Mass (`total`, kg) and `centroid` (m) of the undeformed shell.

        Raises
        ------
        InputError
            The shell has no density.
        """
        return whole_mass(self.shell, self.rows)

    @property
    def reactions(self) -> tuple[str, ...]:
        """Names of the reactions: of supports, then of springs."""
        return (*(support.name for support in self.named_supports), *map(reaction_name, self.springs))

    @property
    def largest_field(self) -> float:
        """Largest magnitude of the field along the path, T; of one that varies, at the nodes and the stages' ends."""
        if isinstance(self.field, UniformField):
            return max(abs(float(amounts.drives[0])) for amounts in self._ends) * self.field.magnitude
        return self._largest_at_nodes

    @property
    def fields_act(self) -> bool:
        """Whether there is an applied field, or that of the body itself acts on it."""
        return self.largest_field > 0.0 or has_own(self.field)

    @property
    def field_magnitude(self) -> float:
        """Of a uniform field, T, at multiplier 1; of one that varies, the largest at the nodes along the path."""
        return self.field.magnitude if isinstance(self.field, UniformField) else self.largest_field

    @cached_property
    def _largest_at_nodes(self) -> float:
        points, largest = self.shell.mesh.points, 0.0
        for amounts in self._ends:
            try:
                B = self.field.at(amounts.drives, points, second=False).flux_density
            except FieldUnknown as unknown:
                where = "field"
                if unknown.position is not None:
                    node = int(np.argmin(np.linalg.norm(points - unknown.position, axis=1)))
                    where = f"field: at node {node} of the undeformed shell"
                raise InputError(f"{where}: {unknown}") from None
            if not np.isfinite(B).all():
                node = int(np.argmin(np.isfinite(B).all(axis=1)))
                raise InputError(f"field: it is not finite at node {node}, at {place(points[node])}")
            largest = max(largest, float(np.linalg.norm(B, axis=1).max()))
        return largest

    @cached_property
    def _centre(self) -> FloatArray:
        """Centre of area of the undeformed shell (3,), m."""
        areas = nodal_areas(self.shell, np.arange(len(self.shell.mesh.elements)))
        return np.asarray(areas @ self.shell.mesh.points / areas.sum())

    def _longest_history(self) -> int:
        histories = [(one, getattr(one, "history", None)) for one in (*self.loads, *self.supports)]
        lengths = [len(numbers(given, type(one).__name__)) for one, given in histories if given is not None]
        return max([self.field.stages, *lengths])

    def _amounts_at_the_ends(self) -> tuple[Amounts, ...]:
        """What varies along the path, undeformed and at the end of each stage."""
        count = len(self.stages)
        drives = self.field.ends(count)
        loads = np.zeros((count + 1, len(self.loads)))
        for number, load in enumerate(self.loads):
            loads[1:, number] = amplitudes(load.history, count, load.label)
        held = np.concatenate([np.zeros_like(self.constraints.values[:1]), self.constraints.values])
        return tuple(Amounts(drives[k], loads[k], held[k]) for k in range(count + 1))

    def course(self, stage: int, start: Amounts | None = None) -> Course:
        """The loading of a stage that starts from given amounts; by default from where histories put its start."""
        return Course(self.stages[stage], self.field, start or self._ends[stage], self._ends[stage + 1], self._centre)

    def loading(self, load_factor: float) -> Loading:
        """The loading in the first stage."""
        return self.course(0).at(load_factor)

    @property
    def normals(self) -> FloatArray:
        """Unit normals (nodes, 3) of the undeformed mid-surface, averaged over the elements of a node.

        On a mirror plane they lie in it, as the average with the mirror image does, unless the shell touches the plane.
        At a joint they are those of one of its sheets; `rows` has all.
        """
        return self.rows.normals[: self.rows.nodes]


def _direction(where: str, value: ArrayLike) -> FloatArray:
    """A direction as three numbers."""
    direction = three_finite(value)
    if direction is None or not direction.any():
        raise InputError(f"{where} is {value!r}; it must be three finite numbers, not all zero")
    return direction
