"""
A starfish on a post
====================

Six soft magnetic arms on a stiff centre of another rubber, twice as thick, which a post holds in the middle. All
bottoms are flush. The arms are magnetised away from the axis; they hang by their weight, and a tilted field lifts them.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# It is a built-in problem, ``magshell examples --copy starfish`` writes its file. What it is made of, and how it looks
# before the solve:

problem = ms.problem.load("starfish")
shell = problem.model.shell
for part in shell.parts:
    (layer,) = part.layers
    modulus, thickness = 1e-3 * layer.material.shear_modulus, 1e3 * layer.thickness
    print(f"{part.name}: {len(part.elements)} elements, {thickness:g} mm, {modulus:g} kPa, {layer.density:g} kg/m³")
problem

# %%
# The first stage is the weight, the second the field.

path = ms.solve(problem.model, problem.settings)
hanging = next(number for number, step in enumerate(path.steps) if step.load_factor == 1.0)
figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
for name, colour in (("tip-1", "#1d4ed8"), ("tip-4", "#c2410c")):
    tip = path.probe(name)
    field = np.linalg.norm(tip.flux_density, axis=1)
    axes.plot(1e3 * field[hanging:], 1e3 * tip.u3[hanging:], "o-", color=colour, label=name)
axes.set(xlabel="field (mT)", ylabel="height of the tip (mm)")
axes.grid(alpha=0.4)
axes.legend()

# %%
# Bodies are drawn with their true thickness, and steps between regions are closed.

lifted = path.plot(color="u3")

# %%
# The clamp's reaction is in ``history.csv`` and ``summary.json``, and here. Its force is the weight: the field is
# uniform, and pulls at nothing. Its moment is what the field's torque and the shifted weight leave.

areas = np.zeros(len(shell.mesh.elements))
corners = shell.mesh.points[shell.mesh.elements[:, :4]]
diagonals = corners[:, 2:] - corners[:, :2]
areas = 0.5 * np.linalg.norm(np.cross(diagonals[:, 0], diagonals[:, 1]), axis=1)
mass = sum(areas[part.elements].sum() * part.layers[0].thickness * part.layers[0].density for part in shell.parts)
force = path.steps[-1].balance.reaction_force
print(f"force of the clamp: {1e3 * force[2]:.4f} mN; weight: {1e3 * mass * 9.81:.4f} mN")
assert abs(force[2] / (mass * 9.81) - 1.0) < 1e-6

# sphinx_gallery_thumbnail_number = 2
