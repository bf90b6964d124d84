"""
A T-beam that buckles sideways
==============================

A flange and a web meet in a T: three elements share each edge of the joint. The mesh comes from ``profile``, which
makes thin-walled cross-sections. The web is thinner than the flange, and its free edge is pressed.
"""

import magshell as ms

# %%
# The joint is rigid: one rotation carries flange and web along it.

length = 40e-3
mesh = ms.mesh.profile(
    {"left": (0, 0), "joint": (5e-3, 0), "right": (10e-3, 0), "foot": (5e-3, -10e-3)},
    {"flange-left": ("left", "joint"), "flange-right": ("joint", "right"), "web": ("joint", "foot")},
    length,
    elements=(1, 5),
    divided={"web": 2},
    axis=(0, 1, 0),
    first=(-1, 0, 0),
)
print(mesh)
rubber = ms.MicropolarNeoHookean(shear_modulus=300e3, lame_lambda=1.2e6, length_scale=0.1e-3)
shell = ms.Shell(mesh, 1.2e-3, rubber, regions=[ms.Region("web", thickness=0.6e-3)])

# %%
# Clamped at one end, the beam bends under a force at the other; a little of it acts to the side, to which the pressed
# web then gives way.

force = ms.Force("end", (1e-3, 0, -22e-3))
path = ms.solve(ms.Model(shell, [ms.Clamp("start")], loads=[force]), ms.Settings(largest_step=0.25))
u = path.values("u")
joint, foot = (u[mesh.node_at((-5e-3, 0.3 * length, height)), 0] for height in (0.0, -10e-3))
print(f"Near the clamp the joint moves {1e3 * joint:.2f} mm aside, the foot of the web {1e3 * foot:.2f} mm")
assert abs(foot) > 3.0 * abs(joint)
bent = path.plot(color="von_mises_top")

# %%
# The flange is one body with itself across the joint, the web another, which ends at its middle: they overlap there, as
# in the STL file that ``path.export`` writes. At kinks, where two sheets meet, faces are mitred.
#
# sphinx_gallery_thumbnail_number = 1
