"""What a path's history holds of each step: every number that `history.csv`, tables and curves show, named once.

A new one is one entry in `SERIES`. Field, probes and what only the path knows stand before them in the files.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from magshell.evaluation import maxima
from magshell.evaluation.converged import Converged
from magshell.magnetics.fields import SelfField
from magshell.magnetics.law import is_conservative
from magshell.model.model import Model
from magshell.shell.point import INTERNAL, MAGNETIC

Number = float | None


@dataclass(frozen=True)
class Series:
    """Numbers of a state that belong together.

    Attributes
    ----------
    name : str
        In menus.
    unit : str
        SI, empty for a pure number.
    sentence : str
        What they are.
    columns : callable
        From the model to the names of the columns.
    evaluate : callable
        From what has converged to as many numbers; None where there is none, which stays empty.
    curves : bool
        Whether they make curves.
    """

    name: str
    unit: str
    sentence: str
    columns: Callable[[Model], Sequence[str]]
    evaluate: Callable[[Converged], Sequence[Number]]
    curves: bool = True


def _of_supports(letter: str) -> Callable[[Model], Sequence[str]]:
    return lambda model: [f"{name}.{letter}{i}" for name in model.reactions for i in (1, 2, 3)]


def _magnetic(converged: Converged) -> Number:
    if not is_conservative(converged.discretisation.model.coupling):
        return None
    magnets = converged.discretisation.dipoles.energy(converged.state, converged.loading)
    return float(converged.energies[:, MAGNETIC].sum()) + magnets


def _varies(converged: Converged) -> bool:
    return not converged.discretisation.model.field.is_uniform


def _of_sources(model: Model) -> list[str]:
    """Columns of the parts of a field that varies, by the names that their amounts have."""
    if model.field.is_uniform:
        return []
    parts = dict.fromkeys(drive.rpartition(".")[0] for drive in model.field.drives if drive not in SelfField.drives)
    return [f"{part}.{letter}{i}" for part in parts for letter in ("F", "T") for i in (1, 2, 3)]


def _turning(model: Model) -> dict[str, int]:
    """Angles among the amounts of a uniform field that turns, and their numbers."""
    if not model.field.is_uniform:
        return {}
    ends = model.field.ends(len(model.stages))
    return {name: i for i, name in enumerate(model.field.drives) if name.endswith(".angle") and ends[:, i].any()}


def _has_springs(model: Model) -> bool:
    return bool(model.springs) or any(hinge.stiffness for hinge in model.shell.hinges)


def _of_bodies(model: Model, *letters: str) -> list[str]:
    return [f"{body.name}.{letter}{i}" for body in model.shell.rigid for letter in letters for i in (1, 2, 3)]


def _largest(name: str, unit: str, sentence: str, quantities: Sequence[str]) -> Series:
    columns = [maxima.value_column(quantity) for quantity in quantities]
    return Series(
        name,
        unit,
        f"{sentence} over the nodes and both faces: {' and '.join(f'`{column}`' for column in columns)}.",
        lambda model: columns,
        lambda converged: maxima.values(converged, quantities),
    )


SERIES: dict[str, Series] = {
    series.name: series
    for series in (
        Series(
            "reaction force",
            "N",
            "Force that a support or spring exerts on the shell: `NAME.R1`, `R2`, `R3`.",
            _of_supports("R"),
            lambda converged: [float(number) for one in converged.reactions for number in one.force],
        ),
        Series(
            "reaction moment",
            "N m",
            "Moment that it exerts, about its centroid or its `point`: `NAME.M1`, `M2`, `M3`.",
            _of_supports("M"),
            lambda converged: [float(number) for one in converged.reactions for number in one.moment],
        ),
        Series(
            "energy",
            "J",
            "Elastic energy of the shell (`elastic`), magnetic energy where the coupling law has one (`magnetic`).",
            lambda model: ["elastic", "magnetic"],
            lambda converged: [float(converged.energies[:, INTERNAL].sum()), _magnetic(converged)],
        ),
        Series(
            "work",
            "J",
            "Work along the path of loads and moving supports (`work`) and, where the coupling law has no energy, of "
            "the field (`work_field`), by the trapezoidal rule over the steps.",
            lambda model: ["work", "work_field"],
            lambda converged: [None, None] if converged.work is None else list(converged.work),
        ),
        Series(
            "magnetic torque",
            "N m",
            "Total torque of the field on the shell: `torque1`, `torque2`, `torque3`.",
            lambda model: ["torque1", "torque2", "torque3"],
            lambda converged: [float(number) for number in converged.magnetic_torque],
        ),
        _largest("largest stress", "Pa", "Largest von Mises and principal stress", ("von_mises", "principal_stress")),
        _largest("largest strain", "", "Largest principal logarithmic strain", ("principal_strain",)),
        Series(
            "places of the largest",
            "",
            "Node, element and face (1: upper, -1: lower) of these: `.node`, `.element`, `.face` behind their names.",
            lambda model: maxima.place_columns(),
            maxima.places,
            curves=False,
        ),
        Series(
            "energy of springs",
            "J",
            "Energy of all springs (`springs`), if there are any.",
            lambda model: ["springs"] if _has_springs(model) else [],
            lambda converged: [converged.spring_energy] if _has_springs(converged.discretisation.model) else [],
        ),
        Series(
            "amounts of the field",
            "",
            "Of a field that varies in space: multiplier, displacement (`d1`, `d2`, `d3`, m) and `angle` (rad) of each "
            "of its parts.",
            lambda model: list(model.field.drives) if not model.field.is_uniform else [],
            lambda converged: converged.loading.drives.tolist() if _varies(converged) else [],
        ),
        Series(
            "force on sources",
            "",
            "Force on each part of a field that varies (`PART.F1`, `F2`, `F3`, N) and torque about its middle "
            "(`PART.T1`, `T2`, `T3`, N m).",
            lambda model: _of_sources(model),
            lambda converged: converged.source_forces.ravel().tolist() if _varies(converged) else [],
        ),
        Series(
            "motion of rigid bodies",
            "",
            "Displacement of the reference point of a rigid body (`NAME.u1`, `u2`, `u3`, m) and its rotation vector, "
            "of magnitude at most π (`NAME.theta1`, `theta2`, `theta3`, rad).",
            lambda model: _of_bodies(model, "u", "theta"),
            lambda converged: [number for motion in converged.body_motions for number in motion.ravel().tolist()],
        ),
        Series(
            "force of rigid bodies",
            "",
            "Force that a rigid body exerts on the shell (`NAME.F1`, `F2`, `F3`, N), and moment about its reference "
            "point (`NAME.T1`, `T2`, `T3`, N m).",
            lambda model: _of_bodies(model, "F", "T"),
            lambda converged: [number for force in converged.body_forces for number in force.ravel().tolist()],
        ),
        Series(
            "jumps of periodic cells",
            "",
            "Jump of the displacement from a cell to the next (`NAME.u1`, `u2`, `u3`, m), and the force with which the "
            "next cell pulls (`NAME.F1`, `F2`, `F3`, N).",
            lambda model: [
                f"{one.name}.{letter}{i}" for one in model.shell.periodic for letter in ("u", "F") for i in (1, 2, 3)
            ],
            lambda converged: converged.jumps.ravel().tolist(),
        ),
        Series(
            "angle of the field",
            "rad",
            "Angle by which a uniform field has turned about its axis (`field.angle`), if it turns.",
            lambda model: list(_turning(model)),
            lambda converged: [
                float(converged.loading.drives[i]) for i in _turning(converged.discretisation.model).values()
            ],
        ),
    )
}
"""The series, by name, in the order of the files."""


def columns(model: Model) -> list[str]:
    """The columns of all series."""
    return [column for series in SERIES.values() for column in series.columns(model)]


def evaluated(converged: Converged) -> list[Number]:
    """The numbers of all series."""
    return [number for series in SERIES.values() for number in series.evaluate(converged)]
