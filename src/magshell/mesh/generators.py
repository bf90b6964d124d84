"""Meshes of simple surfaces, with their edges named."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.errors import InputError
from magshell.mesh.arguments import angles, axes, divisions, number_pair, positive, whole_turn
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.grid import grid
from magshell.mesh.mesh import Mesh
from magshell.mesh.unmatched import ON_EDGE


def rectangle(length: float, width: float, elements: Sequence[int]) -> Mesh:
    """Rectangle in the plane X1-X2 with a corner at the origin and the normal +X3.

    Parameters
    ----------
    length, width : float
        Extent along X1 and X2, m.
    elements : (int, int)
        Number of elements along X1 and X2.

    Returns
    -------
    Mesh
        With the edge groups left (X1 = 0), right (X1 = length), bottom (X2 = 0), top (X2 = width).

    Raises
    ------
    InputError
        A length that is not positive, or a number of elements below 1.
    """
    extent = [positive("rectangle", "length", length), positive("rectangle", "width", width)]
    pattern = grid(*divisions("rectangle", elements))
    points = np.pad(pattern.parameters * extent, ((0, 0), (0, 1)))
    names = {"left": (0, 0.0), "right": (0, 1.0), "bottom": (1, 0.0), "top": (1, 1.0)}
    return Mesh(points, pattern.elements, edge_groups=pattern.sides(names))


def annulus(
    inner_radius: float,
    outer_radius: float,
    elements: Sequence[int],
    angle: Sequence[float] = (0.0, 360.0),
    slit: bool = False,
) -> Mesh:
    """Flat ring about X3 in the plane X1-X2, or a sector of one, with the normal +X3.

    Parameters
    ----------
    inner_radius, outer_radius : float
        m.
    elements : (int, int)
        Number of elements from the inner to the outer edge and around.
    angle : (float, float)
        Start and stop in degrees from +X1 towards +X2. A span of 360 makes a whole ring, welded.
    slit : bool
        Whether a whole ring is cut open at the start. The side of the stop then ends short of it by twice the
        distance that a mesh tells apart, about 2e-3 of an element at the inner edge.

    Returns
    -------
    Mesh
        With the edge groups inner and outer and, of a sector or a slit ring, start and stop.

    Raises
    ------
    InputError
        Radii that are not positive or do not rise, numbers of elements below 1, angles that do not rise or span
        more than 360 degrees, elements of more than 120 degrees, a slit in a sector.
    """
    inner = positive("annulus", "inner_radius", inner_radius)
    outer = positive("annulus", "outer_radius", outer_radius)
    if outer <= inner:
        raise InputError(
            f"annulus: outer_radius = {outer_radius!r} is not allowed; it must exceed inner_radius = {inner_radius!r}."
        )
    across, around = divisions("annulus", elements)
    start, stop = angles("annulus", "angle", angle, around)
    whole = whole_turn(start, stop)
    if slit and not whole:
        raise InputError(
            f"annulus: slit is for a whole ring; angle = {angle!r} makes a sector, which is open as it is."
        )
    span = np.radians(stop - start)
    if slit:
        shortest = min((outer - inner) / across, inner * span / around)
        span -= 2.0 * max(ON_EDGE * shortest, COINCIDENT * 2.0**1.5 * outer) / inner
    closed = whole and not slit
    pattern = grid(across, around, closed=1 if closed else None)
    radius = inner + (outer - inner) * pattern.parameters[:, 0]
    turn = np.radians(start) + span * pattern.parameters[:, 1]
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros_like(turn)], axis=1)
    names = {"inner": (0, 0.0), "outer": (0, 1.0)}
    if not closed:
        names |= {"start": (1, 0.0), "stop": (1, 1.0)}
    return Mesh(points, pattern.elements, edge_groups=pattern.sides(names))


def cylinder(
    radius: float,
    length: float,
    elements: Sequence[int],
    angle: Sequence[float] = (0.0, 360.0),
    axis: Sequence[float] = (0.0, 0.0, 1.0),
    zero: Sequence[float] = (1.0, 0.0, 0.0),
) -> Mesh:
    """Tube, or a sector of one, from the origin along its axis, with the normal outward.

    Parameters
    ----------
    radius, length : float
        Of the mid-surface, m.
    elements : (int, int)
        Number of elements around and along.
    angle : (float, float)
        Start and stop in degrees, turning right-handed about the axis. A span of 360 makes a whole tube,
        welded.
    axis : (3,)
        Direction of the axis.
    zero : (3,)
        Direction of angle 0; what it has along the axis is dropped.

    Returns
    -------
    Mesh
        All nodes on the true surface, with the edge groups start (at the origin), end (at `length`) and, of a
        sector, angle-start and angle-stop.

    Raises
    ------
    InputError
        Lengths that are not positive, numbers of elements below 1, angles that do not rise or span more than
        360 degrees, elements of more than 120 degrees, `zero` along the axis.
    """
    radius, length = positive("cylinder", "radius", radius), positive("cylinder", "length", length)
    around, along = divisions("cylinder", elements)
    start, stop = angles("cylinder", "angle", angle, around)
    e1, e2, e3 = axes("cylinder", axis, "zero", zero)
    whole = whole_turn(start, stop)
    pattern = grid(around, along, closed=0 if whole else None)
    turn = np.radians(start + (stop - start) * pattern.parameters[:, :1])
    height = length * pattern.parameters[:, 1:]
    points = radius * (np.cos(turn) * e1 + np.sin(turn) * e2) + height * e3
    names = {"start": (1, 0.0), "end": (1, 1.0)}
    if not whole:
        names |= {"angle-start": (0, 0.0), "angle-stop": (0, 1.0)}
    return Mesh(points, pattern.elements, edge_groups=pattern.sides(names))


def sphere_patch(radius: float, polar: Sequence[float], azimuth: Sequence[float], elements: Sequence[int]) -> Mesh:
    """Part of a sphere about the origin between two latitudes and two meridians, with the normal outward.

    Parameters
    ----------
    radius : float
        Of the mid-surface, m.
    polar : (float, float)
        Start and stop in degrees from +X3, above 0 and below 180: elements at a pole would be degenerate.
    azimuth : (float, float)
        Start and stop in degrees from +X1 towards +X2. A span of 360 makes a whole zone, welded.
    elements : (int, int)
        Number of elements along a meridian and around.

    Returns
    -------
    Mesh
        All nodes on the true surface, with the edge groups top and bottom (polar start and stop) and, unless
        the zone is whole, left and right (azimuth start and stop).

    Raises
    ------
    InputError
        A radius that is not positive, numbers of elements below 1, angles out of range or not rising,
        elements of more than 120 degrees.
    """
    radius = positive("sphere_patch", "radius", radius)
    along, around = divisions("sphere_patch", elements)
    top, bottom = number_pair("sphere_patch", "polar", polar)
    if not (0 <= top <= 180 and 0 <= bottom <= 180):
        raise InputError(
            f"sphere_patch: polar = {polar!r} is not allowed; polar angles run from 0, at +X3, to 180, at "
            "-X3, both excluded."
        )
    if top == 0 or bottom == 180:
        raise InputError(
            f"sphere_patch: polar = {polar!r} touches a pole, where elements would be degenerate; leave a "
            f"hole, as in polar = ({top or 1:g}, {bottom if bottom < 180 else 179:g})."
        )
    angles("sphere_patch", "polar", polar, along)
    left, right = angles("sphere_patch", "azimuth", azimuth, around)
    whole = whole_turn(left, right)
    pattern = grid(along, around, closed=1 if whole else None)
    theta = np.radians(top + (bottom - top) * pattern.parameters[:, 0])
    phi = np.radians(left + (right - left) * pattern.parameters[:, 1])
    points = radius * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    names = {"top": (0, 0.0), "bottom": (0, 1.0)}
    if not whole:
        names |= {"left": (1, 0.0), "right": (1, 1.0)}
    return Mesh(points, pattern.elements, edge_groups=pattern.sides(names))
