"""
A lifted ring
=============

A flat ring is slit along a radius. One side of the slit is clamped, a force lifts the other by nearly twice the outer
radius. It is one of the most quoted tests for shells that are bent and twisted far beyond small rotations.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms
from magshell.output.bodies import Body, cameras_for, render, shifted
from magshell.output.panels import colour_scale

# %%
# Sze, Liu and Lo (*Finite Elem. Anal. Des.* 40, 2004) tabulate how far the two corners of the lifted side rise. Some
# of their rows: share of the force, then the rise (m) of the inner corner A and the outer corner B.

table = np.array(
    [
        (0.1, 4.277, 5.876), (0.2, 6.725, 9.160), (0.4, 9.529, 12.661),
        (0.6, 11.257, 14.674), (0.8, 12.642, 16.202), (1.0, 13.891, 17.528),
    ]
)  # fmt: skip

# %%
# The classical shell without micro-rotations, on 4 × 20 elements:

ring = ms.mesh.annulus(6.0, 10.0, elements=(4, 20), slit=True)
material = ms.MicropolarStVenantKirchhoff(shear_modulus=10.5e6, lame_lambda=0.0, coupling_modulus=0.0, length_scale=0.0)
model = ms.Model(
    ms.Shell(ring, thickness=0.03, material=material, micro_rotation=False),
    supports=[ms.Clamp("stop")],
    loads=[ms.Force("start", total=[0, 0, 3.2])],
    stages=[ms.Stage(stops=table[:-1, 0])],
    probes={"A": (6, 0, 0), "B": (10, 0, 0)},
)
path = ms.solve(model)

figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
for column, (name, colour) in enumerate([("A", "#1d4ed8"), ("B", "#c2410c")], start=1):
    corner = path.probe(name)
    axes.plot(corner.u3, corner.load_factor, "-", color=colour, label=f"{name}, computed")
    axes.plot(table[:, column], table[:, 0], "o", color=colour, markerfacecolor="white", label=f"{name}, table")
    computed = np.interp(table[:, 0], corner.load_factor, corner.u3)
    off = np.abs(computed - table[:, column]).max() / table[-1, column]
    print(f"{name}: at most {100 * off:.2f} % of the largest rise from the table")
    assert off < 0.01
axes.set(xlabel="rise (m)", ylabel="share of the force")
axes.grid(alpha=0.4)
axes.legend()

# %%
# The ring at three loads, in one picture:

shown = [step for step in path.steps if step.load_factor in (0.0, 0.2, 1.0)]
bodies = [Body(path, step, shifted(), "u3") for step in shown]
scale = colour_scale(bodies, component=3)
scale.set_norm(plt.Normalize(0, 18e3))
(camera,) = cameras_for([bodies], azimuth=-55, elevation=26)
pixels = (1300, round(1300 * camera.half_height / camera.half_width))
picture = render(bodies, camera, lambda values: scale.to_rgba(1e3 * values, bytes=True)[:, :3], pixels)

figure = plt.figure(figsize=(8, 8 * pixels[1] / pixels[0]))
axes = figure.add_axes((0, 0, 1, 1))
axes.imshow(picture)
axes.set_axis_off()

# sphinx_gallery_thumbnail_number = 2
