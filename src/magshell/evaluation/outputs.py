"""What a result holds: every quantity that files and pictures show, named once.

Writers, pictures and pages all go through `OUTPUTS`, so a new quantity is one entry here. Files and pages hold those
that are `usual` and those that the model asks for (`chosen`); pictures show any.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from magshell.arrays import AnyArray
from magshell.errors import InputError, suggest
from magshell.evaluation.converged import Converged
from magshell.evaluation.resultants import four
from magshell.evaluation.strain import FACES, symmetric
from magshell.shell.point import INTERNAL

VECTOR = ("1", "2", "3")
SYMMETRIC = ("11", "22", "33", "12", "23", "13")
"""In the order of VTK, so that ParaView's labels XX to XZ are right."""
SECTION = ("11", "22", "12", "21")
COUPLES = ("11", "21", "31", "12", "22", "32")


@dataclass(frozen=True)
class Output:
    """One quantity of a state.

    Attributes
    ----------
    name : str
        Its array in the files.
    symbol : str
        Short name; a component is the name or the symbol with one of the suffixes.
    unit : str
        SI, empty for a pure number.
    sentence : str
        What it is.
    where : "point", "sheet", "patch" or "cell"
        One row per node of the mesh, per row of `Patches` (a node has one for each smooth patch about it), or per
        element. What is of a "sheet" is equal in all patches of a node that have one sheet and section.
    components : int
        1 for a scalar (one-dimensional array), 3 for a vector (in X1, X2, X3), or as many as there are suffixes.
    evaluate : callable
        From what has converged to the array.
    suffixes : tuple of str
        What tells the components apart; by default 1, 2 and 3.
    face : str
        "top", "middle" or "bottom" of what there is at each; names and symbols end with it.
    has_length : bool
        Whether the components are those of a vector, which as a whole is shown by its length.
    usual : bool
        Whether files and pages hold it without being asked to.
    """

    name: str
    symbol: str
    unit: str
    sentence: str
    where: Literal["point", "sheet", "patch", "cell"]
    components: int
    evaluate: Callable[[Converged], AnyArray]
    suffixes: tuple[str, ...] = VECTOR
    face: str = ""
    has_length: bool = True
    usual: bool = True

    def of_component(self, word: str, component: int) -> str:
        """A component's own name, from 1, made of the name or the symbol: "u3", "stress11_top"."""
        end = f"_{self.face}" if self.face else ""
        return f"{word.removesuffix(end)}{self.suffixes[component - 1]}{end}"


def _element_group(converged: Converged) -> AnyArray:
    numbers = np.zeros(len(converged.mesh.elements), dtype=np.int32)
    for number, elements in enumerate(converged.mesh.element_groups.values(), start=1):
        numbers[elements] = number
    return numbers


def _tensor(converged: Converged, name: str, face: str) -> AnyArray:
    return symmetric(converged.at_face(name, face))


def _at_faces() -> Iterable[Output]:
    """What there is at the upper face, in the middle and at the lower face."""
    tensors = (
        ("stress", "s", "Pa", "Cauchy stress of the elastic law, symmetric part, in the local axes"),
        ("log_strain", "e", "", "Logarithmic strain ln U, in the local axes"),
        ("green_strain", "E", "", "Green–Lagrange strain, in the local axes"),
    )
    values = (
        ("von_mises", "s_vm", "Pa", "Von Mises stress of the symmetric part of the Cauchy stress", 1, True),
        ("principal_strain", "e_max", "", "Largest principal logarithmic strain", 1, True),
        ("principal_stress", "s_p", "Pa", "Principal values of the symmetric Cauchy stress, largest first", 3, False),
        ("principal_stretches", "lambda", "", "Principal stretches, largest first", 3, False),
        ("axial_stress", "s_a", "Pa", "Axial vector of the skew Cauchy stress, in the local axes", 3, False),
    )
    places = {"top": "at the upper face", "middle": "in the middle", "bottom": "at the lower face"}
    for face in FACES:
        for name, symbol, unit, sentence, components, usual in values:
            yield Output(
                f"{name}_{face}",
                f"{symbol}_{face}",
                unit,
                f"{sentence}; {places[face]}.",
                "patch",
                components,
                lambda converged, name=name, face=face: converged.at_face(name, face),  # type: ignore[misc]
                face=face,
                has_length=name == "axial_stress",
                usual=usual and face != "middle",
            )
        for name, symbol, unit, sentence in tensors:
            yield Output(
                f"{name}_{face}",
                f"{symbol}_{face}",
                unit,
                f"{sentence}; {places[face]}.",
                "patch",
                6,
                lambda converged, name=name, face=face: _tensor(converged, name, face),  # type: ignore[misc]
                suffixes=SYMMETRIC,
                face=face,
                has_length=False,
                usual=False,
            )


