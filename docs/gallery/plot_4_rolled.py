"""
A strip rolled up
=================

No magnets: a moment at its end bends a strip to a circle. The exact solution is known, and a sound shell element must
roll up without locking. The problem is one of those of Sze, Liu and Lo (*Finite Elem. Anal. Des.* 40, 2004).
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms
from magshell.output.bodies import Body, cameras_for, render, shifted
from magshell.output.panels import colour_scale

# %%
# A moment :math:`M` bends a strip of bending stiffness :math:`EI` to the radius :math:`EI/M`; with :math:`M = 2\pi
# EI/L` it closes to a circle. The classical shell without micro-rotations is meant here, so moments work on the
# director.

length, width, thickness, youngs_modulus = 12.0, 1.0, 0.1, 1.2e6
full = 2 * np.pi * youngs_modulus * width * thickness**3 / 12 / length
strip = ms.mesh.rectangle(length, width, elements=(16, 1))
material = ms.MicropolarStVenantKirchhoff(
    shear_modulus=youngs_modulus / 2, lame_lambda=0.0, coupling_modulus=0.0, length_scale=0.0
)
model = ms.Model(
    ms.Shell(strip, thickness, material, micro_rotation=False),
    supports=[ms.Clamp("left")],
    loads=[ms.Moment("right", total=[0, -full, 0])],
    stages=[ms.Stage(stops=[0.25, 0.5, 0.75])],
    probes={"tip": (length, 0, 0)},
)
path = ms.solve(model)
path

# %%
# The tip of the exact circle, and the tip computed:

print("share of M     exact u1, u3 (m)      computed")
for step in path.steps:
    if step.load_factor in (0.25, 0.5, 0.75, 1.0):
        angle = 2 * np.pi * step.load_factor
        exact = length * np.array([np.sin(angle) / angle - 1, (1 - np.cos(angle)) / angle])
        u = step.state.u[model.probe_nodes["tip"]][[0, 2]]
        print(f"{step.load_factor:10.2f} {exact[0]:12.3f} {exact[1]:8.3f} {u[0]:12.3f} {u[1]:8.3f}")
        assert np.abs(u - exact).max() < 0.01 * length

# %%
# Five states in one picture:

stops = (0.0, 0.25, 0.5, 0.75, 1.0)
bodies = [Body(path, step, shifted(), "u3") for step in path.steps if step.load_factor in stops]
scale = colour_scale(bodies, component=3)
(camera,) = cameras_for([bodies], azimuth=-62, elevation=22)
pixels = (1300, round(1300 * camera.half_height / camera.half_width))
picture = render(bodies, camera, lambda values: scale.to_rgba(1e3 * values, bytes=True)[:, :3], pixels)

figure = plt.figure(figsize=(9, 9 * pixels[1] / pixels[0]))
axes = figure.add_axes((0, 0, 1, 1))
axes.imshow(picture)
axes.set_axis_off()

# %%
# The same problem is built in as ``cantilever-moment``; :doc:`/published-shells` compares it and five others with
# their tables.
