"""
An arch that snaps
==================

A shallow arch between two hinges is magnetised from both hinges towards the crown. A field downward presses the crown
down. At some field the arch can no longer stand, and snaps. The path of equilibria does not stop there: it turns
back, and is followed by its length.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# The problem is a built-in one, with a description of its own:

problem = ms.problem.load("magnetic-arch")
problem

# %%
# The built-in problem takes the field down, up and off again. Down is enough here.

stage = ms.Stage(control="arc-length", stops=problem.model.stages[0].stops)
field = ms.UniformField(problem.model.field.vector)
shell = problem.model.shell
model = ms.Model(shell, problem.model.supports, field, probes=problem.model.probes, stages=[stage])
path = ms.solve(model, ms.Settings(largest_step=0.1))

for point in path.critical_points:
    print(f"{point.kind} at {-1e3 * point.flux_density[2]:.2f} mT, negative pivots {point.negative_pivots}")

# %%
# Critical points are found on the way. At a limit point the field turns; at a bifurcation another path crosses, here
# one on which the arch tips sideways. Negative pivots count the ways in which a state is unstable: where there are
# any, marks are hollow.

stable = np.array([step.negative_pivots == 0 for step in path.steps])
crown = path.probe("crown")
down, deflection = -1e3 * crown.flux_density[:, 2], 1e3 * crown.u3

figure, chart = plt.subplots(figsize=(6.6, 4.4), layout="constrained")
chart.plot(down, deflection, "-", color="#94a3b8", linewidth=1, zorder=1)
chart.plot(down[stable], deflection[stable], "o", color="#1d4ed8", label="stable")
chart.plot(down[~stable], deflection[~stable], "o", color="#c2410c", markerfacecolor="white", label="unstable")
chart.set(xlabel="field, downward (mT)", ylabel="height of the crown over its start (mm)")
chart.grid(alpha=0.4)
chart.legend()

# %%
# The arch from the side, every third step:

figure, shapes = plt.subplots(figsize=(6.6, 4.4), layout="constrained")
side = np.flatnonzero(np.isclose(shell.mesh.points[:, 1], shell.mesh.points[:, 1].min()))
side = side[np.argsort(shell.mesh.points[side, 0])]
for number, step in list(enumerate(path.steps))[::3]:
    x = 1e3 * (shell.mesh.points[side] + step.state.u[side])
    style = {"color": "#1d4ed8"} if stable[number] else {"color": "#c2410c", "linestyle": "--"}
    shapes.plot(x[:, 0], x[:, 2], linewidth=1.2, **style)
shapes.set(xlabel="$X_1$ (mm)", ylabel="$X_3$ (mm)", title="heights stretched")
shapes.grid(alpha=0.4)

# %%
# Between the two limit points a given field has three states. A real arch under a growing field jumps from the first
# limit point to the lower branch; where it comes to rest is a matter of dynamics, which this program does not
# compute. More on :doc:`/path-following`.

# sphinx_gallery_thumbnail_number = 2
