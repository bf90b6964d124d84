"""
Two strips that feel each other
===============================

Two strips lie above each other, both magnetised through their thickness and held at one end. There is no magnet and no
coil: what bends them is their own field. Magnetised alike they attract, and from some remanence on they snap together;
magnetised oppositely they repel.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

LENGTH, WIDTH, GAP = 20e-3, 2e-3, 5e-3
REMANENCE = 20e-3

# %%
# One mesh has both strips, for only what is in one model feels each other.

one = ms.mesh.rectangle(LENGTH, WIDTH, (8, 1))
points = np.concatenate([one.points, one.points + np.array((0, 0, GAP))])
elements = np.concatenate([one.elements, one.elements + len(one.points)])
count = len(one.elements)
groups = {"lower": np.arange(count), "upper": np.arange(count, 2 * count)}
mesh = ms.mesh.Mesh(points, elements, groups, node_groups={"held": np.flatnonzero(points[:, 0] == 0)})


def strips(lower, upper, stage):
    """Two strips of 300 kPa with remanences along X3, T."""
    remanence = ms.remanence.per_element(np.repeat([[0, 0, lower], [0, 0, upper]], count, axis=0))
    shell = ms.Shell(mesh, 0.5e-3, ms.MicropolarStVenantKirchhoff(150e3, 0.0), remanence)
    probes = {"tip": (LENGTH, WIDTH, GAP)}
    return ms.Model(shell, [ms.Clamp("held")], ms.SelfField(), ms.MicroRotationEnergy(), probes=probes, stages=[stage])


# %%
# Load factor 1 is the whole field of the strips on each other. As it grows with the square of the remanence, load
# factor :math:`s` is also what strips with the remanence :math:`\sqrt{s}` times as large do at their whole field.

repelling = ms.solve(strips(REMANENCE, -REMANENCE, ms.Stage()))
until = ms.Stage(control="displacement", probe="tip", component=3, target=-1.5e-3)
attracting = ms.solve(strips(REMANENCE, REMANENCE, until))
(turn,) = attracting.critical_points
snap = REMANENCE * np.sqrt(turn.load_factor)
print(f"they snap together at a remanence of {1e3 * snap:.2f} mT")
assert 8e-3 < snap < 9e-3
assert repelling.probe("tip").u3[-1] > 1e-3

# %%
# Each tip moves by as much as the other. Beyond the turn the strips stand closer together in a weaker field: a state in
# which nothing holds them.

figure, chart = plt.subplots(figsize=(6.6, 4.4), layout="constrained")
for path, label, color in ((repelling, "opposite", "#1d4ed8"), (attracting, "alike", "#c2410c")):
    tip = path.probe("tip")
    remanence = 1e3 * REMANENCE * np.sqrt(np.maximum(tip.load_factor, 0.0))
    chart.plot(remanence, 1e3 * (GAP + 2.0 * tip.u3), "o-", markersize=3, color=color, label=label)
chart.plot(1e3 * snap, 1e3 * (GAP + 2.0 * turn.state.u[path.model.probe_nodes["tip"], 2]), "k*", markersize=10)
chart.set(xlabel="remanence (mT)", ylabel="distance of the tips (mm)")
chart.grid(alpha=0.4)
chart.legend()
