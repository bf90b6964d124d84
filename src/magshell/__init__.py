"""magshell: how thin structures of hard-magnetic soft material deform in a magnetic field.

Names are imported when first used, so that `import magshell` is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from magshell.version import __version__ as __version__

if TYPE_CHECKING:
    from magshell import mesh, problem, results
    from magshell.errors import InputError, MeshError
    from magshell.magnetics import (
        DeformationGradientEnergy,
        MicropolarCouple,
        MicroRotationEnergy,
        UniformField,
        fields,
        remanence,
    )
    from magshell.magnetics.fields import (
        CoilSystem,
        FunctionField,
        GradientField,
        MagnetField,
        Motion,
        SampledField,
        SelfField,
        halbach,
        helmholtz,
        maxwell,
    )
    from magshell.materials import (
        MicropolarGent,
        MicropolarMooneyRivlin,
        MicropolarNeoHookean,
        MicropolarStVenantKirchhoff,
        MicropolarYeoh,
        composite,
    )
    from magshell.model import thickness
    from magshell.model.hinge import Hinge
    from magshell.model.loads import Force, Gravity, Moment, Pressure, Traction
    from magshell.model.model import Model
    from magshell.model.region import Layer, Region
    from magshell.model.repeated import Cyclic, Periodic
    from magshell.model.rigid_body import RigidBody
    from magshell.model.shell import Shell
    from magshell.model.springs import Spring
    from magshell.model.stages import Stage
    from magshell.model.supports import Clamp, Prescribe, SimpleSupport, SymmetryPlane
    from magshell.model.torsion_spring import TorsionSpring
    from magshell.model.turn import Turn
    from magshell.solver import CriticalPoint, Observer, Path, Settings, SolveError, Step, resume, solve
    from magshell.solver.buckling import Buckling, BucklingMode, buckling

_HOME = {
    "magshell.errors": ("InputError", "MeshError"),
    "magshell.model.loads": ("Force", "Gravity", "Moment", "Pressure", "Traction"),
    "magshell.magnetics": (
        "DeformationGradientEnergy",
        "MicroRotationEnergy",
        "MicropolarCouple",
        "UniformField",
    ),
    "magshell.magnetics.fields": (
        "CoilSystem",
        "FunctionField",
        "GradientField",
        "MagnetField",
        "Motion",
        "SampledField",
        "SelfField",
        "halbach",
        "helmholtz",
        "maxwell",
    ),
    "magshell.materials": (
        "MicropolarGent",
        "MicropolarMooneyRivlin",
        "MicropolarNeoHookean",
        "MicropolarStVenantKirchhoff",
        "MicropolarYeoh",
        "composite",
    ),
    "magshell.model.model": ("Model",),
    "magshell.model.region": ("Layer", "Region"),
    "magshell.model.shell": ("Shell",),
    "magshell.solver": ("CriticalPoint", "Observer", "Path", "Settings", "SolveError", "Step", "resume", "solve"),
    "magshell.solver.buckling": ("Buckling", "BucklingMode", "buckling"),
    "magshell.model.springs": ("Spring",),
    "magshell.model.torsion_spring": ("TorsionSpring",),
    "magshell.model.stages": ("Stage",),
    "magshell.model.hinge": ("Hinge",),
    "magshell.model.repeated": ("Cyclic", "Periodic"),
    "magshell.model.rigid_body": ("RigidBody",),
    "magshell.model.supports": ("Clamp", "Prescribe", "SimpleSupport", "SymmetryPlane", "Turn"),
}
_MODULES = {
    "fields": "magshell.magnetics.fields",
    "mesh": "magshell.mesh",
    "problem": "magshell.problem",
    "remanence": "magshell.magnetics.remanence",
    "results": "magshell.results",
    "thickness": "magshell.model.thickness",
}
_NAMES = {name: home for home, names in _HOME.items() for name in names}

__all__ = [
    "Buckling",
    "BucklingMode",
    "Clamp",
    "CoilSystem",
    "CriticalPoint",
    "Cyclic",
    "DeformationGradientEnergy",
    "Force",
    "FunctionField",
    "GradientField",
    "Gravity",
    "Hinge",
    "InputError",
    "Layer",
    "MagnetField",
    "MeshError",
    "MicroRotationEnergy",
    "MicropolarCouple",
    "MicropolarGent",
    "MicropolarMooneyRivlin",
    "MicropolarNeoHookean",
    "MicropolarStVenantKirchhoff",
    "MicropolarYeoh",
    "Model",
    "Moment",
    "Motion",
    "Observer",
    "Path",
    "Periodic",
    "Prescribe",
    "Pressure",
    "Region",
    "RigidBody",
    "SampledField",
    "SelfField",
    "Settings",
    "Shell",
    "SimpleSupport",
    "SolveError",
    "Spring",
    "Stage",
    "Step",
    "SymmetryPlane",
    "TorsionSpring",
    "Traction",
    "Turn",
    "UniformField",
    "buckling",
    "composite",
    "fields",
    "halbach",
    "helmholtz",
    "maxwell",
    "mesh",
    "problem",
    "remanence",
    "results",
    "resume",
    "solve",
    "thickness",
]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(_MODULES[name])
    if name in _NAMES:
        return getattr(import_module(_NAMES[name]), name)
    raise AttributeError(f"module 'magshell' has no attribute '{name}'")


def __dir__() -> list[str]:
    return __all__
