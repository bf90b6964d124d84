"""
A sector of a flower, a cell of a sheet
=======================================

A flower of six petals is solved as one of them, and a striped sheet as one pair of stripes. Pictures show the
neighbours in grey. These are the built-in problems ``rosette`` and ``wavy-sheet``.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# The sides of the sector are groups of edges; a turn of 60 degrees takes one to the other. The field is along the axis,
# so that every petal is in the same.

flower = ms.problem.load("rosette")
print(flower.model.shell.repeated)
opened = ms.solve(flower.model, flower.settings)
picture = opened.plot(color="u3")

# %%
# From a cell of the sheet to the next the displacement jumps. Left free along the sheet, the jump says how much shorter
# it gets.

sheet = ms.problem.load("wavy-sheet")
wave = ms.solve(sheet.model, sheet.settings)
wavy = wave.plot(color="u3")

# %%
# The jump has a row of its own in the nodal arrays, and columns in ``history.csv``.

(row,) = wave.model.rows.jumps
(period,) = wave.model.shell.periodic
jumps = np.array([step.state.u[row, 0] for step in wave.steps])
field = np.array([1e3 * step.flux_density[2] for step in wave.steps])
length = np.linalg.norm(period.period(wave.model.shell.mesh))
print(f"at {field[-1]:.0f} mT each cell of {1e3 * length:.0f} mm is {-1e3 * jumps[-1]:.2f} mm shorter")

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(field, 1.0 + jumps / length, "o-")
axes.set(xlabel="field (mT)", ylabel="length of a cell / undeformed")
axes.grid(alpha=0.4)

# sphinx_gallery_thumbnail_number = 1