def _of_sections() -> Iterable[Output]:
    """Stress resultants and the axes that they are in."""
    of = "in the local axes, per undeformed length; the second index is the section's normal."
    yield Output(
        "membrane_force",
        "N",
        "N/m",
        f"Forces of the sections in the surface, magnetic stress included, {of}",
        "patch",
        4,
        lambda converged: four(converged.resultant("forces")),
        suffixes=SECTION,
        has_length=False,
        usual=False,
    )
    yield Output(
        "bending_moment",
        "M",
        "N",
        f"Moments of the sections, positive where the upper face is pulled, {of}",
        "patch",
        4,
        lambda converged: four(converged.resultant("moments")),
        suffixes=SECTION,
        has_length=False,
        usual=False,
    )
    yield Output(
        "shear_force",
        "Q",
        "N/m",
        "Forces of the sections along the deformed normal, magnetic stress included, per undeformed length.",
        "patch",
        2,
        lambda converged: converged.resultant("forces")[:, 2],
        suffixes=("1", "2"),
        has_length=False,
        usual=False,
    )
    yield Output(
        "couple_resultant",
        "C",
        "N",
        f"Moments of the couple stress {of}",
        "patch",
        6,
        lambda converged: np.swapaxes(converged.resultant("couples"), 1, 2).reshape(-1, 6),
        suffixes=COUPLES,
        has_length=False,
        usual=False,
    )
    for number, word in enumerate(("First", "Second")):
        yield Output(
            f"local_axis_{number + 1}",
            f"t_{number + 1}",
            "",
            f"{word} local axis, turned with the mid-surface.",
            "patch",
            3,
            lambda converged, number=number: converged.resultant("axes")[:, number],  # type: ignore[misc]
            usual=False,
        )


