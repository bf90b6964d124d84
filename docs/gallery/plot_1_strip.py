"""
A strip, and what was measured
==============================

A strip of silicone rubber full of magnetised particles is clamped at one end and lies across a magnetic field. It was
built and measured by Zhao, Kim, Cheng and Zhao (*J. Mech. Phys. Solids* 124, 2019); here it is computed with the
material that they give, with nothing fitted.
"""

import matplotlib.pyplot as plt
import numpy as np

import magshell as ms

# %%
# What they measured on a strip 20.5 times as long as thick: field (mT), and deflection of the tip over the length.

measured = np.array(
    [
        (1.856, 0.3161), (2.785, 0.4151), (3.753, 0.5142), (4.641, 0.5922), (5.650, 0.6182), (6.578, 0.6782),
        (9.443, 0.7553), (14.12, 0.8334), (18.85, 0.8535), (23.57, 0.8816), (37.77, 0.8858), (47.18, 0.8990),
    ]
)  # fmt: skip

# %%
# The remanence points along the strip, the field upwards. The field grows from zero to 50 mT. How long the steps are
# is the solver's business, but it meets the stops.

length, thickness = 17.2e-3, 0.84e-3
strip = ms.mesh.rectangle(length, width=5e-3, elements=(16, 2))
rubber = ms.MicropolarNeoHookean(
    shear_modulus=303e3, lame_lambda=7.3e6, coupling_modulus=30.3e3, length_scale=thickness / 10
)
shell = ms.Shell(strip, thickness, rubber, remanence=ms.remanence.constant([143e-3, 0, 0]))
model = ms.Model(
    shell,
    supports=[ms.Clamp("left")],
    field=ms.UniformField([0, 0, 50e-3], stops=1e-3 * measured[:, 0]),
    probes={"tip": (length, 2.5e-3, 0)},
)
model

# %%
# In a notebook every object shows itself when it is the last line of a cell. So does the path of converged steps:

path = ms.solve(model)
path

# %%
# Computed against measured:

tip = path.probe("tip")
figure, axes = plt.subplots(figsize=(7, 4.4), layout="constrained")
axes.plot(1e3 * tip.flux_density[:, 2], tip.u3 / length, "-", color="#1d4ed8", label="computed")
axes.plot(*measured.T, "o", color="#c2410c", label="measured")
axes.set(xlabel="field (mT)", ylabel="deflection of the tip over the length", ylim=(0, 1))
axes.grid(alpha=0.4)
axes.legend()

off = 100 * (np.interp(measured[:, 0], 1e3 * tip.flux_density[:, 2], tip.u3 / length) / measured[:, 1] - 1)
print(f"The computed curve is off by {off.min():+.1f} to {off.max():+.1f} %.")
assert np.abs(off).max() < 8

# %%
# And the shape at the end, true to scale. The strip would like to stand along the field.

picture = path.plot(color="u3")

# sphinx_gallery_thumbnail_number = 2
