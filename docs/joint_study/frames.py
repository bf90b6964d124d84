"""Folded strips: L and T frames, an L at large rotation, sprung hinges, and a row of joints across a flat strip."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

import magshell as ms
from joint_study.strips import MU, SCALES, Row, bending, row, rubber
from magshell.shell import rotation

ARM, POST, WIDTH, THICKNESS = 1.0, 0.6, 0.2, 0.02
SMALL = 1e-6
"""Loads over D: so small that the response is linear."""


def frame(points: Mapping[str, Sequence[float]], walls: Mapping[str, Sequence[str]], elements: int = 6) -> ms.Mesh:
    """Walls over a figure in the plane X1-X3, extruded along X2."""
    return ms.mesh.profile(points, walls, WIDTH, (elements, 1), axis=(0, -1, 0))


def end(path: ms.Path, group: str) -> np.ndarray:
    """Mean displacement (3,) of a group at the end of a path."""
    mesh = path.model.shell.mesh
    return path.steps[-1].state.displacement(len(mesh.points))[mesh.nodes_of(group)].mean(axis=0)


L_POINTS = {"tip": (0.0, 0.0), "fold": (ARM, 0.0), "root": (ARM, POST)}
L_WALLS = {"arm": ("tip", "fold"), "post": ("fold", "root")}


def cantilever(name: str) -> Iterator[Row]:
    """An arm at the end of a clamped post, a force across the arm's tip."""
    stiffness = bending(WIDTH, THICKNESS, SCALES[name])
    shell = ms.Shell(frame(L_POINTS, L_WALLS), THICKNESS, rubber(THICKNESS, SCALES[name]))
    force = SMALL * stiffness
    path = ms.solve(ms.Model(shell, [ms.Clamp("root")], loads=[ms.Force("tip", (0, 0, -force))]))
    expected = force * (ARM**3 / 3.0 + ARM**2 * POST) / stiffness
    yield row("L-cantilever, F (a³/3 + a² b)/D", name, "deflection / a", -end(path, "tip")[2] / ARM, expected / ARM)


def tee(name: str) -> Iterator[Row]:
    """A web on the middle of a flange that is clamped at both ends, a force along the flange at the web's top."""
    stiffness = bending(WIDTH, THICKNESS, SCALES[name])
    points = {"left": (-ARM, 0.0), "joint": (0.0, 0.0), "right": (ARM, 0.0), "top": (0.0, POST)}
    walls = {"one": ("left", "joint"), "other": ("joint", "right"), "web": ("joint", "top")}
    shell = ms.Shell(frame(points, walls), THICKNESS, rubber(THICKNESS, SCALES[name]))
    force = SMALL * stiffness
    supports = [ms.Clamp("left"), ms.Clamp("right")]
    path = ms.solve(ms.Model(shell, supports, loads=[ms.Force("top", (force, 0, 0))]))
    expected = force * (POST**3 / 3.0 + POST**2 * ARM / 8.0) / stiffness
    yield row("T-joint, F (b³/3 + b² a/8)/D", name, "deflection / b", end(path, "top")[0] / POST, expected / POST)


def folded_elastica(force: np.ndarray, stiffness: float) -> np.ndarray:
    """Displacement (2,) of the tip of an inextensible L under a dead force there, by shooting for the root's moment.

    From the root: D θ' = m and m' = t × F, with the tangent t turned by θ and jumping by the fold.
    """
    pieces = ((POST, (0.0, -1.0)), (ARM, (-1.0, 0.0)))

    def slope(s: float, y: np.ndarray, tangent: tuple[float, float]) -> list[float]:
        c, d = np.cos(y[0]), np.sin(y[0])
        x, z = c * tangent[0] - d * tangent[1], d * tangent[0] + c * tangent[1]
        return [y[1] / stiffness, z * force[0] - x * force[1], x, z]

    def integrated(moment: float) -> np.ndarray:
        y = np.array([0.0, moment, 0.0, 0.0])
        for length, tangent in pieces:
            y = solve_ivp(slope, (0.0, length), y, args=(tangent,), rtol=1e-11, atol=1e-13).y[:, -1]
        return y

    start = (-ARM) * force[1] - (-POST) * force[0]
    found = root(lambda moment: integrated(moment[0])[1] / stiffness, [start], tol=1e-12)
    return integrated(found.x[0])[2:] - np.array([-ARM, -POST])


def large_rotation(name: str) -> Iterator[Row]:
    """The L-cantilever under a force that turns its tip by more than a right angle."""
    stiffness = bending(WIDTH, THICKNESS, SCALES[name])
    force = np.array([0.6, -1.2]) * stiffness / ARM**2
    expected = folded_elastica(force, stiffness)
    shell = ms.Shell(frame(L_POINTS, L_WALLS, 8), THICKNESS, rubber(THICKNESS, SCALES[name]))
    path = ms.solve(ms.Model(shell, [ms.Clamp("root")], loads=[ms.Force("tip", (force[0], 0, force[1]))]))
    found = end(path, "tip")[[0, 2]]
    for axis, one, other in zip((1, 3), found, expected, strict=True):
        quantity = f"u{axis} of the tip / a"
        yield Row(
            "L under F a²/D = (0.6, -1.2), elastica",
            name,
            quantity,
            one / ARM,
            other / ARM,
            np.linalg.norm(expected) / ARM,
        )


