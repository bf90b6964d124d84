"""
One file, many thicknesses
==========================

A problem file describes one problem. In Python it can be read, changed and solved as often as one likes: here a strip
with five thicknesses, from 0.4 mm to 1.6 mm.
"""

import dataclasses
import pathlib
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# The file, as it might lie in a folder:

text = """
[mesh]
generator = "rectangle"
length = "15 mm"
width = "2 mm"
elements = [12, 1]

[shell]
thickness = "0.8 mm"

[material]
law = "micropolar-neo-hookean"
shear_modulus = "303 kPa"
lame_lambda = "7300 kPa"
coupling_modulus = "0.1 mu"
length_scale = "0.005 mm"

[[remanence]]
kind = "constant"
vector = ["143 mT", 0, 0]

[field]
flux_density = [0, 0, "20 mT"]

[[supports]]
kind = "clamp"
group = "left"

[probes]
tip = ["15 mm", "1 mm", 0]
"""
file = pathlib.Path(tempfile.mkdtemp()) / "strip.toml"
file.write_text(text)

problem = ms.problem.load(file)
problem

# %%
# A model is plain data that does not change. ``dataclasses.replace`` makes another one with a part exchanged, and
# checks it again.

shell = problem.model.shell
paths = {}
for thickness in (0.4e-3, 0.6e-3, 0.8e-3, 1.2e-3, 1.6e-3):
    model = dataclasses.replace(problem.model, shell=dataclasses.replace(shell, thickness=thickness))
    paths[thickness] = ms.solve(model, ms.Settings(largest_step=0.1))

# %%
# Above: deflection against the field. Below: the same against the one number on which a thin strip depends, :math:`q
# = 12\,(B^\mathrm{rem}B/\mu_0E)(L/h)^2`. All thicknesses fall on the curve of the inextensible elastica,
# :math:`\vartheta'' = -q\cos\vartheta` with :math:`\vartheta(0) = \vartheta'(1) = 0`. Its first integral is
# :math:`\vartheta' = \sqrt{2q\,(\sin\vartheta_1 - \sin\vartheta)}`, so that :math:`q` and the deflection are
# integrals over the angle up to that of the tip, :math:`\vartheta_1`. With :math:`\vartheta = \vartheta_1 - t^2` they
# are smooth.

mu, lam, length = shell.material.shear_modulus, shell.material.lame_lambda, 15e-3
youngs_modulus = mu * (3 * lam + 2 * mu) / (lam + mu)


def elastica(tip_angle):
    """q, and the deflection of the tip over the length."""
    x, weights = np.polynomial.legendre.leggauss(200)
    t = 0.5 * np.sqrt(tip_angle) * (1 + x)
    angle = tip_angle - t**2
    ds = weights * t / np.sqrt(2 * np.cos(tip_angle - t**2 / 2) * np.sin(t**2 / 2))
    return 0.5 * tip_angle * ds.sum() ** 2, (ds * np.sin(angle)).sum() / ds.sum()


angles = np.append(np.geomspace(0.003, 1, 100), np.pi / 2 - np.geomspace(0.57, 1e-4, 100))
exact = np.array([elastica(angle) for angle in angles])

figure, above = plt.subplots(figsize=(6.6, 4.2), layout="constrained")
figure, below = plt.subplots(figsize=(6.6, 4.2), layout="constrained")
colours = plt.colormaps["viridis"](np.linspace(0.05, 0.85, len(paths)))
worst = 0.0
for colour, (thickness, path) in zip(colours, paths.items(), strict=True):
    tip = path.probe("tip")
    field, deflection = tip.flux_density[:, 2], tip.u3 / length
    q = 12 * 143e-3 * field / (4e-7 * np.pi * youngs_modulus) * (length / thickness) ** 2
    style = {"color": colour, "marker": "o", "markersize": 4, "label": f"{1e3 * thickness:g} mm"}
    above.plot(1e3 * field, deflection, **style)
    below.plot(q, deflection, linestyle="none", **style)
    worst = max(worst, np.abs(deflection[1:] / np.interp(q[1:], *exact.T) - 1).max())
below.plot(*exact.T, color="#1a1f26", linewidth=1, zorder=0, label="elastica")
above.set(xlabel="field (mT)")
below.set(xlabel="q", xscale="log", xlim=(0.01, 100))
for axes in (above, below):
    axes.set_ylabel("deflection of the tip over the length")
    axes.grid(alpha=0.4)
    axes.legend(title="thickness")

print(f"From the elastica they are off by at most {100 * worst:.1f} %.")
assert worst < 0.05

# %%
# A grid over several keys, in parallel and with a table at the end, is what ``magshell sweep`` is for.
