"""
A strip with a step
===================

The outer half of a strip is half as thick as the inner one, and so eight times as flexible. Regions of a shell may
differ in thickness, material, density and remanence; what a region does not say is that of the shell. This is the
built-in problem ``stepped-strip``, in Python and with two ways to step.
"""

import matplotlib.pyplot as plt

import magshell as ms

# %%
# A region needs a group of elements. Here it is chosen by coordinates.

length = 40e-3
mesh = ms.mesh.rectangle(length, width=5e-3, elements=(16, 2)).select_elements("outer", x1=(length / 2, length))
rubber = ms.MicropolarNeoHookean(shear_modulus=150e3, lame_lambda=0.0, coupling_modulus=150e3, length_scale=5e-6)
along = ms.remanence.constant([0.1, 0, 0])
ONE = 0.19634954e-3  # the field (T) at which q, below, is 1


def strip(offset):
    """The strip with its mesh in the mid-planes, or in the bottom faces of both halves."""
    shell = ms.Shell(mesh, 1e-3, rubber, along, regions=[ms.Region("outer", thickness=0.5e-3)], offset=offset)
    field = ms.UniformField([0, 0, 4 * ONE], stops=[ONE])
    return ms.Model(shell, [ms.Clamp("left")], field, probes={"tip": (length, 2.5e-3, 0)})


# %%
# Uniform couples bend each half as an elastica. With :math:`q = 12\,(B^\mathrm{rem}B/\mu_0E)(L/h)^2 = 1` at the root
# the tip comes to (0.926940, 0.310596) of the length.

path = ms.solve(strip("middle"), ms.Settings(largest_step=0.1))
first = next(step for step in path.steps if step.flux_density[2] == ONE)
node = path.model.probe_nodes["tip"]
tip = (mesh.points + first.state.displacement(len(mesh.points)))[node] / length
print(f"q = 1: tip at ({tip[0]:.5f}, {tip[2]:.5f}) L")
assert abs(tip[0] - 0.926940) < 1e-3
assert abs(tip[2] - 0.310596) < 1e-3

# %%
# At four times that field, with the step on both sides of the mid-plane:

stepped = path.plot(color="u3")

# %%
# and with flush bottoms, as it would be printed on a bed: ``offset="bottom"`` puts the mesh there. Displacements and
# probes are then those of the bottom face.

flush = ms.solve(strip("bottom"), ms.Settings(largest_step=0.1))
figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
for name, one, style in (("step on both sides", path, "-"), ("flush at the bottom", flush, "--")):
    probe = one.probe("tip")
    axes.plot(1e3 * probe.flux_density[:, 2], probe.u3 / length, style, label=name)
axes.set(xlabel="field (mT)", ylabel="deflection of the tip over the length")
axes.grid(alpha=0.4)
axes.legend()
print(f"Tips at the end: {path.probe('tip').u3[-1] / length:.4f} and {flush.probe('tip').u3[-1] / length:.4f} L")

# %%
flush_bottom = flush.plot(color="u3")

# sphinx_gallery_thumbnail_number = 1