TURN = 0.5 * np.pi
FLAT = {"root": (0.0, 0.0), "middle": (0.5 * ARM, 0.0), "tip": (ARM, 0.0)}


def hinge(name: str) -> Iterator[Row]:
    """Two strips in a line with a sprung hinge between them, a moment at the end: the angle is M/k."""
    stiffness = bending(WIDTH, THICKNESS, SCALES[name])
    walls = {"one": ("root", "middle"), "other": ("middle", "tip")}
    spring = 0.5 * stiffness / WIDTH
    for angle in (1e-3, TURN):
        moment = angle * spring * WIDTH
        shell = ms.Shell(
            frame(FLAT, walls, 4), THICKNESS, rubber(THICKNESS, SCALES[name]), hinges=[ms.Hinge("middle", spring)]
        )
        path = ms.solve(ms.Model(shell, [ms.Clamp("root")], loads=[ms.Moment("tip", (0, moment, 0))]))
        quantity = f"angle, small ({angle:g})" if angle < 1.0 else "angle, 90°"
        yield row("hinge with spring, M/k", name, f"{quantity} (rad)", _angle(path), angle)


def _angle(path: ms.Path) -> float:
    """Mean angle between the micro-rotations on the two sides of the hinge at the middle."""
    rows, q = path.discretisation.rows, path.steps[-1].state.q
    nodes = path.model.shell.mesh.nodes_of("middle")
    sides = [np.unique(rows.source[rows.of == node, 7]) for node in nodes]
    turns = [rotation.product(rotation.conjugate(q[a]), q[b]) for a, b in sides]
    return float(np.mean([np.linalg.norm(rotation.logarithm(turn[None])[0]) for turn in turns]))


def joint_row(name: str) -> Iterator[Row]:
    """A flat strip whose outer half is upside down, which makes joints of the nodes across its middle."""
    plain = frame(FLAT, {"one": ("root", "middle"), "other": ("middle", "tip")}, 4)
    jointed = frame(FLAT, {"one": ("root", "middle"), "other": ("tip", "middle")}, 4)
    material = ms.MicropolarStVenantKirchhoff(MU, 3.0 * MU, MU, SCALES[name] * THICKNESS)
    for load in ("bending", "tension", "torsion"):
        found = [_tip(mesh, material, load) for mesh in (jointed, plain)]
        yield row(
            "flat strip with joints across it", name, f"{load}, tip over that without joints", found[0] / found[1], 1.0
        )


def stiff_hinge(name: str) -> Iterator[Row]:
    """A flat strip under a force at its end: a stiff spring in place of its middle adds the angle F a/2 k there."""
    walls = {"one": ("root", "middle"), "other": ("middle", "tip")}
    for stiff in (1.0, 1e2, 1e4):
        spring = stiff * bending(WIDTH, THICKNESS, SCALES[name]) / (WIDTH * ARM)
        mesh, material = frame(FLAT, walls, 4), rubber(THICKNESS, SCALES[name])
        found = [_tip(mesh, material, "bending", hinges) for hinges in ([ms.Hinge("middle", spring)], [])]
        quantity = f"spring of k a/D = {stiff:g}, tip over that without"
        yield row("flat strip with a sprung hinge", name, quantity, found[0] / found[1], 1.0 + 0.75 / stiff)


def _tip(mesh: ms.Mesh, material: ms.MicropolarStVenantKirchhoff, load: str, hinges: Sequence[ms.Hinge] = ()) -> float:
    """What the rigid end of a strip does under a small load."""
    stiffness = bending(WIDTH, THICKNESS, 0.0)
    rigid = [ms.RigidBody("tip")]
    shell = ms.Shell(mesh, THICKNESS, material, hinges=hinges, rigid=rigid)
    loads = {
        "bending": ms.Force("tip", (0, 0, SMALL * stiffness)),
        "tension": ms.Force("tip", (SMALL * stiffness / THICKNESS, 0, 0)),
        "torsion": ms.Moment("tip", (SMALL * stiffness, 0, 0)),
    }
    path = ms.solve(ms.Model(shell, [ms.Clamp("root")], loads=[loads[load]]))
    moved, turned = (
        path.steps[-1].state.u[path.discretisation.rows.nodes],
        path.steps[-1].state.q[path.discretisation.rows.nodes],
    )
    return float({"bending": moved[2], "tension": moved[0], "torsion": turned[1]}[load])
