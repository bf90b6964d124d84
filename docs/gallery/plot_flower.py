"""
A flower that remembers the bud
===============================

Six petals about a hexagon, drawn in gmsh. They are bent up to a bud and magnetised there by a strong uniform field;
released, they lie flat and remember. A weak field along the axis closes them again. This example is not in the paper:
geometry from CAD, remanence from a template.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms
from magshell.evaluation.converged import converged
from magshell.output.bodies import Body, shifted, step_at
from magshell.output.panels import colour_bar, colour_scale, draw_sequence
from magshell.output.setup import draw_setup

# %%
# ``flower.geo`` names the petals, the hexagon and the post that holds it: their names are the groups of the mesh. It
# was meshed by
#
# .. code-block:: console
#
#     $ magshell mesh flower.geo --unit mm --size "0.8 mm" --out flower.msh
#
# The problem file reads the mesh and says how every petal was folded while it was magnetised.
#
# .. literalinclude:: /gallery/flower/flower.toml
#    :language: toml
#    :lines: 10-37

problem = ms.problem.load("flower/flower.toml")
model = problem.model
shell = model.shell
print(shell.mesh)

# %%
# First the bud, as ``magshell show flower.toml --template`` draws it: what it carries is uniform, along the magnetising
# field.

bud = draw_setup(model, title="In the magnetising field", template=True)

# %%
# Flat again, every point keeps the direction that the field had in the material: :math:`\tilde B = M R^\mathsf{T} b`
# with the rotation :math:`R` from the flat flower to the bud. At the foot of a petal it points up, beyond the middle
# outwards, at the tip outwards and down.

flat = draw_setup(model, title="Released")

# %%
# A field along the axis turns the remanence back towards it.

path = ms.solve(model, problem.settings)
path

# %%
# The bud is the shape in which all of the remanence is along the field. Elastic forces keep the petals from it: the
# stronger the field, the nearer they come. Here the angle by which the end of a petal has turned, and its distance from
# where it was in the bud:

tip = model.probe_nodes["tip"]
element, corner = np.argwhere(shell.mesh.elements == tip)[0]
in_bud = ms.remanence.placed(shell.remanence, shell.mesh, shell.mesh.points[shell.mesh.elements])[element, corner]

fields, angles = [], []
print("field (mT)   angle (deg)   distance from the bud (mm)")
for step in path.steps:
    director = converged(path.discretisation, step).director()[tip]
    fields.append(1e3 * np.linalg.norm(step.flux_density))
    angles.append(np.degrees(np.arctan2(-director[0], director[2])))
    distance = 1e3 * np.linalg.norm(shell.mesh.points[tip] + step.state.u[tip] - in_bud)
    print(f"{fields[-1]:10.2f} {angles[-1]:13.1f} {distance:28.2f}")

figure, axes = plt.subplots(figsize=(7, 4), constrained_layout=True)
axes.plot(fields, angles, marker="o", color="#1d4ed8")
axes.axhline(115, color="#8b95a1", linestyle="--")
axes.annotate("the bud", (20, 115), (0, -6), textcoords="offset points", ha="right", va="top", color="#4b5563")
axes.set_xlabel(r"$|B^\mathrm{ext}|$ (mT)")
axes.set_ylabel("end of a petal (degrees)")
axes.set_xlim(left=0)
axes.set_ylim(bottom=0)

# %%
# With its thickness, on the way:

fields = (1.0, 2.0, 5.0, 20.0)
groups = [[Body(path, step_at(path, 1e-3 * field), shifted(), "u3")] for field in fields]
places = [(0.01 + 0.44 * column, 0.56 - 0.49 * row, 0.43, 0.41) for row in range(2) for column in range(2)]
figure = plt.figure(figsize=(9, 6.4), dpi=110)
scale = colour_scale([body for group in groups for body in group], component=3)
draw_sequence(figure, groups, [f"{field:g} mT" for field in fields], places, scale, view=(-60, 30))
colour_bar(figure, (0.89, 0.3, 0.018, 0.4), scale, "$u_3$ (mm)")

# %%
# In a tighter bud the petals would touch each other, which is not computed; here they do not. Folding, rolling and
# other templates: :doc:`/remanence`.
