r"""
A plate with ribs
=================

Three walls meet at each T-joint. One rotation carries the directors of all of them, so that moments pass from one into
the others; nothing needs to be specified. This is the built-in problem ``ribbed-plate``.
"""

import numpy as np

import magshell as ms

# %%
# A thin-walled profile is given by points and the walls between them, and extruded.

points = {"a": (-20e-3, 0), "b": (-10e-3, 0), "c": (10e-3, 0), "d": (20e-3, 0), "e": (-10e-3, 6e-3), "f": (10e-3, 6e-3)}
walls = {"left": ("a", "b"), "plate": ("b", "c"), "right": ("c", "d"), "rib-1": ("b", "e"), "rib-2": ("c", "f")}
mesh = ms.mesh.profile(points, walls, length=120e-3, elements=(2, 12), axis=(0, 1, 0), first=(1, 0, 0))
rubber = ms.MicropolarNeoHookean(shear_modulus=500e3, lame_lambda=0.0)
model = ms.Model(
    ms.Shell(mesh, 1e-3, rubber),
    [ms.Clamp("start")],
    loads=[ms.Pressure("plate", 10.0)],
    probes={"end": (0, 120e-3, 0)},
)
path = ms.solve(model)

# %%
# At small loads it is a beam, with the bending stiffness of its section and the shear stiffness of its ribs:

areas = np.array([40e-3, 6e-3, 6e-3]) * 1e-3
heights = np.array([0.0, 3e-3, 3e-3])
own = np.array([40e-3 * 1e-9, 1e-3 * 6e-3**3, 1e-3 * 6e-3**3]) / 12
stiffness = 1e6 * (own.sum() + areas @ (heights - areas @ heights / areas.sum()) ** 2)
first = path.steps[1]
q, length = first.load_factor * 10.0 * 20e-3, 120e-3
beam = q * length**4 / (8 * stiffness) + q * length**2 / (2 * 5 / 6 * 500e3 * areas[1:].sum())
found = first.state.u[model.probe_nodes["end"], 2]
print(f"deflection {1e6 * found:.1f} um, of the beam {1e6 * beam:.1f} um")
assert abs(found / beam - 1) < 0.015

# %%
lifted = path.plot(color="u3")
