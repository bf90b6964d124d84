r"""
A Miura cell that folds
=======================

Four panels with elastic creases: at a hinge the panels share the displacement and nothing else, and a torsion spring
acts on the angle. One panel is held, the row behind it is magnetised; in a field the cell folds as a mechanism of one
freedom. This is the built-in problem ``origami``.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# The generator names panels and creases. The stiffness is a torque per angle and length. A clamp would hold the
# rotations at the hinges as well, for both sides: :math:`u = 0` of the whole panel holds it and lets its
# neighbours turn.

mesh = ms.mesh.miura(sides=(10e-3, 10e-3), sector=60.0, fold=30.0, cells=(1, 1), elements=(3, 3))
plastic = ms.MicropolarNeoHookean(shear_modulus=50e6 / 2.6, lame_lambda=15e6 / 0.52, length_scale=0.05e-3)
behind = ms.remanence.by_group({name: ms.remanence.constant([0, -0.1, 0]) for name in ("panel-1-2", "panel-2-2")})
shell = ms.Shell(mesh, 0.5e-3, plastic, behind, hinges=[ms.Hinge("mountain", 4e-3), ms.Hinge("valley", 4e-3)])
path = ms.solve(ms.Model(shell, [ms.SimpleSupport("panel-1-1")], ms.UniformField([0, 0, 30e-3])))


# %%
# Angles between the panels, beside those of an ideal cell with the same angle at the zigzag crease:


def angle(mesh, x, *panels):
    """Between the mean normals of two panels, degrees."""
    normals = []
    for rows in (mesh.elements[mesh.elements_of(name)] for name in panels):
        normals.append(np.cross(x[rows[:, 1]] - x[rows[:, 0]], x[rows[:, 3]] - x[rows[:, 0]]).sum(axis=0))
    return np.degrees(np.arccos(np.prod([1 / np.linalg.norm(one) for one in normals]) * (normals[0] @ normals[1])))


zigzag, straight, ideal = [], [], []
for step in path.steps:
    x = mesh.points + step.state.displacement(len(mesh.points))
    zigzag.append(angle(mesh, x, "panel-1-1", "panel-1-2"))
    straight.append(angle(mesh, x, "panel-1-1", "panel-2-1"))
    cell = ms.mesh.miura((10e-3, 10e-3), 60.0, 0.5 * zigzag[-1], (1, 1), (1, 1))
    ideal.append(angle(cell, cell.points, "panel-1-1", "panel-2-1"))
assert np.abs(np.subtract(straight, ideal)).max() < 1.0

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
milliteslas = [1e3 * step.flux_density[2] for step in path.steps]
axes.plot(milliteslas, zigzag, "o-", label="at the zigzag crease")
axes.plot(milliteslas, straight, "o-", label="at the straight crease")
axes.plot(milliteslas, ideal, "k--", label="of an ideal cell")
axes.set(xlabel="field (mT)", ylabel="angle between panels (°)")
axes.grid(alpha=0.4)
axes.legend()

# %%
folded = path.plot(color="u3")

# sphinx_gallery_thumbnail_number = 2
