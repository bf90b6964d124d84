"""
A gripper opens
===============

Twelve arms cover a sphere, clamped near its pole and magnetised along the meridians: away from the clamp above the
equator, towards it below. A field along the axis opens them. This is the last example of Dadgar-Rad and Hossain's
paper.
"""

import matplotlib.pyplot as plt

import magshell as ms
from magshell.output.bodies import Body, step_at, turned
from magshell.output.panels import colour_bar, colour_scale, draw_sequence

# %%
# All arms do the same, so one is enough.

radius = 22.918e-3
arm = ms.mesh.sphere_patch(radius, polar=(15, 165), azimuth=(-15, 15), elements=(16, 4))
rubber = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3.25e6, coupling_modulus=13.5e3, length_scale=9e-5)
shell = ms.Shell(arm, thickness=0.9e-3, material=rubber, remanence=ms.remanence.meridional(94e-3))
model = ms.Model(
    shell,
    supports=[ms.Clamp("top")],
    field=ms.UniformField([0, 0, 6.8e-3], stops=[1e-3, 4e-3]),
    probes={"equator": (radius, 0, 0), "free end": (radius * 0.258819, 0, -radius * 0.965926)},
)
model

# %%
# Arrows are the remanence and the field. Where the two are not parallel, a couple turns the material.

path = ms.solve(model)
path

# %%
# For a picture the arm is shown twelve times, with its true thickness.

shown = [path.steps[0], *(step_at(path, field) for field in (1e-3, 4e-3, 6.8e-3))]
groups = [[Body(path, step, turned(12), "u3")] for step in shown]
titles = ["no field", "1 mT", "4 mT", "6.8 mT"]
places = [(0.01 + 0.43 * column, 0.57 - 0.5 * row, 0.42, 0.4) for row in range(2) for column in range(2)]

figure = plt.figure(figsize=(9, 6.6), dpi=110)
scale = colour_scale([body for group in groups for body in group], component=3)
draw_sequence(figure, groups, titles, places, scale, view=(0, 20))
colour_bar(figure, (0.9, 0.3, 0.018, 0.4), scale, "$u_3$ (mm)")

# %%
# The arms pass through each other if they must: contact is not computed. :doc:`/examples/gripper` says where they
# would meet.
