r"""
A compass needle
================

A strip, magnetised along its axis and pinned at its middle: the field alone holds its rotation. This is the built-in
problem ``compass-needle``.
"""

import numpy as np

import magshell as ms

# %%
# The field grows at 60° from the needle, and turns on by 90° in the second stage. Without a field every angle is an
# equilibrium; in the first one the needle has turned already.

problem = ms.problem.load("compass-needle")
path = ms.solve(problem.model, problem.settings)
tip, tail = path.probe("tip").u, path.probe("tail").u
along = tip - tail + np.array([20e-3, 0, 0])
angles = np.degrees(np.arctan2(along[:, 1], along[:, 0]))
for step, angle in zip(path.steps, angles, strict=True):
    print(f"stage {step.stage + 1}, load factor {step.load_factor:4.2f}: {angle:6.2f}°")

expected = [60 + 90 * step.load_factor * step.stage for step in path.steps[1:]]
np.testing.assert_allclose(angles[1:], expected, atol=1e-4)

# %%
# In the field's first direction, and at the end:

first = max(step.number for step in path.steps if step.stage == 0)
turned = path.plot(step=first, color="displacement")

# %%
followed = path.plot(color="displacement")

# sphinx_gallery_thumbnail_number = 2