OUTPUTS: dict[str, Output] = {
    output.name: output
    for output in (
        Output(
            "displacement",
            "u",
            "m",
            "Displacement of the mid-surface.",
            "point",
            3,
            lambda converged: converged.displacement,
        ),
        Output(
            "director",
            "d",
            "",
            "Deformed director: unit normal of the undeformed mid-surface plus its difference vector w.",
            "sheet",
            3,
            lambda converged: converged.director(),
        ),
        Output(
            "phi",
            "phi",
            "1/m",
            "Linear part of the thickness stretch.",
            "sheet",
            1,
            lambda converged: converged.phi(),
        ),
        Output(
            "rotation",
            "theta",
            "rad",
            "Micro-rotation vector: along the axis, as long as the angle.",
            "sheet",
            3,
            lambda converged: converged.rotation(),
        ),
        Output(
            "normal",
            "D",
            "",
            "Unit normal of the undeformed mid-surface.",
            "sheet",
            3,
            lambda converged: converged.normal(),
        ),
        Output(
            "remanence",
            "b",
            "T",
            "Remanent flux density carried by the deformed body, F·Brem/J, mean over the element.",
            "cell",
            3,
            lambda converged: converged.remanence(),
        ),
        Output(
            "thickness_ratio",
            "h",
            "",
            "Deformed over undeformed thickness, mean over the element.",
            "cell",
            1,
            lambda converged: converged.thickness_ratio(),
        ),
        Output(
            "energy",
            "W",
            "J",
            "Strain energy of the element.",
            "cell",
            1,
            lambda converged: converged.energies[:, INTERNAL],
        ),
        Output(
            "element_group",
            "group",
            "",
            "Number of the element group, from 1 in the order of element_group_names; 0 in none.",
            "cell",
            1,
            _element_group,
        ),
        Output(
            "energy_density",
            "w",
            "J/m³",
            "Strain energy per undeformed volume, mean over the element.",
            "cell",
            1,
            lambda converged: converged.energy_density(),
            usual=False,
        ),
        Output(
            "torque_density",
            "tau",
            "N/m²",
            "Torque of the field per undeformed volume, mean over the element.",
            "cell",
            3,
            lambda converged: converged.torque_density(),
            usual=False,
        ),
        Output(
            "magnetic_force_density",
            "f_m",
            "N/m³",
            "Force of the field per undeformed volume, mean over the element; zero in a uniform field.",
            "cell",
            3,
            lambda converged: converged.magnetic_force_density(),
            usual=False,
        ),
        Output(
            "flux_density",
            "B",
            "T",
            "Applied flux density at the deformed nodes.",
            "point",
            3,
            lambda converged: converged.flux_density(),
            usual=False,
        ),
        Output(
            "self_flux_density",
            "B_s",
            "T",
            "Flux density that the body itself adds, without an element's own, mean over the element.",
            "cell",
            3,
            lambda converged: converged.self_flux_density(),
            usual=False,
        ),
        *_at_faces(),
        *_of_sections(),
    )
}
"""The quantities, by name, in the order of the files."""


def find(name: str, whole: bool = False) -> tuple[Output, int | None]:
    """Look an output up by what a user calls it.

    Parameters
    ----------
    name : str
        Name or symbol of an output, or either with the suffix of a component: "displacement", "u", "u3",
        "stress11_top", "s11_top".
    whole : bool
        Whether a tensor may stand without its component; colours need one.

    Returns
    -------
    Output
    int or None
        The component, from 1; None for the whole (a vector is then shown by its length).

    Raises
    ------
    InputError
        No such output; names the nearest. A tensor without its component; names these.
    """
    known: dict[str, tuple[Output, int | None]] = {}
    for output in OUTPUTS.values():
        words = (output.name, output.symbol)
        known |= dict.fromkeys(words, (output, None))
        if output.components > 1:
            numbers = range(1, output.components + 1)
            known |= {output.of_component(word, i): (output, i) for word in words for i in numbers}
    if name not in known:
        raise InputError(f"There is no output '{name}' to show. {suggest(name, known)}")
    output, component = known[name]
    if component is None and output.components > 1 and not (output.has_length or whole):
        own = ", ".join(output.of_component(output.symbol, i) for i in range(1, output.components + 1))
        raise InputError(f"Output '{name}' has several components to show; name one of {own}")
    return output, component


def chosen(names: Sequence[str]) -> list[Output]:
    """The usual outputs and those with these names, in the order of the registry.

    Parameters
    ----------
    names : sequence of str
        Names of outputs; of what there is at each face also the name without the face, for all three.

    Raises
    ------
    InputError
        No such output; names the nearest.
    """
    families: dict[str, set[str]] = {}
    for output in OUTPUTS.values():
        for word in {output.name, output.name.removesuffix(f"_{output.face}")}:
            families.setdefault(word, set()).add(output.name)
    for name in names:
        if name not in families:
            raise InputError(f"There is no output '{name}'. {suggest(name, families)}")
    asked = {member for name in names for member in families[name]}
    return [output for output in OUTPUTS.values() if output.usual or output.name in asked]
