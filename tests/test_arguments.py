"""Values of the wrong class give an `InputError` that says what would be right, whatever takes them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import magshell as ms
from magshell.magnetics.fields import Cuboid, Source

MESH = ms.mesh.rectangle(10e-3, 4e-3, (2, 1))
RUBBER = ms.MicropolarNeoHookean(1e5, 1e6)
ALONG = ms.remanence.constant([0.1, 0, 0])
MAGNET = Source(Cuboid((1e-2, 1e-2, 1e-2), (0, 0, 1.0)), position=(0, 0, -5e-2))
TAPER = ms.thickness.function(lambda points: np.full(len(points), 1e-3))


def shell(**changes: Any) -> ms.Shell:
    made = ms.Shell(**{"mesh": MESH, "thickness": 1e-3, "material": RUBBER, "remanence": ALONG, **changes})
    assert made.parts
    return made


def model(**changes: Any) -> ms.Model:
    field = ms.UniformField((0, 0, 1e-3))
    return ms.Model(**{"shell": shell(density=1e3), "supports": [ms.Clamp("left")], "field": field, **changes})


def layered(layer: ms.Layer) -> ms.Shell:
    return ms.Shell(MESH, layers=[layer])


def on_springs(spring: Any) -> ms.Model:
    return model(shell=shell(rigid=[ms.RigidBody("right", "b")]), springs=[spring])


# What is made, with arguments that are right, and what it is put into.
MAKERS: list[tuple[Callable[..., Any], Mapping[str, Any], Callable[[Any], Any]]] = [
    (shell, {name: inspect.signature(ms.Shell).parameters[name].default for name in ("element", "offset")}, id),
    (ms.Shell, {"mesh": MESH, "thickness": 1e-3, "material": RUBBER, "remanence": ALONG}, lambda made: made.parts),
    (ms.Model, {"shell": shell(), "supports": [ms.Clamp("left")], "field": ms.UniformField((0, 0, 1e-3))}, id),
    (ms.Region, {"group": "all", "thickness": 1e-3}, lambda made: shell(regions=[made])),
    (ms.Layer, {"thickness": 1e-3, "material": RUBBER}, layered),
    (ms.Clamp, {"group": "left"}, lambda made: model(supports=[made])),
    (ms.SimpleSupport, {"group": "right"}, lambda made: model(supports=[ms.Clamp("left"), made])),
    (ms.SymmetryPlane, {"group": "right", "normal": (1, 0, 0)}, lambda made: model(supports=[ms.Clamp("left"), made])),
    (ms.Prescribe, {"group": "right", "field": "u"}, lambda made: model(supports=[ms.Clamp("left"), made])),
    (ms.Turn, {"group": "right", "axis": (0, 1, 0)}, lambda made: model(supports=[ms.Clamp("left"), made])),
    (ms.Stage, {}, lambda made: model(stages=[made])),
    (ms.Settings, {}, id),
    (ms.Force, {"group": "right", "total": (0, 0, 1e-3)}, lambda made: model(loads=[made])),
    (ms.Moment, {"group": "right", "total": (0, 1e-6, 0)}, lambda made: model(loads=[made])),
    (ms.Traction, {"group": None, "traction": (0, 0, 1.0)}, lambda made: model(loads=[made])),
    (ms.Pressure, {"group": None, "pressure": 1.0}, lambda made: model(loads=[made])),
    (ms.Gravity, {"acceleration": (0, 0, -9.81)}, lambda made: model(loads=[made])),
    (ms.RigidBody, {"group": "right"}, lambda made: model(shell=shell(rigid=[made]))),
    (ms.Hinge, {"group": "right"}, lambda made: model(shell=shell(hinges=[made]))),
    (ms.Spring, {"group": "right", "stiffness": 1.0}, lambda made: model(springs=[made])),
    (ms.TorsionSpring, {"group": "b", "stiffness": 1.0, "axis": (0, 1, 0)}, on_springs),
    (ms.Cyclic, {"group": "left", "image": "right", "sectors": 4}, lambda made: shell(repeated=[made]).images),
    (ms.Periodic, {"group": "bottom", "image": "top"}, lambda made: model(shell=shell(repeated=[made]))),
    (ms.MicropolarNeoHookean, {"shear_modulus": 1e5, "lame_lambda": 1e6}, lambda made: shell(material=made)),
    (ms.UniformField, {"flux_density": (0, 0, 1e-3)}, lambda made: model(field=made)),
    (ms.MagnetField, {"sources": [MAGNET]}, lambda made: model(field=made)),
    (ms.Motion, {}, lambda made: model(field=ms.MagnetField([MAGNET], made))),
    (ms.GradientField, {"gradient": np.diag([1, 1, -2])}, lambda made: model(field=made)),
    (ms.CoilSystem, {"calibration": np.eye(3), "currents": (0, 0, 1e-3)}, lambda made: model(field=made)),
    (ms.FunctionField, {"function": np.ones_like, "length": 1.0}, lambda made: model(field=made)),
    (ms.SampledField, {"axes": [[-1, 0, 1, 2.0]] * 3, "flux_density": np.ones((4, 4, 4, 3))}, id),
    (ms.SelfField, {}, lambda made: model(field=ms.UniformField((0, 0, 1e-3)) + made)),
    (ms.helmholtz, {"radius": 1.0, "current": 1.0}, id),
    (ms.maxwell, {"radius": 1.0, "current": 1.0}, id),
    (ms.halbach, {"radius": 1.0, "count": 8, "sides": (0.1, 0.1, 0.1), "remanence": 1.0}, id),
]
ARGUMENTS = [
    pytest.param(make, right, put, name, id=f"{make.__name__}-{name}")
    for make, right, put in MAKERS
    for name in (right if make is shell else inspect.signature(make).parameters)
]
WRONG = (None, 3.5, "1 mm", (0, 0, 0.1), ["a"], {}, object(), MESH)


@pytest.mark.parametrize(("make", "right", "put", "name"), ARGUMENTS)
def test_wrong_classes_are_input_errors(make: Any, right: Mapping[str, Any], put: Any, name: str) -> None:
    refused = 0
    for value in WRONG:
        try:
            put(make(**{**right, name: value}))
        except ms.InputError:
            refused += 1
    assert refused


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: shell(remanence=(0, 0, 0.1)), r"shell: remanence is .*: ms\.remanence\.constant\(\[0, 0, 0\.1\]\)"),
        (lambda: shell(remanence=[0, 0, 0.1]), r"ms\.remanence\.constant\(\[0, 0, 0\.1\]\)"),
        (lambda: shell(remanence=np.array([0, 0, 0.1])), r"ms\.remanence\.constant\(\[0, 0, 0\.1\]\)"),
        (lambda: shell(remanence=0.1), r"ms\.remanence\.constant\(\[…\]\)"),
        (lambda: shell(remanence=lambda points: points), r"function of the position write ms\.remanence\.function"),
        (lambda: shell(thickness=lambda points: 1e-3), r"thickness is a function .* ms\.thickness\.function\(…\)"),
        (lambda: shell(regions=[ms.Region("all", remanence=(0, 1, 0))]), r"regions\[0\]: remanence .*\(\[0, 1, 0\]\)"),
        (lambda: layered(ms.Layer(1e-3, RUBBER, (0, 1, 0))), r"layers\[0\]: remanence"),  # type: ignore[arg-type]
        (lambda: shell(regions=ms.Region("all")), "shell: regions is one Region; put it into a list"),
        (lambda: shell(material=ms.MicropolarNeoHookean), "must be a material law with its parameters, as"),
        (lambda: shell(mesh=None), "shell: mesh is None; it must be a Mesh"),
        (lambda: shell(element=8), "shell: element is 8; it must be one of 'quadratic'"),
        (lambda: model(supports=ms.Clamp("left")), "model: supports is one Clamp; put it into a list"),
        (lambda: model(supports=["left"]), r"model: supports\[0\] is 'left'; it must be a support, as ms\.Clamp"),
        (lambda: model(supports=[ms.Clamp(["left"])]), r"model: supports\[0\]: group is \['left'\]"),  # type: ignore[arg-type]
        (lambda: model(field=(0, 0, 1e-3)), r"model: field is .* ms\.UniformField\(\(0, 0, 0\.001\)\)"),
        (lambda: model(coupling=ms.MicropolarCouple), r"model: coupling is .* as ms\.MicropolarCouple\(\)"),
        (lambda: model(probes=[(0, 0, 0)]), "model: probes is .* a mapping of names to positions"),
        (lambda: ms.solve(model(), {"tolerance": 1e-9}), "solve: settings is .* ms.Settings"),  # type: ignore[arg-type]
        (lambda: ms.solve(shell()), "solve: model is Shell"),  # type: ignore[arg-type]
    ],
)  # fmt: skip
def test_messages_say_how_it_is_written(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ms.InputError, match=message):
        make()


def test_functions_of_mesh_and_points_pass() -> None:
    made = shell(thickness=TAPER, remanence=lambda mesh, points: np.full(points.shape, 0.1))
    np.testing.assert_array_equal(made.parts[0].remanence, 0.1)
