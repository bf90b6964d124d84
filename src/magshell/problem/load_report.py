"""Mechanical loads in words: what each is and adds up to, how strong they are together, and doubts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from magshell.model.loads.distribution import nodal_areas
from magshell.problem import schema
from magshell.problem.building import Problem
from magshell.problem.wording import counted, quantity
from magshell.shell.state import State
from magshell.units import ACCELERATION, FORCE, MOMENT, STRESS, show


@dataclass(frozen=True)
class Strength:
    """Sums of the loads' largest magnitudes, each over the path, against the stiffness of the shell.

    Attributes
    ----------
    force : float
        Forces and tractions, N.
    moment : float
        N m.
    weight : float
        N.
    pressure : float
        Pa.
    extent, thickness, youngs_modulus : float
        L, h (m) and E (Pa).
    """

    force: float
    moment: float
    weight: float
    pressure: float
    extent: float
    thickness: float
    youngs_modulus: float

    @property
    def bending(self) -> float:
        """12 (F L + M) / (E h³): a square plate bends visibly from about 0.1."""
        return self._bending(self.force + self.moment / self.extent)

    @property
    def weight_bending(self) -> float:
        """12 W L / (E h³), for a square plate 12 rho g L³ / (E h²): its visible bending as above."""
        return self._bending(self.weight)

    @property
    def stretching(self) -> float:
        """p L / (E h): a balloon of diameter L is strained by a quarter of it, times 1 - nu."""
        return self.pressure * self.extent / (self.youngs_modulus * self.thickness)

    @property
    def overall(self) -> float:
        """12 (F L + M + W L + p L³) / (E h³)."""
        return self.bending + self.weight_bending + self._bending(self.pressure * self.extent**2)

    def _bending(self, force: float) -> float:
        return 12.0 * force * self.extent / (self.youngs_modulus * self.thickness**3)


def strength(problem: Problem, extent: float, youngs_modulus: float) -> Strength:
    """The loads of a problem, in numbers."""
    sums = {"force": 0.0, "moment": 0.0, "traction": 0.0, "gravity": 0.0, "pressure": 0.0}
    for number, table in enumerate(problem.file.loads):
        peak = max(map(abs, table.history or (1.0,)))
        match table:
            case schema.PressureTable():
                magnitude = abs(table.pressure)
            case schema.ForceTable() | schema.MomentTable():
                magnitude = float(np.linalg.norm(table.total))
            case _:
                magnitude = float(np.linalg.norm(_resultant(problem, number)))
        sums[table.kind] += peak * magnitude
    return Strength(
        force=sums["force"] + sums["traction"],
        moment=sums["moment"],
        weight=sums["gravity"],
        pressure=sums["pressure"],
        extent=extent,
        thickness=problem.model.shell.thickness,
        youngs_modulus=youngs_modulus,
    )


def lines(problem: Problem, strong: Strength) -> Iterator[tuple[str, str]]:
    """Label and text for each load, and for the dimensionless numbers."""
    for number, table in enumerate(problem.file.loads):
        text = _text(problem, number, table)
        if table.history is not None:
            text += f", times {', '.join(f'{each:g}' for each in table.history)} at the ends of the stages"
        yield table.group or "whole shell", text
    if strong.force or strong.moment:
        yield "12 (F L + M) / (E h³)", f"{strong.bending:.4g}"
    if strong.weight:
        yield "12 W L / (E h³)", f"{strong.weight_bending:.4g} with the weight W"
    if strong.pressure:
        yield "p L / (E h)", f"{strong.stretching:.4g}"


def _text(problem: Problem, number: int, table: schema.Load) -> str:
    mesh = problem.model.shell.mesh
    match table:
        case schema.ForceTable() | schema.MomentTable():
            dimension = FORCE if table.kind == "force" else MOMENT
            turning = ", turns with the micro-rotation" if table.follower else ""
            nodes = counted(len(mesh.nodes_of(table.group)), "node")
            return f"{table.kind} {quantity(table.total, dimension)}, {nodes}{turning}"
        case schema.TractionTable():
            total = quantity(_resultant(problem, number), FORCE)
            elements = counted(len(mesh.elements_of(table.group)), "element")
            return f"traction {quantity(table.traction, STRESS)}, {elements}, in all {total}"
        case schema.PressureTable():
            members = mesh.elements_of(table.group)
            force = table.pressure * float(nodal_areas(problem.model.shell, members).sum())
            side = "along" if table.pressure > 0.0 else "against"
            return (
                f"pressure {show(table.pressure, STRESS)}, {side} the normal of {counted(len(members), 'element')}, "
                f"at first {show(abs(force), FORCE)} on their area"
            )
        case schema.GravityTable():
            weight = quantity(_resultant(problem, number), FORCE)
            return f"gravity {quantity(table.acceleration, ACCELERATION)}, weight {weight}"


def _resultant(problem: Problem, number: int) -> tuple[float, ...]:
    """Sum of the forces of a dead load, N, without the round-off of components that are meant to be 0."""
    shell = problem.model.shell
    state = State.undeformed(len(shell.mesh.points), len(shell.mesh.elements), shell.element.vectors)
    total = problem.model.applied[number].forces(state)[:, :3].sum(axis=0)
    return tuple(np.where(np.abs(total) > 1e-9 * np.abs(total).max(), total, 0.0).tolist())


def doubts(problem: Problem, strong: Strength) -> Iterator[str]:
    """Magnitudes that no experiment has, most often a slip of units."""
    density = problem.model.shell.density
    if density is not None and not 10.0 <= density <= 25e3:
        what = "lighter than a foam" if density < 10.0 else "heavier than any metal"
        yield f"the density is {density:.3g} kg/m^3: {what}; check shell.density"
    if density is not None and not strong.weight:
        yield "there is a density but no gravity: the density does nothing"
    beyond = "beyond any experiment; check the units"
    if strong.bending > 1e5:
        yield f"12 (F L + M) / (E h³) is {strong.bending:.2g}: loads {beyond}"
    if strong.weight_bending > 1e5:
        yield f"12 W L / (E h³) is {strong.weight_bending:.2g}: a weight {beyond}"
    if strong.stretching > 1e3:
        yield f"p L / (E h) is {strong.stretching:.2g}: a pressure {beyond}"
    moved = any(table.kind == "prescribe" and np.any(table.value) for table in problem.file.supports)
    if problem.file.loads and not any(problem.file.field.flux_density) and not moved and strong.overall < 1e-3:
        yield f"12 (F L + M + W L + p L³) / (E h³) is {strong.overall:.2g}: the shell will hardly move; check the units"
