"""
A flower that closes under a magnet
===================================

Four soft petals around a post, magnetised outwards. A magnet on a moving arm comes from 80 mm above to 15 mm and goes
back. Its field runs together towards its south pole, and the petals, which turn along it, close.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# It is a built-in problem, ``magshell examples --copy magnet-approaches`` writes its file.

problem = ms.problem.load("magnet-approaches")
path = ms.solve(problem.model, problem.settings)

# %%
# The first stage brings the field of the magnet far away, the second moves it here, the third takes it back. What moves
# and what pulls are columns of the history: here the height of the magnet's face, and the force on it.

tip = path.probe("tip")
face = 80.0 + 1e3 * np.array([step.drives[problem.model.field.drives.index("magnet.d3")] for step in path.steps])
pull = np.array([step.balance.reaction_force[2] if step.balance else 0.0 for step in path.steps])
coming = [number for number, step in enumerate(path.steps) if step.stage == 1]
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.6), sharex=True, layout="constrained")
above.plot(face[coming], 16 + 1e3 * tip.u1[coming], "o-", color="#1d4ed8")
above.set(ylabel="tip from the axis (mm)")
below.plot(face[coming], 1e3 * pull[coming], "o-", color="#c2410c")
below.set(xlabel="magnet above the post (mm)", ylabel="force of the post (mN)")
for axes in (above, below):
    axes.grid(alpha=0.4)

# %%
# The magnet is drawn to scale, in its place of each step.

nearest = min(range(len(path.steps)), key=lambda number: face[number])
closed = path.plot(color="u3", step=nearest)

# %%
# ``path.animate("flower.gif")`` makes the film. What the post holds is what the magnet pulls with.

force = path.steps[nearest].balance.reaction_force
print(f"force of the post: {1e3 * force[2]:.3f} mN")
assert abs(force[0]) + abs(force[1]) < 1e-9 * abs(force[2])

# sphinx_gallery_thumbnail_number = 2
