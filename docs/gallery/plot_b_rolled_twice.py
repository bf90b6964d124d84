r"""
A strip rolled through two turns
================================

The end of a strip is glued into a rigid handle, which is turned by any angle. A rotation that is prescribed on a rigid
body turns the section with it; on a plain group it would turn the micro-rotation alone. This is the built-in problem
``rolled-strip``.
"""

import numpy as np

import magshell as ms

# %%
# The handle is free to move, and so finds its place: after two turns on the clamp, where the strip ends.

length, width, thickness, mu = 120e-3, 10e-3, 0.5e-3, 150e3
strip = ms.mesh.rectangle(length, width, elements=(48, 1))
rubber = ms.MicropolarNeoHookean(shear_modulus=mu, lame_lambda=0.0, length_scale=0.1 * thickness)
model = ms.Model(
    ms.Shell(strip, thickness, rubber, rigid=[ms.RigidBody("right", "handle")]),
    supports=[ms.Clamp("left"), ms.Prescribe("handle", "omega", value=(0, -4 * np.pi, 0))],
    probes={"end": (length, 0, 0)},
)
path = ms.solve(model)

# %%
# It is a circle that is walked twice, of the radius :math:`L/4\pi`; the moment in it is :math:`D\,4\pi/L`, with the
# share of the couple stress in :math:`D = EI + \mu l^2 A`.

x = strip.points + path.steps[-1].state.displacement(len(strip.points))
radius = length / (4 * np.pi)
away = np.hypot(x[:, 0], x[:, 2] - radius)
print(f"farthest from the circle: {np.abs(away - radius).max() / radius:.2%} of its radius")
assert np.abs(away - radius).max() < 5e-3 * radius

stiffness = width * mu * (thickness**3 / 6 + rubber.length_scale**2 * thickness)
reached = path.summary["reactions"]["left"]["moment"][1]
print(f"moment at the clamp over D 4 pi / L: {reached * radius / stiffness:.4f}")
assert abs(reached * radius / stiffness - 1) < 5e-3

# %%
# After half of the angle, and at the end:

half = min(path.steps, key=lambda step: abs(step.load_factor - 0.5))
once = path.plot(step=half.number, color="u3")

# %%
twice = path.plot(color="u3")

# sphinx_gallery_thumbnail_number = 1
