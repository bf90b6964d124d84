r"""
A magnet at the tip
===================

A rigid magnet is glued to the end of a passive strip. In a field across it the couple :math:`m\times B` bends the free
length :math:`a` to an arc, and the magnet turns by :math:`\theta = Q\cos\theta` with :math:`Q = m B a/EI`.
This is the built-in problem ``tip-magnet``.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms
from magshell.shell import rotation

# %%
# The magnet is a group that moves as one, with a moment in the undeformed strip (A m²). It turns with the body.

free, width, thickness, moment = 20e-3, 5e-3, 0.5e-3, 0.2e-3
mesh = ms.mesh.rectangle(free + 2e-3, width, elements=(11, 1)).select_elements("glued", x1=(free, free + 2e-3))
rubber = ms.MicropolarNeoHookean(shear_modulus=150e3, lame_lambda=0.0)
shell = ms.Shell(mesh, thickness, rubber, rigid=[ms.RigidBody("glued", "magnet", moment=(moment, 0, 0))])
field = ms.UniformField([0, 0, 19.53125e-3])
path = ms.solve(ms.Model(shell, [ms.Clamp("left")], field), ms.Settings(largest_step=0.1))

# %%
# A rigid body has a row of its own behind the nodes of the mesh: its displacement and its rotation.

row = shell.body_row("magnet")
angles = np.array([-rotation.logarithm(step.state.q[[row]])[0, 1] for step in path.steps])
loads = (
    moment * np.array([step.flux_density[2] for step in path.steps]) * free / (2 * 150e3 * width * thickness**3 / 12)
)
exact = np.linspace(0.0, angles[-1], 100)
print(f"Q = {loads[-1]:.3f}: {angles[-1]:.6f} rad, the arc has 1.306440 rad")
assert abs(angles[-1] - 1.306440) < 1e-3

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(exact / np.cos(exact), exact, label=r"$\theta = Q\,\cos\,\theta$")
axes.plot(loads, angles, "o", label="computed")
axes.set(xlabel="Q = m B a / EI", ylabel="angle of the magnet (rad)")
axes.grid(alpha=0.4)
axes.legend()

# %%
bent = path.plot(color="u3")

# sphinx_gallery_thumbnail_number = 2
