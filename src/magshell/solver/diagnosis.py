r"""Why a path ends: what is measured in its last converged state, where it turned, and in the step that failed.

Three things end a path other than the physics of the body:

* *Mesh too coarse for the bending.* An edge of an element is a parabola. The angle between its two end tangents, or
  between the directors at its ends if that is larger (twist), is what the shell turns within one element. Uniform
  bending by 45° in each element costs 0.3 % of the tip's displacement, by 60° 0.8 %, by 90° 3 %; where bending gathers
  in a layer that is thinner than an element, as at a clamp, a path ends earlier.
* *Couple at its limit.* The field's couple reaches the material through the micro-rotation alone. With F = Q S and the
  micro-rotation turned by θ about n relative to Q, the energy -η/2 tr(U²) resists with (η/2) (tr S - n·S n)² sin 2θ per
  unit volume: nothing more than that with sin 2θ = 1, 2η where nothing is stretched, can be transferred, and beyond 45°
  there is no stable equilibrium. The load factor turns there, and beyond it the couple falls again: it is measured
  at the first limit point of the stage too. Well below the limit the micro-rotation may already be so far from the
  rotation of the material that it gives way first.
* *A material at the limit of its stretch*, for laws that have one (`extension.py`).
* *An element turned inside out*, where det F is far from one at its points already.

Each is measured in the last state and where the load factor turned first, since the states after that point are not
those that a growing load leads to; the worse of the two counts. Only measures beyond their bounds are named as causes;
if none is, the figures are given.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation.converged import Converged
from magshell.magnetics import law
from magshell.magnetics.law import OMEGA
from magshell.model.course import Loading
from magshell.model.parts import REST
from magshell.shell.deformed import evaluate, level_stretch
from magshell.shell.state import State
from magshell.solver.extension import Extension, extension

# Angle (degrees) turned within an element: what is safe, and beyond which the mesh is a likely cause.
SAFE = 30.0
# Part of the greatest couple, and angle between micro-rotation and material (degrees), at which the limit is near.
NEAR_LIMIT, RUNNING_AHEAD = 0.9, 35.0
# The same where the coupling is named as soft: sin 2θ = 1/3 at θ = 10°.
SOFT_LIMIT, LAG = 1.0 / 3.0, 10.0
# det F in the last state below which an element is about to turn inside out.
SQUASHED = 0.5


class Turn(NamedTuple):
    """The largest angle (degrees) that the shell turns along an edge of an element, from one node to another.

    `undeformed` is that of the same edge before.
    """

    angle: float
    undeformed: float
    element: int
    nodes: tuple[int, int]


class Couple(NamedTuple):
    """The field's couple over the greatest that the micro-rotation transfers, where that is largest.

    Attributes
    ----------
    ratio : float
    ahead : float
        Largest angle between micro-rotation and material, degrees.
    element : int
        Where the ratio is largest.
    modulus : float
        Coupling modulus there, Pa.
    """

    ratio: float
    ahead: float
    element: int
    modulus: float


class Squash(NamedTuple):
    """The least det F at a point, and its element."""

    determinant: float
    element: int


class Measures(NamedTuple):
    """What is measured in a state, or the worst of several."""

    turn: Turn
    squash: Squash
    couple: Couple | None
    extension: Extension | None = None


def measure(discretisation: Discretisation, state: State, loading: Loading) -> Measures:
    """Bending per element, det F, the couple and the extension in a state."""
    F = Converged(discretisation, state, loading).fields.F
    determinants = np.linalg.det(F).min(axis=(1, 2))
    worst = int(determinants.argmin())
    return Measures(
        _turn(discretisation, state),
        Squash(float(determinants[worst]), worst),
        _couple(discretisation, state, loading),
        extension(discretisation, F),
    )


def diagnosis(
    discretisation: Discretisation,
    state: State,
    loading: Loading,
    inverted: int | None,
    turned: tuple[State, Loading] | None = None,
) -> str:
    """Sentences for the end of a message: the causes that are measured, and what to do.

    Parameters
    ----------
    discretisation : Discretisation
    state : State
        The last that converged.
    loading : Loading
        What acts there.
    inverted : int or None
        The element that the failed step turns inside out.
    turned : tuple of State and Loading, optional
        Where the load factor turned first.
    """
    last = measure(discretisation, state, loading)
    worst = last if turned is None else _worse(last, measure(discretisation, *turned))
    causes = [*_causes(discretisation, last, worst)]
    where = ""
    if inverted is not None and (groups := _touched(discretisation, inverted)):
        where = f" Element {inverted}, which is turned inside out, touches the support '{groups[0]}'."
    if causes:
        return "Likely cause: " + " Also, ".join(causes) + where
    return (
        f"In the last state nothing stands out: {_figures(last)}.{where} The path may bend too sharply there (a "
        "smaller largest_step shows it), or a unit may have slipped (`magshell check` shows the magnitudes)."
    )


def _worse(one: Measures, other: Measures) -> Measures:
    """The worse of each measure in two states."""
    turn = max(one.turn, other.turn, key=lambda turn: turn.angle)
    squash = min(one.squash, other.squash, key=lambda squash: squash.determinant)
    couples = [couple for couple in (one.couple, other.couple) if couple is not None]
    extensions = [found for found in (one.extension, other.extension) if found is not None]
    extended = max(extensions, default=None)
    if not couples:
        return Measures(turn, squash, None, extended)
    couple = max(couples, key=lambda couple: couple.ratio)
    return Measures(turn, squash, couple._replace(ahead=max(couple.ahead for couple in couples)), extended)


def _causes(discretisation: Discretisation, last: Measures, worst: Measures) -> Iterator[str]:
    """The causes, from the measures in the last state and the worst ones: limit, mesh, soft coupling, squashing."""
    turn, squash, couple, extended = worst
    limited = couple is not None and (couple.ratio > NEAR_LIMIT or couple.ahead > RUNNING_AHEAD)
    if couple is not None and limited:
        yield (
            f"the couple of the field reaches the limit of what the micro-rotation transfers to the material: it is "
            f"{100 * couple.ratio:.0f} % of that in {_place(discretisation, couple.element)}"
            f"{_when(couple.ratio, last.couple and last.couple.ratio)}, and the micro-rotation "
            f"runs ahead by up to {couple.ahead:.0f}° (beyond 45° nothing holds it). Take a larger coupling_modulus "
            f"than {couple.modulus / 1e3:.4g} kPa{_of_part(discretisation, couple.element)}, or a weaker field."
        )
    if turn.angle > SAFE:
        one, other = turn.nodes
        before = f" ({turn.undeformed:.0f}° before)" if turn.undeformed > 1.0 else ""
        yield (
            f"the mesh is too coarse for the bending: {_place(discretisation, turn.element)} turns by "
            f"{turn.angle:.0f}°{before} from node {one} to node {other}{_when(turn.angle, last.turn.angle)} "
            f"({SAFE:.0f}° are safe). Take {np.ceil(2.0 * turn.angle / SAFE) / 2.0:g} times as many elements, or more, "
            "in that direction."
        )
    if couple is not None and not limited and (couple.ratio > SOFT_LIMIT or couple.ahead > LAG):
        yield (
            f"the micro-rotation is held softly: it runs ahead of the material by up to {couple.ahead:.0f}°, and the "
            f"couple of the field is {100 * couple.ratio:.0f} % of what it can transfer in "
            f"{_place(discretisation, couple.element)}{_when(couple.ratio, last.couple and last.couple.ratio)}. A "
            f"larger coupling_modulus than {couple.modulus / 1e3:.4g} kPa"
            f"{_of_part(discretisation, couple.element)}, or a weaker field, may help."
        )
    if extended is not None and extended.share > NEAR_LIMIT:
        yield (
            f"the material is stretched to {100 * extended.share:.0f} % of the limit of its law in "
            f"{_place(discretisation, extended.element)}"
            f"{_when(extended.share, last.extension and last.extension.share)}. Take a larger extension_limit, or "
            "weaker loads."
        )
    if squash.determinant < SQUASHED:
        yield (
            f"the material is squashed: det F is {squash.determinant:.2g} in {_place(discretisation, squash.element)}"
            f"{_when(squash.determinant, last.squash.determinant)}."
        )


def _when(worst: float, last: float | None) -> str:
    """Where on the path the worst of a measure was met."""
    return "" if worst == last else " where the load factor turned"


def _figures(measured: Measures) -> str:
    turn, squash, couple, extended = measured
    figures = f"elements turn by at most {turn.angle:.0f}°, det F is at least {squash.determinant:.2g}"
    if extended is not None:
        figures += f", the stretch is at most {100 * extended.share:.0f} % of the limit of its law"
    if couple is None:
        return figures
    return f"{figures}, the couple is at most {100 * couple.ratio:.0f} % of what the micro-rotation transfers"


def _turn(discretisation: Discretisation, state: State) -> Turn:
    elements = discretisation.mesh.elements
    angles = _angles_of_edges(discretisation, state)
    before = _angles_of_edges(discretisation, discretisation.undeformed())
    element, edge = (int(index) for index in np.unravel_index(angles.argmax(), angles.shape))
    nodes = int(elements[element, edge]), int(elements[element, (edge + 1) % 4])
    return Turn(float(angles[element, edge]), float(before[element, edge]), element, nodes)


def _angles_of_edges(discretisation: Discretisation, state: State) -> FloatArray:
    """Angle (elements, 4) that the shell turns along each edge, degrees."""
    elements = discretisation.mesh.elements
    nodes = len(discretisation.mesh.points)
    position, rows = discretisation.mesh.points + state.u[:nodes], discretisation.rows
    director = (rows.normals + state.w)[rows.elements[:, :4]]
    first, second, middle = elements[:, :4], np.roll(elements[:, :4], -1, axis=1), elements[:, 4:]
    chord, rise = (
        position[second] - position[first],
        4.0 * position[middle] - 2.0 * (position[first] + position[second]),
    )
    return np.maximum(_angles(chord + rise, chord - rise), _angles(director, np.roll(director, -1, axis=1)))


def _angles(one: FloatArray, other: FloatArray) -> FloatArray:
    """Between vectors (…, 3), degrees."""
    sine = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, np.sum(one * other, axis=-1))))


def _couple(discretisation: Discretisation, state: State, loading: Loading) -> Couple | None:
    """None without a micro-rotation or a field."""
    model, reference = discretisation.model, discretisation.reference
    modulus = model.shell.mean_of("coupling_modulus")
    if not reference.body.layout.q or not modulus.any() or not np.any(loading.drives):
        return None
    field = discretisation.shell.field.at(state, loading, second=False)
    fields = evaluate(reference, state, level_stretch(reference, state, field))
    volume = reference.geometry.volume
    total = volume.sum(axis=2, keepdims=True)
    shares = np.divide(volume, total, out=np.full_like(volume, 1.0 / volume.shape[2]), where=total > 0.0)
    F = np.einsum("epk,epkxy->epxy", shares, fields.F)
    left, stretches, right = np.linalg.svd(F)
    Q = left @ right
    S = np.einsum("epyx,epy,epyz->epxz", right, stretches, right)
    c = np.linalg.norm(couple := _couples(discretisation, F, fields.R, field.flux_density.mean(axis=2)), axis=-1)
    axis = np.einsum("epyx,epy->epx", Q, couple) / np.maximum(c, np.finfo(float).tiny)[..., None]
    across = stretches.sum(axis=-1) - np.einsum("epx,epxy,epy->ep", axis, S, axis)
    limit = 0.5 * modulus[:, None] * across**2
    ratios = np.divide(c, limit, out=np.zeros_like(c), where=limit > 0.0).max(axis=1)
    cosine = 0.5 * (np.einsum("epxy,epxy->ep", Q, fields.R) - 1.0)
    ahead = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))[modulus > 0.0].max()
    element = int(ratios.argmax())
    return Couple(float(ratios[element]), float(ahead), element, float(modulus[element]))


def _couples(discretisation: Discretisation, F: FloatArray, R: FloatArray, flux_density: FloatArray) -> FloatArray:
    """Couple of the field per unit volume (elements, points, 3) that the law puts on the micro-rotation, N/m²."""
    remanence = discretisation.model.shell.remanence_at_points
    m, n = (np.einsum("epxy,epy->epx", by, remanence) for by in (F, R))
    return -law.evaluate(discretisation.model.coupling, m, n, flux_density)[1][..., OMEGA : OMEGA + 3]


def _place(discretisation: Discretisation, element: int) -> str:
    """An element by number, position and the support, joint or hinge that it touches."""
    mesh = discretisation.mesh
    centre = mesh.points[mesh.elements[element, :4]].mean(axis=0)
    position = ", ".join(f"{1e3 * x:.3g}" for x in centre)
    groups = _touched(discretisation, element)
    beside = f", at support '{groups[0]}'" if groups else _joined(discretisation, element)
    return f"element {element} (at ({position}) mm{_of_part(discretisation, element, ', in')}{beside})"


def _joined(discretisation: Discretisation, element: int) -> str:
    """Whether sheets meet at a node of an element."""
    rows, nodes = discretisation.rows, discretisation.mesh.elements[element]
    places = {"hinge": rows.hinged, "joint": rows.joined}
    return next((f", at a {name}" for name, those in places.items() if np.isin(nodes, those).any()), "")


def _of_part(discretisation: Discretisation, element: int, of: str = " of") -> str:
    """The region of an element; empty where there is one part only."""
    shell = discretisation.model.shell
    name = shell.parts[shell.part_of[element]].name
    return "" if name == REST else f"{of} region '{name}'"


def _touched(discretisation: Discretisation, element: int) -> list[str]:
    """Groups and rigid bodies of the supports that an element has nodes of."""
    model, nodes = discretisation.model, discretisation.mesh.elements[element]
    groups = [support.group for support in model.supports]
    return [group for group in groups if np.isin(nodes, model.shell.nodes_of(group)).any()]
